"""The way back from the keys of a scenario to the classes of `flexsc.scenario`."""

from __future__ import annotations

import types
import typing
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from flexsc import _keys
from flexsc._part import Part
from flexsc.scenario import Keys

if TYPE_CHECKING:
    from flexsc._scenario import Scenario

# The types of the keys of each class, which take long to find.
_HINTS: dict[type[Any], dict[str, Any]] = {}


def part_at(scenario: Scenario, key: str, kind: type[Part] | None) -> Any:
    """Return the part at a key: see `Scenario.part`."""
    found = _keys.get(scenario, key)
    if found is not None:
        root, *path = _keys.steps(key)
        found = _descend(_read(_kinds_of(Keys, str(root)), scenario.get(_keys.written([root]))), path)
    if _has_own(found):
        raise ValueError(f"`{key}` has a part of your own: `Scenario.own_parts` has it")
    if kind is not None and not isinstance(found, kind):
        raise TypeError(f"`{key}` is no {kind.__name__}, but {type(found).__name__}")
    return found


def _descend(part: Any, path: Sequence[str | int]) -> Any:
    """Return what a path leads to within a part."""
    # A part is reached by its key, then by the name of its kind, if the file has both.
    entered = False
    for step in path:
        if isinstance(part, Part) and part._holds_one and entered:
            part, entered = getattr(part, part._names[0]), False
        if not isinstance(part, Part):
            part, entered = part[step], False
        elif not entered and part._tag is not None:
            entered = True
        else:
            name = _python_names(type(part))[str(step)]
            part, entered = getattr(part, name), name in part._bare
    return part


def _has_own(value: Any) -> bool:
    """True if a value is a part in Python, which is no class of `flexsc.scenario`, or has one within it."""
    if isinstance(value, list):
        return any(map(_has_own, value))
    if isinstance(value, Part):
        return any(_has_own(getattr(value, name)) for name in value._names)
    return isinstance(value, dict) and value.keys() == {"own"}


def _read(kinds: tuple[Any, ...], value: Any, bare: bool = False) -> Any:
    """Return a value as the class, or the list or table of classes, of its type."""
    for kind in kinds:
        origin = typing.get_origin(kind)
        if isinstance(kind, type) and issubclass(kind, Part):
            if not isinstance(value, dict):
                continue
            if kind._tag is None or bare:
                if value.keys() <= _python_names(kind).keys():
                    return _part(kind, value)
            elif list(value) == [kind._tag]:
                return _part(kind, value[kind._tag])
        elif origin is Sequence and isinstance(value, list):
            inner = _kinds(typing.get_args(kind)[0])
            return [_read(inner, one) for one in value]
        elif origin is Mapping and isinstance(value, dict):
            inner = _kinds(typing.get_args(kind)[1])
            return {name: _read(inner, one) for name, one in value.items()}
    return value


def _part(kind: type[Any], content: Any) -> Any:
    """Return a part of a class with the keys of a table, or with the one value that it holds."""
    if kind._holds_one:
        return kind(_read(_kinds_of(kind, kind._names[0]), content))
    names = _python_names(kind)
    return kind(
        **{
            names[key]: _read(_kinds_of(kind, names[key]), value, names[key] in kind._bare)
            for key, value in content.items()
        }
    )


def _python_names(kind: type[Part]) -> dict[str, str]:
    """The names of the keys of a class in Python, which keeps some for itself, by those of a file."""
    return {name.rstrip("_"): name for name in kind._names}


def _kinds_of(owner: type[Any], name: str) -> tuple[Any, ...]:
    """The types that a key of a class may be."""
    if owner not in _HINTS:
        # Arrays of NumPy count as sequences.
        arrays = types.SimpleNamespace(NDArray=Sequence)
        _HINTS[owner] = typing.get_type_hints(owner, localns={"npt": arrays})
    return _kinds(_HINTS[owner].get(name))


def _kinds(kind: Any) -> tuple[Any, ...]:
    """The types of a union, with those of the unions in it."""
    if typing.get_origin(kind) in (typing.Union, types.UnionType):
        return tuple(inner for one in typing.get_args(kind) for inner in _kinds(one))
    return (kind,)
