"""Columns of equal length, as topics and tables have them, and their forms in other libraries."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any, NoReturn, TypeVar

from flexsc import _arrow
from flexsc._equality import equal
from flexsc._named import library
from flexsc._numpy import np, npt

_Value = TypeVar("_Value")


class Lookup(Mapping[str, _Value]):
    """A mapping by name that is no array, compares by content and completes its keys in notebooks."""

    __slots__ = ()
    __hash__ = None  # type: ignore[assignment]

    def __eq__(self, other: object) -> bool:
        return equal(self, other) if isinstance(other, Mapping) else NotImplemented

    def __array__(self, *_: object, **__: object) -> NoReturn:
        # NumPy and pandas would take the names for the values.
        raise TypeError(f"{self._described()} is not an array: {self._instead}")

    _instead = "index it by name"

    def _described(self) -> str:
        name = type(self).__name__
        return f"a {name}" if name == "Quantities" else f"a {name.lower()}"

    def _ipython_key_completions_(self) -> list[str]:
        """Return the keys, which Jupyter and IPython complete."""
        return list(self)


class Columns(Lookup["npt.NDArray[Any]"]):
    """Columns of equal length by name, with units."""

    _instead = "use to_pandas(), to_polars() or to_xarray(), or index it by name"

    def _arrow_unit(self) -> Callable[[str], str]:
        """Return a function that returns the unit of each column."""
        raise NotImplementedError

    def _about(self) -> dict[str, str]:
        """Return the metadata of the columns: the name of the scenario and so on."""
        raise NotImplementedError

    @property
    def rows(self) -> int:
        """The number of rows.

        >>> import flexsc
        >>> run = flexsc.Scenario.example("relay-fixed").with_("duration", 50.0).simulate()
        >>> run["command"].rows == len(run["command"]["time_s"])
        True
        """
        return len(next(iter(self.values()), ()))

    def __eq__(self, other: object) -> bool:
        return super().__eq__(other) if type(self) is type(other) else NotImplemented

    __hash__ = None

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        """Return the rows through Arrow's PyCapsule interface: NaN, which means no value, is null."""
        return _arrow.stream(self.items(), self._arrow_unit(), self._about())

    def __arrow_c_schema__(self) -> object:
        """Return the schema of the rows through Arrow's PyCapsule interface."""
        return _arrow.schema(self.items(), self._arrow_unit(), self._about())

    def to_pandas(self) -> Any:
        """Return the rows as a `pandas.DataFrame`, which must be installed (`pip install pandas`).

        A column with several parts per row becomes one column per part, such as
        `modes.displacement_rad[0]` or `axes.modes.displacement_rad[2][0]`; rows of different lengths become
        arrays in cells. `frame.attrs` has the `units` of the columns that have one, and the scenario.

        >>> import flexsc
        >>> run = flexsc.Scenario.example("relay-fixed").with_("duration", 50.0).simulate(log="full")
        >>> frame = run["modes"].to_pandas()                            # doctest: +SKIP
        >>> frame["modes.displacement_rad[1]"].abs().max()              # doctest: +SKIP

        Raises:
            ImportError: pandas is not installed.
        """
        from numpy import ndindex

        pandas = library("pandas", f"{type(self).__name__}.to_pandas")
        unit = self._arrow_unit()
        flat: dict[str, Any] = {}
        units: dict[str, str] = {}
        for name, values in self.items():
            parts = {}
            for place in ndindex(values.shape[1:]):
                parts[name + "".join(f"[{part}]" for part in place)] = values[(slice(None), *place)]
            flat |= parts
            if unit(name):
                units |= dict.fromkeys(parts, unit(name))
        frame = pandas.DataFrame(flat)
        frame.attrs.update({**self._about(), "units": units})
        return frame

    def to_polars(self) -> Any:
        """Return the rows as a `polars.DataFrame`, which must be installed (`pip install polars`).

        A column with several parts per row becomes a column of arrays; NaN, which means no value, becomes
        null.

        >>> import flexsc
        >>> run = flexsc.Scenario.example("relay-fixed").with_("duration", 50.0).simulate()
        >>> run["command"].to_polars().filter(state="RACC")             # doctest: +SKIP

        Raises:
            ImportError: Polars is not installed.
        """
        # As a mapping its NaN would stay NaN.
        return library("polars", f"{type(self).__name__}.to_polars").DataFrame(_Stream(self))

    def _variables(self, dimension: str) -> dict[str, tuple[tuple[str, ...], Any, dict[str, str]]]:
        """Return the columns for xarray: the names of the dimensions, the values and the unit of each."""
        unit = self._arrow_unit()
        found: dict[str, tuple[tuple[str, ...], Any, dict[str, str]]] = {}
        for name, values in self.items():
            values = rectangular(values)
            dimensions = (dimension, *_dimensions(name, values.ndim - 1))
            found[name] = (dimensions, values, {"units": unit(name)} if unit(name) else {})
        return found


class _Stream:
    """Columns as nothing but a stream of Arrow."""

    def __init__(self, columns: Columns) -> None:
        self._columns = columns

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        return self._columns.__arrow_c_stream__(requested_schema)


def _dimensions(name: str, count: int) -> list[str]:
    """The dimensions of the lists in a column: the parts of a list have the name of the list."""
    path = name.split(".")[:-1]
    lists = [".".join(path[:end]) for end in range(max(1, len(path) - count + 1), len(path) + 1)]
    # A list of numbers within them has no name but that of the column.
    return [*lists, *(f"{name}_index" + "_index" * depth for depth in range(count - len(lists)))]


def rectangular(values: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Return rows within rows as an array of shape (rows, parts, ...), if all rows have the same shape."""
    if values.dtype != object or not len(values):
        return values
    rows = [rectangular(row) for row in values]
    if any(row.dtype == object for row in rows) or len({row.shape for row in rows}) != 1:
        return values
    return np.stack(rows)


def read_only(arrays: Iterable[npt.NDArray[Any]]) -> None:
    """Make arrays read-only, and arrays within them."""
    for array in arrays:
        if array.dtype == object:
            read_only(array)
        array.flags.writeable = False
