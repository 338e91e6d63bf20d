"""Modes from state-space matrices, x' = A x + B u, y = C x, such as those of the SLICOT collection."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

from flexsc.structure._structure import AXES, Structure

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from flexsc._scenario import Scenario

    Numbers = npt.NDArray[np.float64]
    Complex = npt.NDArray[np.complex128]

# Poles nearer to each other than this, relatively, are those of modes with one frequency.
_ALIKE = 1e-8
# An input that pushes a mode by less than this part of what it pushes the others by is rounding.
_ROUNDING = 1e-12
# Where motions drive each other, rounding gives eigenvectors a condition number of its inverse root.
_FULL = 1e7
# For each axis the component of a force that turns about it, and that of its arm.
_FORCE, _ARM = (2, 0, 1), (1, 2, 0)


@dataclass(frozen=True, eq=False)
class StateSpace:
    """A modal model, q_i'' + 2 zeta_i w_i q_i' + w_i² q_i = sum_j b_ij u_j, y = P q + V q'."""

    frequencies: Numbers
    """Natural frequencies w (rad/s), increasing, shape (modes,)."""
    dampings: Numbers
    """Damping ratios zeta, shape (modes,)."""
    inputs: Numbers
    """Influence b of the inputs, shape (modes, inputs)."""
    displacements: Numbers
    """P, what the outputs see of the modal displacements, shape (outputs, modes)."""
    rates: Numbers
    """V, what they see of the modal rates, shape (outputs, modes)."""
    deviation: float
    """Largest relative deviation of the transfer function from that of the matrices, at the natural
    frequencies and between them."""

    def response(self, frequencies: npt.ArrayLike) -> Complex:
        """The transfer function at some frequencies (rad/s), shape (frequencies, outputs, inputs)."""
        import numpy as np

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

        Raises:
            ValueError: Names that are no axes, or outputs that are of the other kind.
        """
        import numpy as np

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


def from_state_space(
    A: npt.ArrayLike,
    B: npt.ArrayLike,
    C: npt.ArrayLike,
    D: npt.ArrayLike | None = None,
    *,
    tolerance: float = 1e-6,
) -> StateSpace:
    """The modes of a structure that is given as x' = A x + B u, y = C x.

    A mode is scaled so that its rate q' is a unit vector of the state: from a state of mass-normalised
    displacements and rates they come back. Modes that no input pushes are left out.

    Args:
        A: System matrix, dense or sparse, in any coordinates.
        B: Input matrix.
        C: Output matrix.
        D: Feedthrough, which must be 0.
        tolerance: Relative deviation of the transfer function up to which modes stand for the matrices.

    Raises:
        ValueError: The matrices are not those of damped modes that inputs push; the text says why.
    """
    import numpy as np

    a, b, c = (_matrix(name, matrix) for name, matrix in (("A", A), ("B", B), ("C", C)))
    order = len(a)
    if a.shape != (order, order) or len(b) != order or c.shape[1] != order:
        raise ValueError(
            f"A, B, C: must have shapes (n, n), (n, inputs), (outputs, n), got {a.shape}, {b.shape}, "
            f"{c.shape}"
        )
    if D is not None and (through := np.abs(_matrix("D", D)).max(initial=0.0)) > 0.0:
        raise ValueError(f"D: must be 0, as no motion of modes feeds through, got {through:g}")
    poles, right = np.linalg.eig(a)
    upper = _oscillating(poles)
    condition = np.linalg.cond(right)
    if not condition < _FULL:
        raise ValueError(
            f"A: must have motions that are modes of their own, and their condition number is {condition:.1e}: "
            "some drive each other, or the state has scales too far apart"
        )
    left = np.linalg.inv(right)
    found = []
    largest = np.linalg.norm(b, axis=0).max(initial=0.0)
    for group in _alike(poles, upper):
        frequency = float(np.abs(poles[group]).mean())
        decay = float(-2.0 * poles[group].real.mean())
        push = 2.0 * (right[:, group] @ (left[group] @ b)).real
        directions, sizes, amounts = np.linalg.svd(push, full_matrices=False)
        if len(sizes) > len(group) and sizes[len(group)] > max(
            tolerance * sizes[0], _ROUNDING * condition * largest
        ):
            raise ValueError(
                f"B: must push a mode along its rate alone, and at {frequency:g} rad/s does not, by a "
                f"relative {sizes[len(group)] / sizes[0]:.1e}: this is no q'' + 2 zeta w q' + w² q = b u"
            )
        for index in range(min(len(group), len(sizes))):
            if sizes[index] > _ROUNDING * largest:
                rate = directions[:, index]
                influence = sizes[index] * amounts[index]
                sign = np.sign(influence[np.argmax(np.abs(influence))])
                displacement = a @ rate + decay * rate
                found.append(
                    (frequency, decay / (2.0 * frequency), sign * influence, sign * displacement, sign * rate)
                )
    if not found:
        raise ValueError("B: must push a mode, and pushes none")
    found.sort(key=lambda mode: mode[0])
    w, zeta, influences, displacements, rates = (np.array(column) for column in zip(*found, strict=True))
    model = StateSpace(w, zeta, influences, c @ displacements.T, c @ rates.T, 0.0)
    deviation, where = _deviation(model, a, b, c)
    if deviation > tolerance:
        raise ValueError(
            f"A, B, C: must be those of modes, whose transfer function is off by a relative {deviation:.1e} "
            f"at {where:g} rad/s"
        )
    return StateSpace(w, zeta, influences, model.displacements, model.rates, deviation)


