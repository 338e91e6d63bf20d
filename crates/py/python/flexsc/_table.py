"""The table of a campaign: a row per run."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from math import prod
from operator import index
from typing import TYPE_CHECKING, Any, overload

from flexsc import _native as engine
from flexsc import _units
from flexsc._answer import CampaignAnswer
from flexsc._columns import Columns, read_only
from flexsc._deprecated import with_old_keywords
from flexsc._drawable import Drawable
from flexsc._named import Named, library, no_such
from flexsc._numpy import np, npt
from flexsc._row import Row
from flexsc._scenario import Scenario
from flexsc._values import counted, objects

if TYPE_CHECKING:
    from flexsc._ensemble import Ensemble


class Table(Columns, Drawable):
    """The results of a campaign, with one row per run: a mapping of columns.

    The columns, of shape (rows,) and read-only, are `run`, `seed`, the varied keys, the metrics, and `error`.
    Metrics are float64 with NaN where there is no value; words are str; lists are an array of arrays. `error`
    is the reason for which a run failed, or empty. Columns of a directory are read at the first access.

    >>> import flexsc
    >>> scenario = flexsc.Scenario.example("relay-sampled").with_("duration", 100.0)
    >>> table = flexsc.campaign(scenario, runs=4)
    >>> table["run"].tolist(), table.rows, table.unit("cycle_period_s")
    ([0, 1, 2, 3], 4, 's')
    >>> table.varied[0], table.unit(table.varied[0])
    ('body.planar.angle', 'rad')
    """

    scenario: Scenario
    """The scenario from which the runs were drawn.

    >>> table.scenario.name
    'relay-sampled'
    """
    varied: list[str]
    """The keys of the scenario that are varied.

    >>> table.varied[0]
    'body.planar.angle'
    """

    samples: Ensemble | None
    """The motion of all runs at the times `at` of `flexsc.campaign`; None without them.

    >>> table.samples is None
    True
    """

    def __init__(
        self,
        work: engine.Work,
        read: Callable[[str], Any],
        summaries: Callable[[], list[Any]],
    ) -> None:
        self.scenario = Scenario._of(work.scenario)
        self.varied = work.keys
        self._flags = work.flags
        self._names = work.names
        self._read = read
        self._summaries = summaries
        self._columns: dict[str, npt.NDArray[Any]] = {}
        self._statistics: dict[str, dict[str, Any]] | None = None
        self._kept: object = None
        self._work: engine.Work | None = work
        self.samples = None
        self._manifest: str | None = None
        self._design: str | None = None

    @property
    def columns(self) -> dict[str, npt.NDArray[Any]]:
        """All columns by name, as a dictionary.

        >>> import flexsc
        >>> scenario = flexsc.Scenario.example("relay-fixed").with_("duration", 50.0)
        >>> list(flexsc.sweep(scenario, "law.relay.k_t", [0.3], metrics=["duty"]).columns)
        ['run', 'seed', 'law.relay.k_t', 'duty', 'error']
        """
        return dict(self)

    def __len__(self) -> int:
        """The number of columns; `rows` is that of the rows."""
        return len(self._names)

    @overload
    def __getitem__(self, column: str) -> npt.NDArray[Any]: ...
    @overload
    def __getitem__(self, column: slice | Sequence[int] | npt.NDArray[Any]) -> Table: ...
    def __getitem__(self, column: str | slice | Sequence[int] | npt.NDArray[Any]) -> Any:
        """Return a column, of shape (rows,), which is read-only: `table[name].copy()` can be changed.

        `table["line_of_sight_rms_rad[0]"]` has an element of each list, NaN where a list has none. A slice, a
        mask or positions instead of a name give a table of these rows: `table[table["duty"] > 0.04]`.

        >>> import flexsc
        >>> scenario = flexsc.Scenario.example("relay-sampled").with_("duration", 100.0)
        >>> table = flexsc.campaign(scenario, runs=8)
        >>> table[:3].rows, table[table["duty"] >= table["duty"].max()].rows
        (3, 1)

        Raises:
            KeyError: There is no such column.
            TypeError: It is neither a name nor a slice, a mask or positions.
            IndexError: There is no such row, or a mask has another length.
        """
        if not isinstance(column, str):
            return self._taken(column)
        if column not in self._names:
            name, _, rest = column.rpartition("[")
            if name not in self._names or not rest.removesuffix("]").isdecimal():
                raise no_such("no column", column, self._names)
            return _elements(self[name], int(rest.removesuffix("]")))
        if column not in self._columns:
            values = _array(column in ("run", "seed", *self.varied), self._read(column))
            if column in self._flags:
                values = values == "true"
            read_only([values])
            self._columns[column] = values
        return self._columns[column]

    def _taken(self, places: slice | Sequence[int] | npt.NDArray[Any]) -> Table:
        """Return a table of the rows at some places."""
        chosen = np.arange(self.rows)[places] if isinstance(places, slice) else np.asarray(places)
        if chosen.ndim != 1 or (chosen.size and chosen.dtype.kind not in "biu"):
            raise TypeError(
                f"a table takes the name of a column, a slice, a mask or positions, got {places!r}"
            )
        # An empty list has no integers.
        at = np.arange(self.rows)[chosen if chosen.size else slice(0)]
        work = self._recreated_work() if not self.scenario.own_parts else self._campaign()
        columns = {name: values[at] for name, values in self.items()}

        def statistics() -> list[Any]:
            plain = {name: list(c) if c.dtype.kind == "U" else c for name, c in columns.items()}
            return engine.campaign_statistics(work, plain, len(at))

        taken = Table(work, columns.__getitem__, statistics)
        taken._flags = []
        taken.samples = None if self.samples is None else self.samples._taken(at)
        return taken

    def sorted(self, column: str, *, descending: bool = False) -> Table:
        """Return a table with its rows in the order of a column; rows without a value come last, and equal
        ones keep their order.

        >>> import flexsc
        >>> scenario = flexsc.Scenario.example("relay-sampled").with_("duration", 100.0)
        >>> table = flexsc.campaign(scenario, runs=8).sorted("duty", descending=True)
        >>> bool(table["duty"][0] == table["duty"].max())
        True

        Raises:
            KeyError: There is no such column.
        """
        values = self[column]
        if descending and values.dtype.kind == "f":
            return self[np.argsort(-values, kind="stable")]
        if descending:
            # The rows from the last one on, sorted and turned round, keep the order of equal ones.
            return self[len(values) - 1 - np.argsort(values[::-1], kind="stable")[::-1]]
        return self[np.argsort(values, kind="stable")]

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    @property
    def rows(self) -> int:
        """The number of rows, one per run.

        >>> import flexsc
        >>> scenario = flexsc.Scenario.example("relay-fixed").with_("duration", 50.0)
        >>> flexsc.sweep(scenario, "law.relay.k_t", [0.3, 0.31]).rows
        2
        """
        return len(self["run"])

    def row(self, place: int) -> Row:
        """Return the scenario and the run number of a row, counted from 0, or from the end if negative.

        The keys that vary have the values of the row, whether they were drawn or swept, and `[uncertain]` is
        left out: to simulate the scenario repeats the row to the bit.

        >>> import flexsc
        >>> scenario = flexsc.Scenario.example("relay-fixed").with_("duration", 600.0)
        >>> table = flexsc.sweep(scenario, "law.relay.k_t", [0.30, 0.31])
        >>> table.row(-1).scenario.get("law.relay.k_t")
        0.31

        Raises:
            IndexError: There is no such row.
            ScenarioError: The row is one with an `error`, as its values were not accepted.
        """
        count, at = self.rows, index(place)
        if not -count <= at < count:
            raise IndexError(f"no row {at}; the table has rows 0 to {count - 1}")
        native, run = self._campaign().run(int(self["run"][at]))
        return Row(Scenario._of(native), run)

    @with_old_keywords
    def worst(self, metric: str, *, least: bool = False) -> Row:
        """Return the row with the largest value of a metric, or with the smallest.

        Rows without a value are left out; of equal values the first counts.

        Args:
            metric: The metric, or another column of numbers.
            least: Whether small values of the metric are bad, as those of a margin.

        >>> import flexsc
        >>> scenario = flexsc.Scenario.example("relay-sampled").with_("duration", 100.0)
        >>> table = flexsc.campaign(scenario, runs=8)
        >>> worst = table.worst("duty")
        >>> worst.simulate().metrics["duty"] == table["duty"].max().item()
        True

        Raises:
            KeyError: There is no such column.
            ValueError: The column has no numbers, or no run has a value.
        """
        values = self[metric]
        if values.dtype.kind not in "iuf":
            raise ValueError(f"{metric!r} is not a column of numbers, of which one is the worst")
        if np.isnan(values).all():
            raise ValueError(f"no run has a value of {metric!r}")
        return self.row(int(np.nanargmin(values) if least else np.nanargmax(values)))

    def statistics(self) -> dict[str, dict[str, Any]]:
        """Return statistics of each numeric metric over the runs that have a value.

        For each metric: its `unit`, the number of these `runs`, their `mean`, their standard deviation `sd`
        (with runs - 1; NaN for a single run), and `quantiles`, a dictionary with the keys 0.05, 0.25, 0.5,
        0.75 and 0.95.

        >>> import flexsc
        >>> scenario = flexsc.Scenario.example("relay-sampled").with_("duration", 100.0)
        >>> duty = flexsc.campaign(scenario, runs=8).statistics()["duty"]
        >>> duty["runs"], duty["quantiles"][0.05] <= duty["mean"] <= duty["quantiles"][0.95]
        (8, True)
        """
        if self._statistics is None:
            names = ("unit", "runs", "mean", "sd")
            found = {
                name: {**dict(zip(names, numbers, strict=True)), "quantiles": dict(quantiles)}
                for name, *numbers, quantiles in self._summaries()
            }
            self._statistics = Named.of(found, "no numeric metric")
        return self._statistics

    @property
    def answer(self) -> CampaignAnswer:
        """The answer: how many runs meet the requirements, by how much, the worst run, and what drives it.

        >>> import flexsc
        >>> table = flexsc.campaign(flexsc.Scenario.example("half-turn"), runs=20)
        >>> table.answer.requirements[0]["text"]["limit"]
        '7 arcsec'
        """
        names = (*engine.answer_columns(), *self.varied)
        columns = {
            # Texts, and lists, as lists.
            name: self[name] if self[name].dtype in ("float64", "int64") else self[name].tolist()
            for name in names
            if name in self._names
        }
        return CampaignAnswer(engine.campaign_answer(self._campaign(), columns))

    def unit(self, column: str) -> str:
        """Return the unit of a column, a metric or a key; empty for a count, a ratio or a word.

        >>> import flexsc
        >>> scenario = flexsc.Scenario.example("relay-fixed").with_("duration", 50.0)
        >>> table = flexsc.sweep(scenario, "body.planar.angle", [0.0, 1e-4])
        >>> table.unit("body.planar.angle"), table.unit("cycle_period_s"), table.unit("run")
        ('rad', 's', '')

        Raises:
            KeyError: There is no such column.
        """
        if column not in self._names:
            raise no_such("no column", column, self._names)
        return self._arrow_unit()(column)

    def _arrow_unit(self) -> Callable[[str], str]:
        meanings = _units.meanings(self.scenario)

        def unit(column: str) -> str:
            if column in self.varied:
                return _units.of_key(column)
            return meanings[column]["unit"] if column in meanings else ""

        return unit

    def _about(self) -> dict[str, str]:
        return {"scenario": self.scenario.name}

    def to_xarray(self) -> Any:
        """Return the table as an `xarray.Dataset`, which must be installed (`pip install xarray`).

        A sweep over all combinations of the values of its keys has these keys as dimensions, with their
        values as coordinates, and a dimension `replica` if there are several runs per point. Any other table
        has the dimension `run`. Lists of the same length in every row have a second dimension. Each variable
        has its unit as the attribute `units`.

        >>> import flexsc
        >>> scenario = flexsc.Scenario.example("relay-fixed").with_("duration", 50.0)
        >>> keys = {"law.relay.k_t": [0.30, 0.31, 0.32], "body.planar.angle": [0.0, 1e-4]}
        >>> table = flexsc.sweep(scenario, keys)
        >>> dict(table.to_xarray()["duty"].sizes)                       # doctest: +SKIP
        {'law.relay.k_t': 3, 'body.planar.angle': 2}

        Raises:
            ImportError: xarray is not installed.
        """
        xarray = library("xarray", "Table.to_xarray")
        variables = self._variables("run")
        grid = self._grid()
        if not grid:
            coordinates = {name: variables.pop(name) for name in ("run", *self.varied)}
            return xarray.Dataset(variables, coordinates, self._about())
        unit = self._arrow_unit()
        sizes = tuple(len(values) for values in grid.values())
        replicas = self.rows // prod(sizes)
        names: tuple[str, ...] = (*grid, "replica") if replicas > 1 else tuple(grid)
        shape = (*sizes, replicas) if replicas > 1 else sizes
        shaped = {
            name: ((*names, *dimensions[1:]), values.reshape(shape + values.shape[1:]), attributes)
            for name, (dimensions, values, attributes) in variables.items()
            if name not in grid
        }
        axes = {key: ((key,), values, {"units": unit(key)}) for key, values in grid.items()}
        return xarray.Dataset(shaped, axes, self._about())

    def _grid(self) -> dict[str, Any]:
        """The values of each swept key, if the rows are all of their combinations in order."""
        drawn = self.scenario.to_dict().get("uncertain", {})
        keys = [key for key in self.varied if key not in drawn]
        if not keys or not self.rows or any(self[key].dtype == object for key in keys):
            return {}
        values = {key: self[key][np.sort(np.unique(self[key], return_index=True)[1])] for key in keys}
        points = prod(len(of_key) for of_key in values.values())
        if self.rows % points:
            return {}
        grids = np.meshgrid(*values.values(), indexing="ij")
        each = {
            key: np.repeat(grid.reshape(-1), self.rows // points)
            for key, grid in zip(keys, grids, strict=True)
        }
        return values if all(np.array_equal(each[key], self[key]) for key in keys) else {}

    def __getstate__(self) -> dict[str, Any]:
        """Return the state for pickles and copies: all columns, statistics, and the manifest of the work."""
        unpicklable = ("_read", "_summaries", "_kept", "_work")
        state = {name: value for name, value in self.__dict__.items() if name not in unpicklable}
        if self._work is not None and self.scenario.own_parts:
            state["_design"] = self._work.design.text
        elif self._work is not None:
            state["_manifest"] = self._work.manifest
        return {**state, "_columns": self.columns, "_statistics": self.statistics()}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._kept = self._work = None
        # A pickle does not keep that they are.
        read_only(self._columns.values())
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

    def _campaign(self) -> engine.Work:
        """Return work with the runs of the table, which one with parts in Python creates from the design."""
        if self._work is not None or self._design is None:
            return self._recreated_work()
        design, native = engine.Design.parse(self._design), self.scenario._native
        return engine.Work.create(native, (0, 1), design, [], None, True, True, "none")

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
        drawn = self._figures(None, ()) if self.rows > 1 and can_draw else []
        figure = _html.picture(drawn[0][1]) if drawn else ""
        statistics = _html.folded(f"{len(rows)} metrics", _html.table(head, rows))
        return _html.heading(self.scenario.name, counted(self.rows, "run")) + figure + statistics

    def __repr__(self) -> str:
        return f"<flexsc.Table of {self.scenario.name}: {counted(self.rows, 'run')}>"


def _elements(lists: npt.NDArray[Any], index: int) -> npt.NDArray[Any]:
    """The elements of lists of numbers at an index."""
    values = np.array([row[index] if index < len(row) else np.nan for row in lists], dtype=float)
    read_only([values])
    return values


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
    if isinstance(column, list):
        if column and not isinstance(column[0], str):
            return objects(column)
        return np.array(column, dtype=np.str_)
    array: npt.NDArray[Any] = column
    return array if is_given or array.dtype != np.int64 else array.astype(np.float64)
