"""Files of modes: a table as CSV, and scenarios that name it."""

from __future__ import annotations

import csv
import os
import re
from collections.abc import Mapping, Sequence
from pathlib import Path

from flexsc import _native as engine
from flexsc._numpy import np
from flexsc._scenario import Scenario
from flexsc._values import checked, document, toml
from flexsc.structure._structure import COMPONENTS, Structure, write_modes


def from_csv(
    path: str | os.PathLike[str], positions: Mapping[str, Sequence[float]] | None = None
) -> Structure:
    """The structure of a CSV file of modes: a header, then a mode a line.

    Args:
        path: The file. Its columns are `frequency` (rad/s), `damping` (left out: 0) and for each point
            `POINT.tx`, `.ty`, `.tz` (1/sqrt(kg)), `.rx`, `.ry`, `.rz` (rad/(m sqrt(kg))), in any order; those
            of a point that are left out are 0. Lines that begin with `#` are comments.
        positions: Where the points are from the centre of mass (m); left out, there.

    Raises:
        OSError: The file cannot be read.
        ValueError: A line is not a mode; the text names it.

    >>> import flexsc, pathlib, tempfile
    >>> with tempfile.TemporaryDirectory() as out:
    ...     path = pathlib.Path(out) / "modes.csv"
    ...     size = path.write_text("\\n".join(["frequency,damping,tip.ty", "1.3,0.005,0.1"]))
    ...     structure = flexsc.from_csv(path, {"tip": (5.0, 0.0, 0.0)})
    >>> structure.shapes["tip"].tolist()
    [[0.0, 0.1, 0.0, 0.0, 0.0, 0.0]]
    """
    positions = positions or {}
    with open(path, newline="", encoding="utf-8") as file:
        lines = [(number, line) for number, line in enumerate(file, 1) if not line.startswith("#")]
    rows = list(csv.reader([line for _, line in lines], skipinitialspace=True))
    filled = [(lines[index][0], [field.strip() for field in row]) for index, row in enumerate(rows) if row]
    if not filled:
        raise ValueError(f"{path}: must have a header")
    (first, header), table = filled[0], filled[1:]
    points: dict[str, None] = {}
    for name in header:
        point, _, component = name.rpartition(".")
        if point and component in COMPONENTS:
            points[point] = None
        elif name not in ("frequency", "damping"):
            raise ValueError(
                f"{path}: line {first}: must name columns `frequency`, `damping` or `POINT.tx` to "
                f"`POINT.rz`, got `{name}`"
            )
    if len(set(header)) != len(header) or "frequency" not in header:
        raise ValueError(f"{path}: line {first}: must have a column `frequency`, and each column once")
    if unknown := set(positions) - set(points):
        raise ValueError(f"positions: must be of points of the file, {list(points)}, got {sorted(unknown)}")
    columns: dict[str, list[float]] = {name: [] for name in header}
    for number, row in table:
        if len(row) != len(header):
            raise ValueError(
                f"{path}: line {number}: must have {len(header)} numbers, as the header, got {len(row)}"
            )
        for name, field in zip(header, row, strict=True):
            try:
                columns[name].append(float(field))
            except ValueError:
                raise ValueError(f"{path}: line {number}: `{name}` must be a number, got `{field}`") from None
    none = [0.0] * len(table)
    shapes = {
        point: np.array([columns.get(f"{point}.{component}", none) for component in COMPONENTS]).T
        for point in points
    }
    where = {point: positions.get(point, (0.0, 0.0, 0.0)) for point in points}
    return Structure(np.array(columns["frequency"]), np.array(columns.get("damping", none)), where, shapes)


def write_scenario(scenario: Scenario, path: str | os.PathLike[str]) -> Path:
    """Write a scenario of a spatial body as `NAME.toml`, its modes beside it as `NAME-modes.csv`.

    Args:
        scenario: The scenario, its modes in itself.
        path: The file to write.

    Returns:
        The path of the CSV file.

    Raises:
        ValueError: The body is not a spatial one with modes.
        OSError: A file cannot be written.

    >>> import flexsc, numpy, pathlib, tempfile
    >>> model = flexsc.from_state_space([[0, 1], [-4, -0.02]], [[0], [1]], [[0, 1]])
    >>> scenario = model.scenario(numpy.eye(3), thrust=1.0, arm=2.0, inputs=("yaw",), outputs=("yaw",))
    >>> with tempfile.TemporaryDirectory() as out:
    ...     modes = flexsc.structure.write_scenario(scenario, pathlib.Path(out) / "station.toml")
    >>> modes.name
    'station-modes.csv'
    """
    values = checked(scenario).to_dict()
    if "spacecraft" in values:
        raise ValueError(
            f"{scenario.name}: must have a `[body.spatial]`, got `[spacecraft]`: write `to_toml()` as it is"
        )
    spatial = values["body"].get("spatial")
    if spatial is None:
        raise ValueError(f"{scenario.name}: must have a `[body.spatial]`, got `{next(iter(values['body']))}`")
    modes, file = spatial["modes"], Path(path)
    if isinstance(modes, str) or not modes:
        raise ValueError(f"{scenario.name}: must have modes in itself")
    table = file.with_name(f"{file.stem}-modes.csv")
    write_modes(table, modes)
    spatial["modes"] = str(table.absolute())
    text = Scenario.parse(document(scenario.name, values), scenario.name).to_toml()
    beside = f"modes = {toml(scenario.name, 'modes', table.name)}"
    text = re.sub(r"^modes = .*$", lambda _: beside, text, count=1, flags=re.MULTILINE)
    engine.write(file, text.encode())
    return table
