"""The table of a campaign: a row per run."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

from flexsc import _arrow, _units
from flexsc import _native as engine
from flexsc._scenario import Scenario
from flexsc._values import counted, objects

if TYPE_CHECKING:
    import numpy.typing as npt


class Table:
    """The results of a campaign, with one row per run.

    >>> import flexsc
    >>> scenario = flexsc.Scenario.example("relay-sampled").with_("duration", 100.0)
    >>> table = flexsc.campaign(scenario, runs=4)
    >>> table["run"].tolist(), table.unit("cycle_period_s")
    ([0, 1, 2, 3], 's')
    """

    scenario: Scenario
    """The scenario from which the runs were drawn."""
    keys: list[str]
    """The keys of the scenario that are varied."""

    def __init__(
        self,
        work: engine.Work,
        read: Callable[[str], Any],
        summaries: Callable[[], list[Any]],
    ) -> None:
        self.scenario = Scenario._of(work.scenario)
        self.keys = work.keys
        self._names = work.names
        self._read = read
        self._summaries = summaries
        self._columns: dict[str, npt.NDArray[Any]] = {}
        self._statistics: dict[str, dict[str, Any]] | None = None
        self._kept: object = None
        self._work: engine.Work | None = work
        self._manifest: str | None = None

    @property
    def columns(self) -> dict[str, npt.NDArray[Any]]:
        """Columns by name, of shape (runs,): `run`, `seed`, the varied keys, the metrics, `error`.

        Metrics are float64 with NaN where there is no value; words are str; lists are an array of arrays.
        `error` is the reason for which a run failed, or empty. `pandas.DataFrame(table.columns)` accepts them
        unchanged. Columns of a directory are read at the first access.
        """
        return {name: self[name] for name in self._names}

    def __len__(self) -> int:
        return len(self["run"])

    def __getitem__(self, column: str) -> npt.NDArray[Any]:
        """Return a column, of shape (runs,)."""
        if column not in self._names:
            raise KeyError(f"no column {column!r}; there are {', '.join(self._names)}")
        if column not in self._columns:
            self._columns[column] = _array(column in ("run", "seed", *self.keys), self._read(column))
        return self._columns[column]

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def statistics(self) -> dict[str, dict[str, Any]]:
        """Return statistics of each numeric metric over the runs that have a value.

        For each metric: its `unit`, the number of these `runs`, their `mean`, their standard deviation `sd`
        (with runs - 1; NaN for a single run), and `quantiles`, a dictionary with the keys 0.05, 0.25, 0.5,
        0.75 and 0.95.
        """
        if self._statistics is None:
            names = ("unit", "runs", "mean", "sd")
            self._statistics = {
                name: {**dict(zip(names, numbers, strict=True)), "quantiles": dict(quantiles)}
                for name, *numbers, quantiles in self._summaries()
            }
        return self._statistics

    def unit(self, column: str) -> str:
        """Return the unit of a metric; empty for a count, a ratio, a word, or a key.

        Raises:
            KeyError: There is no such column.
        """
        if column not in self._names:
            raise KeyError(f"no column {column!r}; there are {', '.join(self._names)}")
        return self._unit_lookup()(column)

    def _unit_lookup(self) -> Callable[[str], str]:
        meanings = _units.meanings(self.scenario)
        return lambda column: meanings.get(column, {"unit": ""})["unit"]

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        """Return the rows through Arrow's PyCapsule interface: null where a run has no value."""
        return _arrow.stream(self.columns.items(), self._unit_lookup(), {"scenario": self.scenario.name})

    def __arrow_c_schema__(self) -> object:
        """Return the schema of the rows through Arrow's PyCapsule interface."""
        return _arrow.schema(self.columns.items(), self._unit_lookup(), {"scenario": self.scenario.name})

    def __getstate__(self) -> dict[str, Any]:
        """Return the state for pickles and copies: all columns, statistics, and the manifest of the work."""
        unpicklable = ("_read", "_summaries", "_kept", "_work")
        state = {name: value for name, value in self.__dict__.items() if name not in unpicklable}
        if self._work is not None and not self.scenario.parts:
            state["_manifest"] = self._work.manifest
        return {**state, "_columns": self.columns, "_statistics": self.statistics()}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._kept = self._work = None
        # All columns and statistics are in the state.
        self._read = self._columns.__getitem__
        self._summaries = list

    def _recreated_work(self) -> engine.Work:
        """Return the work, which a pickled or copied table creates from its manifest."""
        if self._work is None:
            if self._manifest is None:
                why = "a pickled or copied table of a scenario with parts in Python has no figures"
                raise ValueError(f"{self.scenario.name}: {why}")
            self._work = engine.Work.parse(self._manifest)
        return self._work

    def _figures(self, kind: str | None, metrics: Sequence[str]) -> list[tuple[str, engine.Figure]]:
        """The engine's figures of the table, each with its name, as drawn by `flexsc.plot`."""
        columns = {
            name: values.tolist() if values.dtype.kind == "U" else values
            for name, values in self.columns.items()
            if values.dtype.kind == "U" or values.dtype in ("float64", "int64")
        }
        return engine.campaign_figures(self._recreated_work(), columns, kind, list(metrics))

    def _repr_html_(self) -> str:
        from flexsc import _html

        rows = [
            (name, row["unit"], row["mean"], row["sd"], row["quantiles"][0.05], row["quantiles"][0.95])
            for name, row in self.statistics().items()
        ]
        head = ("metric", "unit", "mean", "sd", "5 %", "95 %")
        can_draw = self._work is not None or self._manifest is not None
        drawn = self._figures(None, ()) if len(self) > 1 and can_draw else []
        figure = _html.picture(drawn[0][1]) if drawn else ""
        statistics = _html.folded(f"{len(rows)} metrics", _html.table(head, rows))
        return _html.heading(self.scenario.name, counted(len(self), "run")) + figure + statistics

    def __repr__(self) -> str:
        return f"<flexsc.Table of {self.scenario.name}: {counted(len(self), 'run')}>"


def of_directory(path: str | os.PathLike[str], kept: object = None) -> Table:
    """Create the table of a directory. `kept` lives as long as the table."""
    directory = engine.Directory.open(path)

    def column(name: str) -> Any:
        # Without its parts it would be a campaign that has no rows yet.
        if not os.path.isdir(path):
            raise FileNotFoundError(f"{os.fspath(path)}: the directory of the campaign no longer exists")
        return directory.column(name)

    table = Table(directory.work, column, directory.statistics)
    table._kept = kept
    return table


def _array(is_given: bool, column: Any) -> npt.NDArray[Any]:
    """Return a column in its final form: counts among the metrics become float64, as some runs may have
    none."""
    import numpy as np

    if isinstance(column, list):
        if column and not isinstance(column[0], str):
            return objects(column)
        return np.array(column, dtype=np.str_)
    array: npt.NDArray[Any] = column
    return array if is_given or array.dtype != np.int64 else array.astype(np.float64)
