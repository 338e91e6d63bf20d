"""Columns for other libraries, through Arrow's PyCapsule interface."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from flexsc import _native as engine
from flexsc._numpy import np, npt

_Given = tuple[str, str, int, list[int | list[int]], Any]


def stream(
    columns: Iterable[tuple[str, npt.NDArray[Any]]], unit: Callable[[str], str], about: dict[str, str]
) -> object:
    """A capsule with a stream of one batch: NaN is null, what has a unit has it in its field's metadata."""
    return engine.arrow_stream([_given(name, unit(name), array) for name, array in columns], about)


def schema(
    columns: Iterable[tuple[str, npt.NDArray[Any]]], unit: Callable[[str], str], about: dict[str, str]
) -> object:
    """A capsule with the schema of the stream."""
    return engine.arrow_schema([_given(name, unit(name), array) for name, array in columns], about)


def _given(name: str, unit: str, array: npt.NDArray[Any]) -> _Given:
    """A column as the engine takes it: rows within rows by their width, or by where each begins and ends."""
    rows, lists = len(array), list[int | list[int]]()
    while array.dtype == object or array.ndim > 1:
        if array.dtype == object:
            parts: list[npt.NDArray[Any]] = list(array)
            offsets = [0]
            for part in parts:
                offsets.append(offsets[-1] + len(part))
            lists.append(offsets)
            array = _joined(parts)
        else:
            # Polars reads no lists of the fixed length 0.
            lists.append(array.shape[1] or [0] * (len(array) + 1))
            array = array.reshape(array.shape[0] * array.shape[1], *array.shape[2:])
    # A text has no NumPy type that the engine reads.
    return name, unit, rows, lists, array.tolist() if array.dtype.kind == "U" else array


def _joined(parts: list[npt.NDArray[Any]]) -> npt.NDArray[Any]:
    """The rows of all parts, one behind another; rows of unlike shapes as an array of arrays."""
    from flexsc._values import objects

    if not parts:
        return np.empty(0)
    if len({part.shape[1:] for part in parts}) == 1 and all(part.dtype != object for part in parts):
        return np.concatenate(parts)
    return objects([row for part in parts for row in part])
