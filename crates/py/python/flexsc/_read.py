"""Results from the JSON of the engine: what the fields of `flexsc.results` are read from, and how."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import field, fields
from math import inf, nan
from typing import Any, TypeVar

from flexsc._deprecated import with_old_members
from flexsc._named import Brief
from flexsc._numpy import np, npt

T = TypeVar("T", bound="Data")
# What reads a value, of the whole result.
Reader = Callable[[Any, Any], Any]


class Data(Brief):
    """A result, whose fields are declared with `at`."""

    def __init_subclass__(cls) -> None:
        # Pickles, `help` and tracebacks name the place where users find a class.
        cls.__module__ = "flexsc"
        with_old_members(cls)

    @classmethod
    def _read(cls: type[T], found: Mapping[str, Any], whole: Mapping[str, Any] | None = None) -> T:
        """Return the result of JSON, which is part of a whole one."""
        known: Any = fields(cls)  # type: ignore[arg-type]
        return cls(*(each.metadata["read"](found, found if whole is None else whole) for each in known))


def at(path: str, read: Reader) -> Any:
    """Return a field that is read from this path; what is missing is None to its reader."""

    def reader(found: Any, whole: Any) -> Any:
        for name in path.split("."):
            found = None if found is None else found.get(name)
        return read(found, whole)

    return field(metadata={"read": reader})


def plain(value: Any, _: Any) -> Any:
    return value


def number(value: Any, _: Any) -> float:
    return nan if value is None else value


def bounded(value: Any, _: Any) -> float:
    return inf if value is None else value


def array(value: Any, _: Any) -> npt.NDArray[np.float64]:
    """Return numbers, NaN for those that are missing, as an array that cannot be changed."""
    numbers = np.array([] if value is None else value, dtype=np.float64)
    numbers.setflags(write=False)
    return numbers


def tuple_of(read: Reader) -> Reader:
    return lambda value, whole: None if value is None else tuple(read(each, whole) for each in value)


def columns(**names: str) -> Reader:
    """Columns of rows of numbers, from their names in JSON."""
    return lambda value, _: {name: array([row[key] for row in value], None) for name, key in names.items()}


def column(key: str) -> Reader:
    return lambda value, _: array([row[key] for row in value], None)


def one(kind: type[Data]) -> Reader:
    return lambda value, whole: None if value is None else kind._read(value, whole)


def attributes(**readers: tuple[str, Reader]) -> Reader:
    """A dictionary with some of the fields of an object."""
    return lambda value, whole: (
        None if value is None else {name: read(value[key], whole) for name, (key, read) in readers.items()}
    )


def parts(*readers: tuple[str, Reader]) -> Reader:
    """A tuple of some of the fields of an object."""
    return lambda value, whole: tuple(read(value[key], whole) for key, read in readers)


def part(key: str, read: Reader) -> Reader:
    return lambda value, whole: read(value[key], whole)


def keyed(key: str, read: Reader) -> Reader:
    """A dictionary of a list, by a field of its elements."""
    return lambda value, whole: None if value is None else {each[key]: read(each, whole) for each in value}


def named(names: str, read: Reader) -> Reader:
    """A dictionary of a list, whose names are a list of the whole result."""
    return lambda value, whole: {
        name: read(each, whole) for name, each in zip(whole[names], value, strict=True)
    }
