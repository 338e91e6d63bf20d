"""Paths of keys within a scenario, such as `body.planar.modes[0].frequency`."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from flexsc import _native as engine
from flexsc._named import no_such
from flexsc._values import document

if TYPE_CHECKING:
    from flexsc._scenario import Scenario

# Roles of parts in Python that no key has a place for.
BESIDE = ("disturbance", "guidance")
_STEP = re.compile(r'\.?(?:"((?:[^"\\]|\\.)*)"|([\w-]+))|\[(\d+)\]')


def get(scenario: Scenario, key: str) -> Any:
    """Return the value of a key: see `Scenario.get`."""
    path, values = steps(key), scenario.to_dict()
    above, last = value_at(values, path[:-1]), path[-1]
    if isinstance(last, str) and isinstance(above, dict) and last not in above and is_known(scenario, key):
        return None
    return value_at(values, path)


def is_known(scenario: Scenario, key: str) -> bool:
    """True if a scenario has a key, written or with its default, in a table that is written."""
    path, values = steps(key), scenario.to_dict()
    try:
        above, last = value_at(values, path[:-1]), path[-1]
    except KeyError:
        return False
    if isinstance(above, dict):
        return last in above or scenario._native.has_key(key)
    return isinstance(above, list) and isinstance(last, int) and last < len(above)


def without(
    scenario: Scenario, keys: Sequence[str], changes: Mapping[str, object] = MappingProxyType({})
) -> Scenario:
    """Return a scenario without some keys, and with changes of others: see `Scenario.without`."""
    values = scenario.to_dict()
    for key, value in changes.items():
        *above, last = steps(key)
        for place, step in enumerate(above):
            # A table that is missing is created, as `with_` does.
            table = value_at(values, above[:place])
            if isinstance(table, dict) and isinstance(step, str):
                table.setdefault(step, {})
        value_at(values, above)[last] = value
    tables: dict[str, list[str | int]] = {}
    # From the last element of an array to the first, so that the others keep their positions.
    own = {role.split()[0] for role in scenario.own_parts} & {*BESIDE}
    for path in sorted(map(steps, keys), key=_order, reverse=True):
        if len(path) == 1 and path[0] in own:
            # Parts beside the keys go with those of the file, if it has any.
            own.discard(str(path[0]))
            values.pop(path[0], None)
            tables[""] = []
            continue
        value_at(values, path)
        del value_at(values, path[:-1])[path[-1]]
        tables[written(path[:-1])] = path[:-1]
    if "" not in tables and not changes:
        return scenario.with_({above: value_at(values, path) for above, path in tables.items()})
    text, name = document(scenario.name, _beside_parts(values)), scenario.name
    parts = [
        (role, part)
        for role, part in scenario.own_parts.items()
        if role.split()[0] in (own if role.split()[0] in BESIDE else values)
    ]
    if parts:
        return type(scenario)._of(engine.beside_parts(text, name, parts))
    return type(scenario)._of(engine.Scenario.from_values(text, name))


def steps(path: str) -> list[str | int]:
    """Return the names of tables and keys on a path, and the positions in arrays.

    Raises:
        KeyError: It is not the path of a key.
    """
    found: list[str | int] = []
    at = 0
    while at < len(path):
        step = _STEP.match(path, at)
        if step is None or (at == 0 and path[0] in ".["):
            break
        quoted, name, place = step.groups()
        found.append(int(place) if place is not None else name if quoted is None else quoted)
        at = step.end()
    if at < len(path) or not found:
        raise KeyError(f"{path!r} is not the path of a key")
    return found


def value_at(values: Any, path: list[str | int]) -> Any:
    """Return the value at a path.

    Raises:
        KeyError: There is no such key; the text has those that there are.
    """
    for place, step in enumerate(path):
        above = written(path[:place])
        if isinstance(step, int):
            if not isinstance(values, list) or step >= len(values):
                count = len(values) if isinstance(values, list) else 0
                raise KeyError(f"no element {step} in {above!r}: it has {count}")
            values = values[step]
        else:
            names = values if isinstance(values, dict) else {}
            if step not in names:
                raise no_such(f"{above!r} has no key" if above else "no key", step, names)
            values = names[step]
    return values


def written(path: list[str | int]) -> str:
    """Return a path as text."""
    text = ""
    for step in path:
        if isinstance(step, int):
            text += f"[{step}]"
        else:
            text += f".{step}" if re.fullmatch(r"[\w-]+", step) else f'."{step}"'
    return text.removeprefix(".")


def _order(path: list[str | int]) -> list[tuple[str, int]]:
    """Return what paths are sorted by: elements of an array by their positions."""
    return [("", step) if isinstance(step, int) else (step, 0) for step in path]


def _beside_parts(values: dict[str, Any]) -> dict[str, Any]:
    """Return the values of a scenario without its parts in Python, which no text can hold."""

    def is_own(value: Any) -> bool:
        return isinstance(value, dict) and "own" in value

    kept: dict[str, Any] = {}
    for key, value in values.items():
        if isinstance(value, list):
            # An element in place of the part, so that the others keep their positions.
            other = "continuous" if key == "sensor" else "ideal"
            kept[key] = [other if is_own(element) else element for element in value]
        elif not is_own(value):
            kept[key] = value
    return kept
