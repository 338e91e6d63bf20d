"""Results from the JSON of the engine: their fields say what is read."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from math import nan
from typing import Any, TypeVar

from flexsc._numpy import np

T = TypeVar("T")

# Units at the end of names in JSON, which attributes do without.
_UNITS = ("", "_s", "_rad", "_rad_s", "_hz")


def read(kind: type[T], found: Mapping[str, Any], **given: Any) -> T:
    """Return a result whose fields are those of JSON by name, with or without a unit, but for those given.

    A number that is missing is NaN; lists become arrays and tuples as fields say.
    """
    for field in fields(kind):  # type: ignore[arg-type]
        name = next((field.name + unit for unit in _UNITS if field.name + unit in found), None)
        if name and field.name not in given:
            given[field.name] = _value(found[name], str(field.type))
    return kind(**given)


def _value(value: Any, declared: str) -> Any:
    if declared in ("Values", "npt.NDArray[np.float64]"):
        return np.array(value, dtype=np.float64)
    if value is None:
        return nan if declared == "float" else None
    return tuple(value) if declared.startswith("tuple") else value
