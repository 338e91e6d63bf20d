"""A structure by its modes: what a finite-element model or a test says of it, on its way into a scenario."""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from flexsc import _native as engine
from flexsc._numpy import np, npt
from flexsc._scenario import Scenario

if TYPE_CHECKING:
    Numbers = npt.NDArray[np.float64]

AXES = ("roll", "pitch", "yaw")
COMPONENTS = ("tx", "ty", "tz", "rx", "ry", "rz")

# A law for a large station, as in scenarios/iss-manoeuvre.toml.
LAW = {
    "period": 0.2,
    "dead_zone": 5.235987755982989e-3,
    "rate_limit": 7e-4,
    "switch_on": 1e-4,
    "switch_off": 3e-5,
}
SPECIFIC_IMPULSE = 270.0


@dataclass(frozen=True, eq=False)
class Structure:
    """A structure by its elastic modes, mass-normalised, with their shapes at named points.

    Raises:
        ValueError: The arrays do not fit each other.

    >>> import flexsc, numpy
    >>> tip = {"tip": numpy.array([[0.0, 0.1, 0.0, 0.0, 0.0, 0.02]])}
    >>> structure = flexsc.Structure(numpy.array([1.3]), numpy.array([0.005]), {"tip": (5, 0, 0)}, tip)
    >>> structure.keep([0]).frequencies.tolist()
    [1.3]
    """

    frequencies: Numbers
    """Natural frequencies (rad/s), shape (modes,).

    >>> structure.frequencies.tolist()
    [1.3]
    """
    dampings: Numbers
    """Damping ratios, shape (modes,).

    >>> structure.dampings.tolist()
    [0.005]
    """
    positions: Mapping[str, Sequence[float]]
    """The points by name: where they are from the centre of mass (m).

    >>> structure.positions["tip"]
    (5, 0, 0)
    """
    shapes: Mapping[str, Numbers]
    """For each point, shape (modes, 6): translations (1/sqrt(kg)), then rotations (rad/(m sqrt(kg))).

    >>> structure.shapes["tip"].shape
    (1, 6)
    """
    inertia: Numbers | None = None
    """Inertia tensor about the centre of mass (kg m²), shape (3, 3), if it is known.

    >>> structure.inertia is None
    True
    """

    def __post_init__(self) -> None:
        modes = len(self.frequencies)
        if len(self.dampings) != modes:
            raise ValueError(f"dampings: must be {modes}, as the frequencies, got {len(self.dampings)}")
        if set(self.positions) != set(self.shapes):
            raise ValueError(
                f"shapes: must be at the points {sorted(self.positions)}, got {sorted(self.shapes)}"
            )
        for point, shape in self.shapes.items():
            if shape.shape != (modes, 6):
                raise ValueError(f"shapes: must have shape ({modes}, 6) at `{point}`, got {shape.shape}")

    def keep(self, modes: npt.ArrayLike) -> Structure:
        """The structure with some of its modes: indices, or a bool for each.

        >>> structure.keep([0]).frequencies.size
        1
        """
        chosen = np.asarray(modes)
        shapes = {point: shape[chosen] for point, shape in self.shapes.items()}
        return Structure(
            self.frequencies[chosen], self.dampings[chosen], self.positions, shapes, self.inertia
        )

    def body(self, inertia: npt.ArrayLike | None = None) -> dict[str, Any]:
        """The keys of a `[body.spatial]`.

        Args:
            inertia: Inertia tensor about the centre of mass (kg m²); left out, the structure's own.

        >>> inertia = numpy.diag([900.0, 600.0, 1100.0])                   # kg m²
        >>> structure.body(inertia)["modes"][0]["frequency"]
        1.3

        Raises:
            ValueError: No inertia tensor is known.
        """
        tensor = self.inertia if inertia is None else inertia
        if tensor is None:
            raise ValueError("inertia: must be given: the structure does not have it")
        points = [
            {"name": name, "position": [float(x) for x in position]}
            for name, position in self.positions.items()
        ]
        modes = []
        for index, (frequency, damping) in enumerate(
            zip(self.frequencies.tolist(), self.dampings.tolist(), strict=True)
        ):
            shapes = {}
            for point, shape in self.shapes.items():
                row = shape[index].tolist()
                shapes[point] = {"translation": row[:3], "rotation": row[3:]}
            modes.append({"frequency": frequency, "damping": damping, "shapes": shapes})
        return {"inertia": np.asarray(tensor, dtype=np.float64).tolist(), "points": points, "modes": modes}

    def scenario(
        self,
        inertia: npt.ArrayLike | None = None,
        *,
        gyro: str | Mapping[str, object],
        jets: Mapping[str, object],
        law: Mapping[str, object] | None = None,
        body: Mapping[str, object] | None = None,
        correction: float | None = 0.01,
        duration: float = 600.0,
        name: str = "structure",
        **keys: object,
    ) -> Scenario:
        """A scenario of the structure under a phase-plane law, ready to run.

        Args:
            inertia: Inertia tensor about the centre of mass (kg m²); left out, the structure's own.
            gyro: The point at which the gyro is, or all keys of `[sensor.gyro]`.
            jets: The keys of `[actuator.jets]`; the specific impulse may be left out.
            law: Keys of `[law.phase_plane]` that differ from those of a large station.
            body: Further keys of `[body.spatial]`, such as `rate`.
            correction: That of `[estimator.rigid_rate]`; None for no estimator.
            duration: Simulated time (s).
            name: Name of the scenario.
            keys: Further keys at the top, such as `seed`.

        >>> inertia = numpy.diag([900.0, 600.0, 1100.0])                   # kg m²
        >>> pushes = {"roll": ([0, 1, 0], [0, 0, 1]), "pitch": ([0, 0, 0], [0, 0, -1])}
        >>> pushes["yaw"] = ([0, 0, 0], [0, 1, 0])
        >>> keys = {"point": "tip", "thrust": 1.0}                         # N
        >>> thrusters = [
        ...     {**keys, "name": axis + name, "offset": offset, "direction": [sign * x for x in direction]}
        ...     for axis, (offset, direction) in pushes.items()
        ...     for name, sign in (("+", 1), ("-", -1))
        ... ]
        >>> groups = {axis: {"plus": [axis + "+"], "minus": [axis + "-"]} for axis in pushes}
        >>> structure.scenario(inertia, gyro="tip", jets={"thrusters": thrusters, "groups": groups})
        <flexsc.Scenario structure: 600 s, 1 mode, seed 0>

        Raises:
            ValueError: No inertia tensor is known.
            ScenarioError: A key or a value is not accepted.
        """
        spatial = {**self.body(inertia), **(body or {})}
        values: dict[str, object] = {
            "duration": duration,
            "body": {"spatial": spatial},
            "sensor": {"gyro": {"point": gyro} if isinstance(gyro, str) else gyro},
            "law": {"phase_plane": {**LAW, **(law or {})}},
            "actuator": {"jets": {"specific_impulse": SPECIFIC_IMPULSE, **jets}},
            **keys,
        }
        if correction is not None:
            values["estimator"] = {"rigid_rate": {"correction": correction}}
        return Scenario(values, name)

    def to_csv(self, path: str | os.PathLike[str]) -> None:
        """Write the modes as the CSV file that `modes` of a `[body.spatial]` may name.

        >>> import pathlib, tempfile
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     structure.to_csv(pathlib.Path(folder) / "modes.csv")
        ...     flexsc.from_csv(pathlib.Path(folder) / "modes.csv").frequencies.tolist()
        [1.3]
        """
        write_modes(path, self.body([[1, 0, 0], [0, 1, 0], [0, 0, 1]])["modes"])

    def __repr__(self) -> str:
        return (
            f"<flexsc.Structure: {len(self.frequencies)} modes at {', '.join(self.positions) or 'no points'}>"
        )


def write_modes(path: str | os.PathLike[str], modes: Sequence[Mapping[str, Any]]) -> None:
    """Write modes as in a scenario to a CSV file, without the columns that hold zeros alone."""
    columns: dict[str, list[float]] = {
        key: [float(mode.get(key, 0.0)) for mode in modes]
        for key in ("frequency", "damping", "displacement", "rate")
    }
    for point in modes[0]["shapes"] if modes else ():
        for part, names in (("translation", COMPONENTS[:3]), ("rotation", COMPONENTS[3:])):
            for index, name in enumerate(names):
                columns[f"{point}.{name}"] = [float(mode["shapes"][point][part][index]) for mode in modes]
    # A point that no mode moves keeps one column, so that it is listed.
    written = {name for name, column in columns.items() if any(column)} | {"frequency"}
    for point in modes[0]["shapes"] if modes else ():
        if not any(f"{point}.{component}" in written for component in COMPONENTS):
            written.add(f"{point}.tx")
    kept = {name: column for name, column in columns.items() if name in written}
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(kept)
    writer.writerows(map(repr, row) for row in zip(*kept.values(), strict=True))
    engine.write(path, text.getvalue().encode())


Structure.__module__ = "flexsc.structure"
