"""A modal model of inputs and outputs, and the structure that it is of."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

from flexsc._numpy import np, npt
from flexsc.structure._structure import AXES, Structure

if TYPE_CHECKING:
    from flexsc._scenario import Scenario

    Numbers = npt.NDArray[np.float64]
    Complex = npt.NDArray[np.complex128]

# For each axis the component of a force that turns about it, and that of its arm.
_FORCE, _ARM = (2, 0, 1), (1, 2, 0)


@dataclass(frozen=True, eq=False)
class StateSpace:
    """A modal model, q_i'' + 2 zeta_i w_i q_i' + w_i² q_i = sum_j b_ij u_j, y = P q + V q'.

    >>> import flexsc
    >>> model = flexsc.from_state_space([[0, 1], [-4, -0.02]], [[0], [1]], [[0, 1]])
    >>> [round(float(damping), 6) for damping in model.dampings]
    [0.005]
    """

    frequencies: Numbers
    """Natural frequencies w (rad/s), increasing, shape (modes,).

    >>> model.frequencies.round(6).tolist()
    [2.0]
    """
    dampings: Numbers
    """Damping ratios zeta, shape (modes,).

    >>> model.dampings.round(6).tolist()
    [0.005]
    """
    inputs: Numbers
    """Influence b of the inputs, shape (modes, inputs).

    >>> model.inputs.shape
    (1, 1)
    """
    displacements: Numbers
    """P, what the outputs see of the modal displacements, shape (outputs, modes).

    >>> model.displacements.round(6).tolist()
    [[0.0]]
    """
    rates: Numbers
    """V, what they see of the modal rates, shape (outputs, modes).

    >>> model.rates.round(6).tolist()
    [[1.0]]
    """
    deviation: float
    """Largest relative deviation of the transfer function from that of the matrices, at the natural
    frequencies and between them.

    >>> model.deviation < 1e-9
    True
    """

    def response(self, frequencies: npt.ArrayLike) -> Complex:
        """The transfer function at some frequencies (rad/s), shape (frequencies, outputs, inputs).

        >>> abs(model.response([0.0]))[0].round(6).tolist()
        [[0.0]]
        """
        s = 1j * np.atleast_1d(np.asarray(frequencies, dtype=np.float64))[:, None]
        w, zeta = self.frequencies, self.dampings
        modal = 1.0 / (s * s + 2.0 * zeta * w * s + w * w)
        seen = self.displacements + s[:, :, None] * self.rates
        found: Complex = np.einsum("kpn,kn,nm->kpm", seen, modal, self.inputs)
        return found

    def structure(
        self,
        *,
        arm: float | Mapping[str, float],
        inputs: Sequence[str | None] = AXES,
        outputs: Sequence[str | None] = AXES,
        kind: Literal["force", "torque"] = "force",
        unit: float | Mapping[str, float] = 1.0,
        measures: Literal["rate", "angle"] = "rate",
    ) -> Structure:
        """The structure that these modes are of, where no more of its geometry is known.

        It has the points `roll`, `pitch` and `yaw`, at each of which a jet pushes along one line, and `gyro`.

        Args:
            arm: Arm at which the jets push about the centre of mass (m), for all axes or by axis.
            inputs: For each input, the axis about which it turns the body; None to leave it out.
            outputs: The same for each output.
            kind: Whether the inputs are forces or torques.
            unit: What one unit of an input is: so many N or N m.
            measures: Whether the outputs are rates (rad/s) or angles (rad); a gyro sees the rates of both.

        >>> structure = model.structure(arm=2.0, inputs=["roll"], outputs=["roll"])      # m
        >>> structure.frequencies.round(6).tolist()
        [2.0]

        Raises:
            ValueError: Names that are no axes, or outputs that are of the other kind.
        """
        pushes = _by_axis("inputs", inputs, self.inputs.shape[1])
        seen = _by_axis("outputs", outputs, self.rates.shape[0])
        w = self.frequencies
        wanted, other = (
            (self.rates * w, self.displacements)
            if measures == "rate"
            else (self.displacements, self.rates * w)
        )
        rows = list(seen.values())
        if np.abs(other[rows]).max(initial=0.0) > 1e-6 * np.abs(wanted[rows]).max(initial=0.0):
            raise ValueError(f"measures: must be what the outputs are, and they are not {measures}s alone")
        rotations = self.rates if measures == "rate" else self.displacements
        shapes = {point: np.zeros((len(w), 6)) for point in (*AXES, "gyro")}
        positions = {point: [0.0, 0.0, 0.0] for point in shapes}
        for axis, name in enumerate(AXES):
            if kind == "force":
                positions[name][_ARM[axis]] = _of_axis("arm", arm, name)
            if name in pushes:
                influence = self.inputs[:, pushes[name]] / _of_axis("unit", unit, name)
                shapes[name][:, _FORCE[axis] if kind == "force" else 3 + axis] = influence
            if name in seen:
                shapes["gyro"][:, 3 + axis] = rotations[seen[name]]
        return Structure(w, self.dampings, positions, shapes)

    def scenario(
        self,
        inertia: npt.ArrayLike,
        *,
        thrust: float | Mapping[str, float],
        arm: float | Mapping[str, float],
        inputs: Sequence[str | None] = AXES,
        outputs: Sequence[str | None] = AXES,
        kind: Literal["force", "torque"] = "force",
        unit: float | Mapping[str, float] = 1.0,
        measures: Literal["rate", "angle"] = "rate",
        jets: Mapping[str, object] | None = None,
        gyro: Mapping[str, object] | None = None,
        **keys: Any,
    ) -> Scenario:
        """A scenario of the structure, ready to run, with a jet each way about each axis.

        Args:
            inertia: Inertia tensor about the centre of mass (kg m²).
            thrust: Thrust of the jets (N), for all axes or by axis.
            arm: Their arm about the centre of mass (m): a torque of thrust times arm.
            inputs: As of `structure`, with what follows.
            outputs: "
            kind: "
            unit: "
            measures: "
            jets: Further keys of `[actuator.jets]`, such as `minimum_on`.
            gyro: Further keys of `[sensor.gyro]`, such as `noise`.
            keys: As of `Structure.scenario`.

        >>> inertia = numpy.diag([900.0, 600.0, 1100.0])                   # kg m²
        >>> keys = {"thrust": 1.0, "arm": 2.0, "inputs": ["roll"], "outputs": ["roll"]}       # N, m
        >>> model.scenario(inertia, **keys)
        <flexsc.Scenario structure: 600 s, 1 mode, seed 0>

        Raises:
            ValueError: As of `structure`.
            ScenarioError: A key or a value is not accepted.
        """
        structure = self.structure(
            arm=arm, inputs=inputs, outputs=outputs, kind=kind, unit=unit, measures=measures
        )
        thrusters = []
        for axis, name in enumerate(AXES):
            offset = [0.0, 0.0, 0.0]
            if kind == "torque":
                offset[_ARM[axis]] = _of_axis("arm", arm, name)
            for sign, sense in (("+", 1.0), ("-", -1.0)):
                direction = [0.0, 0.0, 0.0]
                direction[_FORCE[axis]] = sense
                push = {"thrust": _of_axis("thrust", thrust, name), "direction": direction, "offset": offset}
                thrusters.append({"name": f"{name} {sign}", "point": name, **push})
        groups = {name: {"plus": [f"{name} +"], "minus": [f"{name} -"]} for name in AXES}
        return structure.scenario(
            inertia,
            gyro={"point": "gyro", **(gyro or {})},
            jets={"thrusters": thrusters, "groups": groups, **(jets or {})},
            **keys,
        )

    def __repr__(self) -> str:
        modes, inputs = self.inputs.shape
        return f"<flexsc.StateSpace: {modes} modes, {inputs} inputs, {len(self.rates)} outputs>"


def _by_axis(what: str, names: Sequence[str | None], count: int) -> dict[str, int]:
    """Which column is for which axis."""
    if len(names) != count:
        raise ValueError(f"{what}: must name an axis or None for each of {count}, got {list(names)}")
    named = {name: index for index, name in enumerate(names) if name is not None}
    if set(named) - set(AXES) or len(named) != sum(name is not None for name in names):
        raise ValueError(f"{what}: must be among {', '.join(AXES)}, each once, got {list(names)}")
    return named


def _of_axis(what: str, value: float | Mapping[str, float], axis: str) -> float:
    if isinstance(value, Mapping):
        if axis not in value:
            raise ValueError(f"{what}: must be given for {axis}, got {dict(value)}")
        return float(value[axis])
    return float(value)


StateSpace.__module__ = "flexsc.structure"
