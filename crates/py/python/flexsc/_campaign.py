"""Campaigns and sweeps: many runs of one scenario, as a table."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from math import prod
from operator import index
from typing import TYPE_CHECKING, Any, Literal

from flexsc import _arrow, _units
from flexsc import _native as engine
from flexsc._scenario import Scenario, run_number
from flexsc._values import counted, objects

if TYPE_CHECKING:
    from concurrent.futures import Executor

    import numpy.typing as npt

Sample = Literal["random", "latin-hypercube", "sobol"]
"""The method by which the `[uncertain]` keys are drawn."""


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
        self._work = work

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
        return self._told()(column)

    def _told(self) -> Callable[[str], str]:
        told = _units.meanings(self.scenario)
        return lambda column: told.get(column, {"unit": ""})["unit"]

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        """Return the rows through Arrow's PyCapsule interface: null where a run has no value."""
        return _arrow.stream(self.columns.items(), self._told(), {"scenario": self.scenario.name})

    def __arrow_c_schema__(self) -> object:
        """Return the schema of the rows through Arrow's PyCapsule interface."""
        return _arrow.schema(self.columns.items(), self._told(), {"scenario": self.scenario.name})

    def _figures(self, kind: str | None, metrics: Sequence[str]) -> list[tuple[str, engine.Figure]]:
        """The engine's figures of the table, each with its name, as drawn by `flexsc.plot`."""
        columns = {
            name: values.tolist() if values.dtype.kind == "U" else values
            for name, values in self.columns.items()
            if values.dtype.kind == "U" or values.dtype in ("float64", "int64")
        }
        return engine.campaign_figures(self._work, columns, kind, list(metrics))

    def _repr_html_(self) -> str:
        from flexsc import _html

        rows = [
            (name, told["unit"], told["mean"], told["sd"], told["quantiles"][0.05], told["quantiles"][0.95])
            for name, told in self.statistics().items()
        ]
        head = ("metric", "unit", "mean", "sd", "5 %", "95 %")
        drawn = self._figures(None, ()) if len(self) > 1 else []
        figure = _html.picture(drawn[0][1]) if drawn else ""
        statistics = _html.folded(f"{len(rows)} metrics", _html.table(head, rows))
        return _html.heading(self.scenario.name, counted(len(self), "run")) + figure + statistics

    def __repr__(self) -> str:
        return f"<flexsc.Table of {self.scenario.name}: {counted(len(self), 'run')}>"


def campaign(
    scenario: Scenario,
    runs: int | range = 1000,
    jobs: int | None = None,
    seed: int | None = None,
    yes: bool = False,
    *,
    metrics: Sequence[str] | None = None,
    sample: Sample = "random",
    replicas: int = 1,
    out: str | os.PathLike[str] | None = None,
    executor: Executor | None = None,
    task_s: float = 1.0,
    force: bool = False,
    progress: Callable[[int, int], None] | None = None,
) -> Table:
    """Simulate many runs of a scenario, with new noise and newly drawn `[uncertain]` keys for each.

    A run does not depend on the other runs of the call: partial campaigns such as `range(500, 1000)` add up
    to the whole. It does not depend on threads, processes or machines either.

    Args:
        scenario: The scenario from which the runs are drawn.
        runs: The number of runs, or their range (of step 1).
        jobs: Number of threads, at most 1024; if omitted, one per core, or one in each task of an executor.
            Parts written in Python run one at a time on any number of threads: with them the default is one.
        seed: Seed that replaces the scenario's.
        yes: Run even if the estimate is more than 10 h on one core, 4 GB of memory or 20 GB of logs.
        metrics: The metrics in the table; if omitted, all of them.
        sample: The method by which the `[uncertain]` keys are drawn.
        replicas: Number of runs per drawn point, which differ only in their noise.
        out: The directory for the rows, as Parquet files; it is created if missing. A location that `fsspec`
            supports, such as `s3://bucket/study`, is accepted. The same call continues a stopped campaign.
        executor: The executor of the runs, such as a `concurrent.futures.ProcessPoolExecutor`, or Dask's
            through `flexsc.dask.campaign`. Workers write their rows to `out`, which all of them must be able
            to reach; without `out` the rows return through this process. Parts written in Python travel with
            the tasks, if they can be pickled.
        task_s: Approximate duration of a task of the executor (s).
        force: Replace another campaign in `out`.
        progress: Called after each task with the number of finished runs and the total number.

    Raises:
        ScenarioError: The scenario does not allow this variation. A failed run is a row with an `error`.
        ValueError: There are more than 100 000 000 runs, `yes` is needed, `out` contains another campaign, or
            parts written in Python cannot be pickled.
        OSError: `out` cannot be written, or another process is using it.

    >>> import flexsc
    >>> scenario = flexsc.Scenario.example("relay-sampled").with_("duration", 600.0)
    >>> table = flexsc.campaign(scenario, runs=8, metrics=["switchings", "duty"])
    >>> len(table), table["switchings"].shape
    (8, (8,))
    >>> round(table.statistics()["duty"]["mean"], 3)
    0.041
    """
    numbers = runs if isinstance(runs, range) else range(index(runs))
    if numbers.step != 1 or not numbers:
        raise ValueError(f"runs must be a number of runs, or a non-empty range of step 1, got {runs!r}")
    if not task_s > 0.0:
        raise ValueError(f"task_s must be a positive number, got {task_s}")
    if index(replicas) < 1:
        raise ValueError(f"replicas must be at least 1, got {replicas}")
    if seed is not None:
        scenario = scenario.with_("seed", seed)
    span = (run_number(numbers.start), run_number(numbers.stop))
    if jobs is None and scenario.parts:
        jobs = 1
    names = None if metrics is None else list(metrics)
    part_s = None if executor is None else task_s
    work = engine.Work.of(scenario._native, span, [], sample, replicas, names, part_s, yes)
    if out is None and executor is None and progress is None:
        return _made(work, jobs)
    if executor is not None and out is None and scenario.parts:
        from flexsc import _brought

        study = (span, sample, replicas, names)
        return _brought.run(scenario, study, work, executor, _threads(jobs), task_s, progress)
    from flexsc._executor import run

    return run(work, out, executor, _threads(jobs), task_s, force, progress)


