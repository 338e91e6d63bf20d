"""Values between Python and the engine: generated TOML, dates, arrays of columns."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Callable, Mapping
from datetime import date, datetime, time
from operator import index
from typing import TYPE_CHECKING, Any

from flexsc import _native as engine
from flexsc._native import ScenarioError
from flexsc._numpy import np, npt
from flexsc._part import Part

if TYPE_CHECKING:
    from flexsc._native import _Column
    from flexsc._scenario import Scenario

AXES = ("roll", "pitch", "yaw")
# No scenario is nested deeper; a dictionary may hold itself.
_DEEPEST = 16
_DATE = "$__toml_private_datetime"


def counted(count: int, thing: str) -> str:
    """Return a count and what is counted: `1 mode`, `2 modes`."""
    return f"{count} {thing}" if count == 1 else f"{count} {thing}s"


def kind_of(part: str | Mapping[str, Any]) -> tuple[str, dict[str, Any]]:
    """Return the kind of a part and its keys: a part without keys is a word."""
    return (part, {}) if isinstance(part, str) else next(iter(part.items()))


def toml(origin: str, key: str, value: object, depth: int = 0) -> str:
    """Write a value as TOML; what TOML cannot express is an error at its key."""

    def refused(why: str) -> ScenarioError:
        return _mistaken(f"{origin}: `{key}`", key, why)

    if depth > _DEEPEST:
        raise refused("nested too deep")
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        if not -(2**63) <= value < 2**63:
            raise refused("found no whole number that fits 64 bits")
        return str(int(value))
    if isinstance(value, float):
        return repr(float(value))
    if isinstance(value, str):
        return _quoted(value, refused)
    if isinstance(value, (date, time)):
        return value.isoformat().replace("+00:00", "Z")
    if isinstance(value, Part):
        values = value.to_dict()
        # A path may have the name of the kind: `actuator.wheels`.
        kind = key.rpartition(".")[2]
        inner = values[kind] if kind == value._tag and kind in values else values
        return toml(origin, key, inner, depth + 1)
    if isinstance(value, Mapping):
        pairs = []
        for name, inner in value.items():
            if not isinstance(name, str):
                raise refused(f"found a key of type {type(name).__name__}, expected a str")
            pairs.append(f"{_quoted(name, refused)} = {toml(origin, _path(key, name), inner, depth + 1)}")
        return f"{{{', '.join(pairs)}}}"
    if isinstance(value, (list, tuple)):
        items = (toml(origin, f"{key}[{index}]", inner, depth + 1) for index, inner in enumerate(value))
        return f"[{', '.join(items)}]"
    if hasattr(type(value), "to_base_units"):  # of pint
        # Units of other libraries do not tell Hz from rad/s.
        raise refused("found a quantity, expected its number in SI units, or a text such as '0.02 Hz'")
    as_list = getattr(value, "tolist", None)
    if as_list is not None:  # an array or a scalar of numpy
        return toml(origin, key, as_list(), depth + 1)
    found = "None; a key without a value is left out" if value is None else type(value).__name__
    raise refused(f"expected a number, a bool, a str, a list or a dict, found {found}")


def document(name: str, values: Mapping[str, object]) -> str:
    """Write a dictionary as a TOML document."""
    lines = []
    for key, value in values.items():
        if not isinstance(key, str):
            raise _mistaken(name, None, f"found a key of type {type(key).__name__}, expected a str")
        lines.append(f"{_quoted(key)} = {toml(name, _path('', key), value)}\n")
    return "".join(lines)


def _path(above: str, key: str) -> str:
    step = key if re.fullmatch(r"[\w-]+", key) else f'"{key}"'
    return f"{above}.{step}" if above else step


def _mistaken(place: str, key: str | None, why: str) -> ScenarioError:
    """Make the error that the engine would raise."""
    error = ScenarioError(f"{place}: {why}")
    error.mistakes = [{"line": None, "column": None, "key": key, "message": why, "suggestion": None}]
    return error


def _keyless(why: str) -> ScenarioError:
    return _mistaken("a key", None, why)


def _quoted(text: str, refused: Callable[[str], ScenarioError] = _keyless) -> str:
    try:
        text.encode()
    except UnicodeEncodeError:
        raise refused("found a str that is not Unicode") from None
    # As JSON, whose only character that TOML wants escaped is this one.
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def plain(text: str) -> Any:
    """Read the engine's JSON, in which dates are marked."""
    return json.loads(text, object_hook=lambda table: _date(table[_DATE]) if _DATE in table else table)


def _date(text: str) -> datetime | str:
    parts = re.fullmatch(r"(\S{10})T(\d\d:\d\d)(:\d\d)?(?:\.(\d+))?(Z|[+-]\d\d:\d\d)?", text)
    if parts is None:
        return text
    day, minute, second, fraction, zone = parts.groups("")
    zone = "+00:00" if zone == "Z" else zone
    try:
        return datetime.fromisoformat(f"{day}T{minute}{second or ':00'}.{fraction[:6]:0<6}{zone}")
    except ValueError:  # a leap second
        return text


def arrays(columns: Mapping[str, _Column]) -> dict[str, npt.NDArray[Any]]:
    """Give columns their final form: labels and texts as str, rows within rows by their path."""
    final: dict[str, npt.NDArray[Any]] = {}
    for name, column in columns.items():
        if isinstance(column, np.ndarray):
            final[name] = column
        elif isinstance(column, list):
            final[name] = np.array(column, dtype=np.str_)
        elif isinstance(column[1], list):
            indices, labels = column
            # A value that the labels do not know, of a log by another version, is an empty text.
            final[name] = np.array([*labels, ""], dtype=np.str_).take(indices, mode="clip")
        else:
            counts = column[0]
            for field, values in arrays(column[1]).items():
                # A list of numbers has no fields.
                final[f"{name}.{field}" if field else name] = _by_row(values, counts)
    return final


def _by_row(values: npt.NDArray[Any], counts: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Values of lists, one behind another, by the rows that have so many of them each."""
    if not len(counts):
        return values
    if values.dtype != object and (counts == counts[0]).all():
        return values.reshape(len(counts), int(counts[0]), *values.shape[1:])
    return objects(np.split(values, np.cumsum(counts)[:-1]))


def objects(items: list[Any]) -> npt.NDArray[Any]:
    """Put arrays into an array, as they are."""
    array = np.empty(len(items), dtype=object)
    for place, item in enumerate(items):
        array[place] = item
    return array


def checked(scenario: Scenario) -> Scenario:
    """Check that an argument is a scenario."""
    if not isinstance(getattr(scenario, "_native", None), engine.Scenario):
        hint = ": Scenario.load reads a file" if isinstance(scenario, (str, os.PathLike)) else ""
        raise TypeError(f"scenario must be a flexsc.Scenario, got {scenario!r}{hint}")
    return scenario


def number_to_vary(key: str, value: object) -> float:
    """Return the value of a key that is to be varied as a number.

    Raises:
        ValueError: The value is not a number.
    """
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise ValueError(f"{key} has no number to vary, it is {value!r}")
    return float(value)


def run_number(number: int) -> int:
    """Check the number of a run."""
    if not 0 <= index(number) < 2**63:
        raise ValueError(f"the number of a run must be from 0 to 2**63 - 1, got {number}")
    return index(number)
