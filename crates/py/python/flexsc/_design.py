"""Points of sweeps: values of keys, tables and samples, as the engine's design."""

from __future__ import annotations

import csv
import os
from collections.abc import Iterable, Mapping
from math import isfinite
from operator import index
from typing import Any, Literal

from flexsc import _native as engine
from flexsc._numpy import np
from flexsc._values import toml

Method = Literal["random", "latin-hypercube", "sobol"]
"""A method by which points are spread over ranges, and `[uncertain]` keys are drawn."""
Noise = Literal["same", "new"]
"""The noise of the points of a sweep: that of one run at all of them, or new noise at each."""
Sample = Method | tuple[Method, int]
"""A method, or a method with its number of points."""
Points = Any
"""A sequence of mappings, a mapping of columns, a data frame, a table of runs, or the path of a CSV file."""


class _Blocks:
    """The engine's design of a sweep, block by block, and the number of its points."""

    def __init__(self, name: str) -> None:
        self.native = engine.Design()
        self.points = 1
        self._name = name

    def add_points(self, points: Points) -> None:
        """Add a table of points."""
        columns = _columns(points)
        lengths = {key: len(values) for key, values in columns.items()}
        if not columns or not all(lengths.values()):
            raise ValueError("points must have at least one key and one point")
        if len(set(lengths.values())) > 1:
            given = ", ".join(f"{count} of {key!r}" for key, count in lengths.items())
            raise ValueError(f"points must have equally many values of each key, got {given}")
        self._add(columns, True)

    def add_values(self, key: str, values: object) -> None:
        """Add the values of a key."""
        column = _column(key, values)
        if not column:
            raise ValueError(f"the values of {key!r} must be of shape (points,) and not empty")
        self._add({key: column}, False)

    def add_sample(self, method: str, count: int, ranges: Mapping[str, tuple[float, float]]) -> None:
        """Add points that are spread over ranges of keys."""
        self.native.add_sample(method, count, [(key, *limits) for key, limits in ranges.items()])
        self.points *= count

    def _add(self, columns: Mapping[str, list[Any]], is_table: bool) -> None:
        keys, count = list(columns), len(next(iter(columns.values())))
        if all(_is_number(value) for values in columns.values() for value in values):
            if not is_table:
                self.native.add_list(keys[0], [float(value) for value in columns[keys[0]]])
            else:
                table = np.array([columns[key] for key in keys], dtype=np.float64)
                self.native.add_table(keys, np.ascontiguousarray(table.T))
        else:
            texts = [[toml(self._name, key, value) for value in columns[key]] for key in keys]
            self.native.add_values(keys, [list(point) for point in zip(*texts, strict=True)])
        self.points *= count


def design(
    name: str,
    varied: Mapping[str, object],
    points: Points | None,
    sample: Sample | None,
    replicas: int,
    draws: bool,
    noise: Noise | None,
) -> engine.Design:
    """Return the design of a sweep: all combinations of the points, the values of each key and the sample.

    Args:
        name: The name of the scenario, used in errors.
        varied: The values of keys; with a number of samples, a tuple of two numbers is a range.
        points: A table of points.
        sample: The method of the sample of the ranges and of the draws.
        replicas: The number of runs of each point.
        draws: Whether `[uncertain]` keys are drawn.
        noise: The noise of the points; if omitted, new with draws.
    """
    method, count = sample if isinstance(sample, tuple) else (sample, None)
    if count is not None and index(count) < 1:
        raise ValueError(f"sample needs a number of points of at least 1, got {count}")
    made, ranges = _Blocks(name), {}
    if points is not None:
        made.add_points(points)
    for key, values in varied.items():
        limits = _range(values) if count is not None else None
        if limits is not None:
            ranges[key] = limits
        else:
            made.add_values(key, values)
    if ranges and method is not None and count is not None:
        made.add_sample(method, index(count), ranges)
    elif sample is not None and not draws:
        why = "no key has a range (low, high) with a number of points, and no uncertain key is drawn"
        raise ValueError(f"sample: {why}")
    if draws and method is not None:
        made.native.draw(method, made.points)
    made.native.repeat(replicas)
    if noise not in ("same", "new", None):
        raise ValueError(f"noise must be 'same' or 'new', got {noise!r}")
    if noise == "same" or (noise is None and not draws):
        made.native.share_noise(0)
    return made.native


