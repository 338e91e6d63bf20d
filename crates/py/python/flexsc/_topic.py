"""Topics: the rows of one kind in a run, a log or a sample, as columns."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from flexsc import _units
from flexsc._columns import Columns, read_only
from flexsc._named import library, no_such
from flexsc._numpy import npt

if TYPE_CHECKING:
    from flexsc._scenario import Scenario


class Topic(Columns):
    """A topic: its columns by name, in the order of a log file.

    Every column has shape (rows,), or (rows, parts) for values with several parts per row, such as modes, or
    (rows, axes, modes) for modes about each axis, and is read-only. Polars, PyArrow, DuckDB and pandas can
    read a topic directly, through Arrow's PyCapsule interface: there NaN, which means no value, is null, and
    each field has its `unit` as metadata.

    >>> import flexsc
    >>> command = flexsc.Scenario.example("relay-fixed").with_("duration", 50.0).simulate()["command"]
    >>> command.name, command.unit("torque_nm"), command["state"][0].item()
    ('command', 'rad/s²', 'RACC')
    """

    name: str
    """The name, without the slash that it has in a log file.

    >>> command.name
    'command'
    """

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
        self._metadata = about
        self._reduced: bool | None = None
        read_only(columns.values())

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        # A pickle does not keep that they are.
        read_only(self._columns.values())

    def __getitem__(self, column: str) -> npt.NDArray[Any]:
        """Return a column, which is read-only: `topic[name].copy()` can be changed.

        Raises:
            KeyError: There is no such column.
        """
        if column not in self._columns:
            raise no_such(f"topic {self.name!r} has no column", column, self)
        return self._columns[column]

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    def unit(self, column: str) -> str:
        """Return the unit of a column; empty for a count, a ratio or a label.

        >>> import flexsc
        >>> run = flexsc.Scenario.example("four-clamped-modes").with_("duration", 1.0).simulate(log="full")
        >>> run["vibrations"].unit("modes.displacement")
        'm sqrt(kg)'

        Raises:
            KeyError: There is no such column.
        """
        self[column]
        if self._reduced is None:
            self._reduced = _units.is_reduced(self._scenario)
        return _units.of_column(self.name, column, self._reduced)

    def _arrow_unit(self) -> Callable[[str], str]:
        return self.unit

    def _about(self) -> dict[str, str]:
        return {**self._metadata, "topic": self.name}

    def to_xarray(self) -> Any:
        """Return the topic as an `xarray.Dataset`, which must be installed (`pip install xarray`).

        The dimension of the rows is `time_s`, with the times (s) as its coordinate, or `row` for a topic
        without times. Values with several parts per row have further dimensions, such as `modes` for
        `modes.displacement_rad`, or `axes` and `axes.modes`. Each variable has its unit as the attribute
        `units`.

        >>> import flexsc
        >>> run = flexsc.Scenario.example("relay-fixed").with_("duration", 50.0).simulate(log="full")
        >>> run["modes"].to_xarray()["modes.displacement_rad"].dims     # doctest: +SKIP
        ('time_s', 'modes')

        Raises:
            ImportError: xarray is not installed.
        """
        xarray = library("xarray", "Topic.to_xarray")
        variables = self._variables("time_s" if "time_s" in self else "row")
        times = {name: variables.pop(name) for name in ("time_s",) if name in variables}
        return xarray.Dataset(variables, times, self._about())

    def __repr__(self) -> str:
        return f"<flexsc.Topic {self.name}: {self.rows} rows of {', '.join(self)}>"