def _matrix(name: str, matrix: Any) -> Numbers:
    import numpy as np

    dense = matrix.toarray() if hasattr(matrix, "toarray") else matrix
    found = np.atleast_2d(np.asarray(dense, dtype=np.float64))
    if found.ndim != 2 or not np.isfinite(found).all():
        raise ValueError(f"{name}: must be a matrix of finite numbers")
    return found


def _oscillating(poles: Complex) -> npt.NDArray[np.intp]:
    """The poles of positive imaginary part, if all poles are of damped oscillations."""
    import numpy as np

    size = np.abs(poles)
    rounding = 1e-12 * size.max(initial=0.0)
    if (at_rest := size <= rounding).any():
        raise ValueError(
            f"A: must have elastic modes alone, and {at_rest.sum()} of its poles are 0: leave out the rigid "
            "body, whose motion follows from the inertia tensor"
        )
    if (poles.real > rounding).any():
        worst = poles[np.argmax(poles.real)]
        raise ValueError(f"A: must be stable, and has the pole {worst.real:g} {worst.imag:+g}i")
    if (real := np.abs(poles.imag) <= 1e-9 * size).any():
        told = ", ".join(f"{pole:g}" for pole in np.sort(poles[real].real)[-4:])
        raise ValueError(
            f"A: must have modes that oscillate, and has real poles ({told}): overdamped pairs, or the "
            "dynamics of sensors and actuators, which do not belong to the structure"
        )
    return np.flatnonzero(poles.imag > 0.0)


def _alike(poles: Complex, upper: npt.NDArray[np.intp]) -> list[list[int]]:
    """Groups of poles that are the same but for rounding."""
    groups: list[list[int]] = []
    for index in sorted(upper.tolist(), key=lambda index: abs(poles[index])):
        close = (
            group
            for group in reversed(groups[-8:])
            if abs(poles[group[0]] - poles[index]) <= _ALIKE * abs(poles[index])
        )
        if (group := next(close, None)) is not None:
            group.append(index)
        else:
            groups.append([index])
    return groups


def _deviation(model: StateSpace, a: Numbers, b: Numbers, c: Numbers) -> tuple[float, float]:
    """The largest relative deviation of the transfer function from that of the matrices, and where it is."""
    import numpy as np

    w = model.frequencies
    places = np.concatenate([[0.5 * w[0]], w, np.sqrt(w[1:] * w[:-1]), [2.0 * w[-1]]])
    # So many tell; each costs a solution.
    places = places[:: 1 + len(places) // 400]
    own = model.response(places)
    worst = (0.0, float(places[0]))
    for place, seen in zip(places.tolist(), own, strict=True):
        exact = c @ np.linalg.solve(1j * place * np.eye(len(a)) - a, b)
        size = float(np.linalg.norm(exact))
        if size > 0.0:
            worst = max(worst, (float(np.linalg.norm(seen - exact)) / size, place))
    return worst


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