def sweep(
    scenario: Scenario,
    key: str | Mapping[str, Sequence[float] | npt.NDArray[Any]],
    values: Sequence[float] | npt.NDArray[Any] | None = None,
    jobs: int | None = None,
    seed: int | None = None,
    yes: bool = False,
    *,
    metrics: Sequence[str] | None = None,
    replicas: int = 1,
) -> Table:
    """Simulate a scenario once per value of a key, or per combination of the values of several keys.

    For one key, run i has value i. For several keys, the value of the last key changes fastest:
    `table[metric].reshape(len(first), len(second))` is a map.

    Args:
        scenario: The scenario to vary.
        key: The key, such as `law.relay.k_t`, or a mapping from each key to its values.
        values: The values of a single key, of shape (runs,), such as `numpy.linspace(0.28, 0.40, 25)`.
        jobs: Number of threads, at most 1024; if omitted, one per core.
        seed: Seed that replaces the scenario's.
        yes: Run even if the estimate is more than 10 h on one core, 4 GB of memory or 20 GB of logs.
        metrics: The metrics in the table; if omitted, all of them.
        replicas: Number of runs per point, in sequence, which differ only in their noise.

    Raises:
        ScenarioError: There is no such key, it does not accept the first or the last value, or a value is not
            finite. Any other value that is not accepted becomes a row with an `error`.

    >>> import flexsc
    >>> scenario = flexsc.Scenario.example("relay-fixed").with_("duration", 600.0)
    >>> flexsc.sweep(scenario, "law.relay.k_t", [0.30, 0.31, 0.32])["switchings"].tolist()
    [82.0, 81.0, 81.0]
    """
    import numpy as np

    if isinstance(key, str) == (values is None):
        raise ValueError("values must be given with a single key, and with no mapping of keys")
    grids = []
    for name, of_key in {key: values}.items() if isinstance(key, str) else key.items():
        numbers = np.asarray(of_key, dtype=np.float64)
        if numbers.ndim != 1 or len(numbers) == 0:
            raise ValueError(f"values must be of shape (runs,) and not empty, got {numbers.shape}")
        grids.append((name, numbers.tolist()))
    if not grids:
        raise ValueError("a sweep needs a key")
    if index(replicas) < 1:
        raise ValueError(f"replicas must be at least 1, got {replicas}")
    if seed is not None:
        scenario = scenario.with_("seed", seed)
    runs = replicas * prod(len(numbers) for _, numbers in grids)
    if jobs is None and scenario.parts:
        jobs = 1
    names = None if metrics is None else list(metrics)
    work = engine.Work.of(scenario._native, (0, runs), grids, "random", replicas, names, None, yes)
    return _made(work, jobs)


def read_campaign(path: str | os.PathLike[str]) -> Table:
    """Read the directory of a campaign, as written by `flexsc simulate --runs`, `flexsc sweep` and
    `campaign`.

    Columns are read at the first access. A campaign that is running or was stopped has the rows of its
    complete parts. `path` may be a location that `fsspec` supports.

    Raises:
        ValueError: It is not the directory of a campaign, or contains other files.
        OSError: It cannot be read.

    >>> import flexsc, tempfile
    >>> scenario = flexsc.Scenario.example("relay-sampled").with_("duration", 600.0)
    >>> with tempfile.TemporaryDirectory() as out:
    ...     made = flexsc.campaign(scenario, runs=4, out=out)
    ...     same = flexsc.read_campaign(out)["switchings"] == made["switchings"]
    >>> same.tolist()
    [True, True, True, True]
    """
    from flexsc._executor import place

    return place(path).table()


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


def _made(work: engine.Work, jobs: int | None) -> Table:
    columns, summaries = work.make(work.runs, _threads(jobs))
    return Table(work, columns.__getitem__, lambda: summaries)


def _threads(jobs: int | None) -> int:
    jobs = 0 if jobs is None else index(jobs)
    if not (jobs == 0 or 1 <= jobs <= 1024):
        raise ValueError(f"jobs must be from 1 to 1024, got {jobs}")
    return jobs


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
