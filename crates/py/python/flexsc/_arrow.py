"""Columns for other libraries, through Arrow's PyCapsule interface."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from flexsc import _native as engine

if TYPE_CHECKING:
    import numpy.typing as npt

_Given = tuple[str, str, int | None, list[int] | None, Any]


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
    if array.dtype == object:
        parts: list[npt.NDArray[Any]] = list(array)
        offsets = [0]
        for part in parts:
            offsets.append(offsets[-1] + len(part))
        return name, unit, None, offsets, _joined(parts)
    if array.ndim == 2:
        return name, unit, array.shape[1], None, _flat(array.reshape(-1))
    return name, unit, None, None, _flat(array)


def _joined(parts: list[npt.NDArray[Any]]) -> Any:
    import numpy as np

    return _flat(np.concatenate(parts)) if parts else np.empty(0)


def _flat(array: npt.NDArray[Any]) -> Any:
    return array.tolist() if array.dtype.kind == "U" else array
