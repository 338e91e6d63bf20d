"""Names that are looked up: errors that list what there is, and dictionaries with them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from importlib import import_module
from typing import Any, TypeVar

from flexsc._equality import Compared, equal

_Value = TypeVar("_Value")


def no_such(what: str, name: object, names: Iterable[str]) -> KeyError:
    """Return the error of a name that does not exist, with the nearest one and all that there are.

    `what` is the beginning of its text, such as `no metric`.
    """
    from difflib import get_close_matches

    known = list(names)
    near = get_close_matches(name, known, 1) if isinstance(name, str) else []
    hint = f"did you mean {near[0]!r}? there are" if near else "there are"
    return KeyError(f"{what} {name!r}; {hint} {', '.join(known) or 'none'}")


class Named(dict[str, _Value]):
    """A dictionary whose KeyError lists its keys."""

    _what = "no key"

    @classmethod
    def of(cls, values: dict[str, _Value], what: str) -> Named[_Value]:
        """Return a dictionary with the beginning of its errors, such as `no column`."""
        named = cls(values)
        named._what = what
        return named

    def __missing__(self, name: object) -> _Value:
        raise no_such(self._what, name, self)

    def __eq__(self, other: object) -> bool:
        return equal(self, other) if isinstance(other, Mapping) else NotImplemented

    # That of a dictionary takes arrays for truth values.
    __ne__ = object.__ne__
    __hash__ = None


def _brief(value: Any) -> str:
    """Return a short text of a value: four digits of a number, the shape of an array."""
    if isinstance(value, float):
        return f"{value:.4g}"
    if hasattr(value, "shape"):
        return f"array of shape {value.shape}"
    if isinstance(value, dict):
        is_short = all(isinstance(each, float) for each in value.values())
        parts = [f"{key!r}: {_brief(each)}" if is_short else repr(key) for key, each in value.items()]
        return f"{{{', '.join(parts)}}}"
    if isinstance(value, tuple):
        if len(value) > 3 and isinstance(value[0], Brief):
            return f"{len(value)} of {type(value[0]).__name__}"
        return f"({', '.join(map(_brief, value))})"
    return repr(value)


class Brief(Compared):
    """A dataclass whose text has the shapes of its arrays, not their values."""

    def __repr__(self) -> str:
        parts = (f"{name}={_brief(value)}" for name, value in vars(self).items())
        return f"{type(self).__name__}({', '.join(parts)})"


def library(name: str, user: str, package: str | None = None) -> Any:
    """Import an optional library for a method, or raise an ImportError that says how to install it.

    `package` is the name under which it is installed, if that is not `name`.
    """
    try:
        return import_module(name)
    except ImportError as error:
        package = package or name
        raise ImportError(f"{user} needs {package}: pip install {package}") from error
