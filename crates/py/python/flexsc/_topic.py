"""Topics: the rows of one kind in a run, a log or a sample, as columns."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, NoReturn

from flexsc import _arrow, _units

if TYPE_CHECKING:
    import numpy.typing as npt

    from flexsc._scenario import Scenario


class Topic(Mapping[str, "npt.NDArray[Any]"]):
    """A topic: its columns by name, in the order of a log file.

    Every column has shape (rows,), or (rows, parts) for values with several parts per row, such as modes.
    Polars, PyArrow, DuckDB and pandas can read a topic directly, through Arrow's PyCapsule interface: there
    NaN, which means no value, is null, and each field has its `unit` as metadata.

    >>> import flexsc
    >>> command = flexsc.Scenario.example("relay-fixed").with_("duration", 50.0).simulate()["command"]
    >>> command.name, command.unit("torque_nm"), command["state"][0].item()
    ('command', 'rad/s²', 'RACC')
    """

    name: str
    """The name, without the slash that it has in a log file."""

    def __init__(
        self,
        name: str,
        columns: dict[str, npt.NDArray[Any]],
        scenario: Scenario | None,
        about: dict[str, str],
    ) -> None:
        self.name = name
        self._columns = columns
        self._scenario = scenario
        self._about = about
        self._reduced: bool | None = None

    def __getitem__(self, column: str) -> npt.NDArray[Any]:
        """Return a column.

        Raises:
            KeyError: There is no such column.
        """
        if column not in self._columns:
            there = ", ".join(self._columns)
            raise KeyError(f"topic {self.name!r} has no column {column!r}; there are {there}")
        return self._columns[column]

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    def unit(self, column: str) -> str:
        """Return the unit of a column; empty for a count, a ratio or a label.

        Raises:
            KeyError: There is no such column.
        """
        self[column]
        if self._reduced is None:
            self._reduced = _units.is_reduced(self._scenario)
        return _units.of_column(column, self._reduced)

    @property
    def rows(self) -> int:
        """The number of rows."""
        return len(next(iter(self._columns.values()), ()))

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        """Return the rows through Arrow's PyCapsule interface."""
        return _arrow.stream(self._columns.items(), self.unit, {**self._about, "topic": self.name})

    def __arrow_c_schema__(self) -> object:
        """Return the schema of the rows through Arrow's PyCapsule interface."""
        return _arrow.schema(self._columns.items(), self.unit, {**self._about, "topic": self.name})

    def __array__(self, *_: object, **__: object) -> NoReturn:
        # pandas would else take the names for the values.
        raise TypeError(
            "a topic is not an array: use polars.DataFrame(topic) or pandas.DataFrame(dict(topic))"
        )

    def __repr__(self) -> str:
        return f"<flexsc.Topic {self.name}: {self.rows} rows of {', '.join(self)}>"
