"""Columns of equal length, as topics and tables have them, and their forms in other libraries."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any, NoReturn, TypeVar

from flexsc import _arrow
from flexsc._named import library

if TYPE_CHECKING:
    import numpy.typing as npt

_Value = TypeVar("_Value")


class Lookup(Mapping[str, _Value]):
    """A mapping by name that is no array, compares by content and completes its keys in notebooks."""

    __slots__ = ()
    __hash__ = None  # type: ignore[assignment]

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
        if not isinstance(other, Columns) or type(self) is not type(other):
            return NotImplemented
        return equal(self, other)

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        """Return the rows through Arrow's PyCapsule interface: NaN, which means no value, is null."""
        return _arrow.stream(self.items(), self._arrow_unit(), self._about())

    def __arrow_c_schema__(self) -> object:
        """Return the schema of the rows through Arrow's PyCapsule interface."""
        return _arrow.schema(self.items(), self._arrow_unit(), self._about())

    def to_pandas(self) -> Any:
        """Return the rows as a `pandas.DataFrame`, which must be installed (`pip install pandas`).

        A column with several parts per row becomes one column per part, such as
        `modes.displacement_rad[0]`; rows of different lengths become arrays in cells. `frame.attrs` has the
        `units` of the columns that have one, and the scenario.

        >>> import flexsc
        >>> run = flexsc.Scenario.example("relay-fixed").with_("duration", 50.0).simulate(log="full")
        >>> frame = run["modes"].to_pandas()                            # doctest: +SKIP
        >>> frame["modes.displacement_rad[1]"].abs().max()              # doctest: +SKIP

        Raises:
            ImportError: pandas is not installed.
        """
        pandas = library("pandas", f"{type(self).__name__}.to_pandas")
        unit = self._arrow_unit()
        flat: dict[str, Any] = {}
        units: dict[str, str] = {}
        for name, values in self.items():
            parts = {name: values}
            if values.ndim == 2:
                parts = {f"{name}[{part}]": values[:, part] for part in range(values.shape[1])}
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
        found = {}
        for name, values in self.items():
            values = rectangular(values)
            dimensions: tuple[str, ...] = (dimension,)
            if values.ndim == 2:
                # The parts of a list have the name of the list.
                dimensions += (name.rpartition(".")[0] or f"{name}_index",)
            found[name] = (dimensions, values, {"units": unit(name)} if unit(name) else {})
        return found


class _Stream:
    """Columns as nothing but a stream of Arrow."""

    def __init__(self, columns: Columns) -> None:
        self._columns = columns

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        return self._columns.__arrow_c_stream__(requested_schema)


def equal(one: Mapping[str, npt.NDArray[Any]], other: Mapping[str, npt.NDArray[Any]]) -> bool:
    """True if two mappings have the same names with equal arrays; NaN, no value, equals NaN."""
    return one.keys() == other.keys() and all(_same(values, other[name]) for name, values in one.items())


def _same(one: npt.NDArray[Any], other: npt.NDArray[Any]) -> bool:
    import numpy as np

    if one.shape != other.shape or (one.dtype == object) != (other.dtype == object):
        return False
    if one.dtype == object:
        return all(_same(*pair) for pair in zip(one, other, strict=True))
    return np.array_equal(one, other, equal_nan=one.dtype.kind == other.dtype.kind == "f")


def rectangular(values: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Return rows within rows as an array of shape (rows, parts), if all rows have the same length."""
    import numpy as np

    if values.dtype != object or not len(values) or len({len(row) for row in values}) != 1:
        return values
    return np.stack(list(values))


def read_only(arrays: Iterable[npt.NDArray[Any]]) -> None:
    """Make arrays read-only, and arrays within them."""
    for array in arrays:
        if array.dtype == object:
            read_only(array)
        array.flags.writeable = False