def _range(values: object) -> tuple[float, float] | None:
    """Return a range, if the values are a tuple of two numbers."""
    if isinstance(values, tuple) and len(values) == 2 and all(map(_is_number, values)):
        return float(values[0]), float(values[1])
    return None


def _is_number(value: object) -> bool:
    """True for a number that a float holds exactly, as a seed above 2**53 is not."""
    if isinstance(value, (int, np.integer)) and not isinstance(value, bool):
        return abs(int(value)) <= 2**53
    return isinstance(value, (float, np.floating))


def _column(key: str, values: object) -> list[Any]:
    """Return the values of a key as a list."""
    if isinstance(values, (str, bytes, Mapping)) or not isinstance(values, Iterable):
        raise ValueError(f"the values of {key!r} must be of shape (points,) and not empty, got {values!r}")
    as_list = getattr(values, "tolist", None)
    if as_list is not None:  # an array of NumPy, or a column of pandas
        values = as_list()
        if not isinstance(values, list):
            raise ValueError(f"the values of {key!r} must be of shape (points,), got one value")
    return list(values)


def _columns(points: Points) -> dict[str, list[Any]]:
    """Return the values of each key of a table of points."""
    if isinstance(points, (str, os.PathLike)):
        return _csv(points)
    if hasattr(points, "varied"):  # the table of a campaign, which has metrics beside its keys
        return {key: _column(key, points[key]) for key in points.varied}
    if isinstance(points, Mapping):
        return {key: _column(key, values) for key, values in points.items()}
    if hasattr(points, "columns"):  # a frame of pandas or Polars
        return {str(key): _column(str(key), points[key]) for key in points.columns}
    rows = list(points) if isinstance(points, Iterable) else [points]
    if not all(isinstance(row, Mapping) for row in rows):
        kinds = "a sequence of mappings, a mapping of columns, a data frame or the path of a CSV file"
        raise TypeError(f"points must be {kinds}")
    keys = list(rows[0]) if rows else []
    for place, row in enumerate(rows):
        if row.keys() != rows[0].keys():
            raise ValueError(
                f"point {place} has the keys {', '.join(row)}, and point 0 has {', '.join(keys)}"
            )
    return {key: [row[key] for row in rows] for key in keys}


def _csv(path: str | os.PathLike[str]) -> dict[str, list[Any]]:
    """Read a table of numbers, with a column for each key and a row for each point."""
    name = os.fspath(path)
    with open(path, encoding="utf-8-sig", newline="") as file:
        reader = csv.reader(file)
        keys = [key.strip() for key in next(reader, [])]
        wrong = next((key for key in keys if not key or _number(key) is not None), None)
        if not keys or wrong is not None:
            raise ValueError(f"{name}: must begin with the keys of its columns, got {wrong!r}")
        columns: dict[str, list[Any]] = {key: [] for key in keys}
        for row in filter(None, reader):
            if len(row) != len(keys):
                why = f"line {reader.line_num} has {len(row)} values, and there are {len(keys)} keys"
                raise ValueError(f"{name}: is not a table of points: {why}")
            for key, cell in zip(keys, row, strict=True):
                number = _number(cell.strip())
                if number is None or not isfinite(number):
                    why = f"`{key}` must be a number, got {cell.strip()!r}"
                    raise ValueError(f"{name}: line {reader.line_num}: {why}")
                columns[key].append(number)
    if len(columns) < len(keys):
        twice = next(key for place, key in enumerate(keys) if key in keys[:place])
        raise ValueError(f"{name}: {twice}: a key can be varied once")
    return columns


def _number(text: str) -> float | None:
    try:
        return None if "_" in text else float(text)
    except ValueError:
        return None
