"""Names that are looked up: errors that list what there is, and dictionaries with them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from importlib import import_module
from typing import Any, TypeVar

from flexsc._equality import Compared, equal

_Value = TypeVar("_Value")
# More names than this are not listed beside the one that was probably meant.
_MOST_NAMES = 30
# Nor are the keys of a dictionary with more in the text of a result.
_MOST_KEYS = 8


def no_such(what: str, name: object, names: Iterable[str]) -> KeyError:
    """Return the error of a name that does not exist, with the nearest one and all that there are.

    `what` is the beginning of its text, such as `no metric`.
    """
    from difflib import get_close_matches

    known = list(names)
    near = get_close_matches(name, known, 1) if isinstance(name, str) else []
    meant = f"did you mean {near[0]!r}? " if near else ""
    if len(known) > _MOST_NAMES and near:
        return KeyError(f"{what} {name!r}; {meant}there are {len(known)}")
    return KeyError(f"{what} {name!r}; {meant}there are {', '.join(known) or 'none'}")


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
        if len(value) > _MOST_KEYS and not is_short:
            return f"dict of {len(value)}"
        parts = [f"{key!r}: {_brief(each)}" if is_short else repr(key) for key, each in value.items()]
        return f"{{{', '.join(parts)}}}"
    if isinstance(value, tuple):
        if len(value) > 3 and isinstance(value[0], (Brief, dict)):
            return f"{len(value)} of {type(value[0]).__name__}"
        return f"({', '.join(map(_brief, value))})"
    return repr(value)


class Brief(Compared):
    """A result as a dataclass, which is shown with the shapes of its arrays, and as tables."""

    def __repr__(self) -> str:
        parts = (f"{name}={_brief(value)}" for name, value in vars(self).items())
        return f"{type(self).__name__}({', '.join(parts)})"

    def to_dict(self) -> dict[str, Any]:
        """Return the fields as nested dictionaries and lists; arrays stay arrays.

        >>> flexsc.Scenario.example("earth-observer").margins().to_dict()["modulus"] > 0.5
        True
        """
        return {name: _nested(value) for name, value in vars(self).items()}

    def _tables(self) -> tuple[dict[str, Any], dict[str, list[dict[str, Any]]]]:
        """Return the fields that have one value, and the rows of each that is a table."""
        values: dict[str, Any] = {}
        tables: dict[str, list[dict[str, Any]]] = {}
        for name, value in self.to_dict().items():
            rows = value
            if isinstance(value, dict) and all(isinstance(row, dict) for row in value.values()):
                rows = [{"name": key, **row} for key, row in value.items()]
            if isinstance(rows, list) and rows and all(isinstance(row, dict) for row in rows):
                tables[name] = rows
            else:
                values[name] = value
        return values, tables

    def to_pandas(self) -> dict[str, Any]:
        """Return a `pandas.DataFrame` of each table by its name, and the other values as the series `fields`.

        >>> frames = flexsc.Scenario.example("earth-observer").margins().to_pandas()    # doctest: +SKIP
        >>> frames["loops"].set_index("name")["gain_above"]                             # doctest: +SKIP

        Raises:
            ImportError: pandas is not installed.
        """
        pandas = library("pandas", f"{type(self).__name__}.to_pandas")
        values, tables = self._tables()
        frames = {name: pandas.DataFrame(rows) for name, rows in tables.items()}
        return Named.of({"fields": pandas.Series(values, dtype=object), **frames}, "no table")

    def _repr_html_(self) -> str:
        from flexsc import _html

        values, tables = self._tables()
        shown = (
            _html.folded(f"{len(rows)} {name}", _html.table(rows[0], (row.values() for row in rows)))
            for name, rows in tables.items()
        )
        fields = _html.table(("field", "value"), values.items())
        return _html.heading(type(self).__name__, "") + fields + "".join(shown)


def _nested(value: Any) -> Any:
    """Return a value with all of its dataclasses as dictionaries."""
    if hasattr(value, "__dataclass_fields__"):
        return {name: _nested(inner) for name, inner in vars(value).items()}
    if isinstance(value, Mapping):
        return {key: _nested(inner) for key, inner in value.items()}
    return [_nested(inner) for inner in value] if isinstance(value, (list, tuple)) else value


def library(name: str, user: str, package: str | None = None) -> Any:
    """Import an optional library for a method, or raise an ImportError that says how to install it.

    `package` is the name under which it is installed, if that is not `name`.
    """
    try:
        return import_module(name)
    except ImportError as error:
        package = package or name
        raise ImportError(f"{user} needs {package}: pip install {package}") from error
