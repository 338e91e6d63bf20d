"""Equality of results: by content, where NaN, which means no value, equals NaN."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from flexsc._numpy import np, npt


class Compared:
    """A dataclass that compares by content; its arrays make it unhashable."""

    __slots__ = ()
    __hash__ = None  # type: ignore[assignment]

    def __eq__(self, other: object) -> bool:
        return equal(vars(self), vars(other)) if type(self) is type(other) else NotImplemented


def equal(one: Mapping[str, Any], other: Mapping[str, Any]) -> bool:
    """True if two mappings have the same names with equal values."""
    return one.keys() == other.keys() and all(_same(value, other[name]) for name, value in one.items())


def _same(one: Any, other: Any) -> bool:
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        return _same_arrays(np.asarray(one), np.asarray(other))
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        return equal(one, other)
    if isinstance(one, (list, tuple)) and type(one) is type(other):
        return len(one) == len(other) and all(map(_same, one, other))
    return bool(one == other or (one != one and other != other))


def _same_arrays(one: npt.NDArray[Any], other: npt.NDArray[Any]) -> bool:
    if one.shape != other.shape or (one.dtype == object) != (other.dtype == object):
        return False
    if one.dtype == object:
        return all(map(_same, one.flat, other.flat))
    return np.array_equal(one, other, equal_nan=one.dtype.kind == other.dtype.kind == "f")
