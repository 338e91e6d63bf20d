"""Campaigns and sweeps: many runs of one scenario as a table."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from math import prod
from operator import index
from typing import TYPE_CHECKING, Any, Literal

from flexsc import _arrow, _units
from flexsc import _native as engine
from flexsc._scenario import Scenario, run_number
from flexsc._values import objects

if TYPE_CHECKING:
    from concurrent.futures import Executor

    import numpy.typing as npt

Sample = Literal["random", "latin-hypercube", "sobol"]
"""How the `[uncertain]` keys are drawn."""


class Table:
    """The results of a campaign: a row for each run.

    >>> import flexsc
    >>> scenario = flexsc.Scenario.example("relay-sampled").with_("duration", 100.0)
    >>> table = flexsc.campaign(scenario, runs=4)
    >>> table["run"].tolist(), table.unit("cycle_period_s")
    ([0, 1, 2, 3], 's')
    """

    scenario: Scenario
    """What the runs were drawn from."""
    keys: list[str]
    """The keys of the scenario that vary."""

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
        """Columns by name, of shape (runs,): `run`, `seed`, the keys that vary, the metrics, `error`.

        Metrics are float64 with NaN where there is none, words str, lists an array of arrays. `error` is
        why a run failed, else empty. `pandas.DataFrame(table.columns)` takes them as they are. Those of a
        directory are read when they are first asked for.
        """
        return {name: self[name] for name in self._names}

    def __len__(self) -> int:
        return len(self["run"])

    def __getitem__(self, column: str) -> npt.NDArray[Any]:
        """A column, of shape (runs,)."""
        if column not in self._names:
            raise KeyError(f"no column {column!r}; there are {', '.join(self._names)}")
        if column not in self._columns:
            self._columns[column] = _array(column in ("run", "seed", *self.keys), self._read(column))
        return self._columns[column]

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def statistics(self) -> dict[str, dict[str, Any]]:
        """Statistics of each numeric metric over the runs that have a value of it.

        By metric: its `unit`, the number of those `runs`, their `mean`, their standard deviation `sd` (with
        runs - 1; NaN for a single run), and `quantiles`, a dictionary from 0.05, 0.25, 0.5, 0.75 and 0.95.
        """
        if self._statistics is None:
            names = ("unit", "runs", "mean", "sd")
            self._statistics = {
                name: {**dict(zip(names, numbers, strict=True)), "quantiles": dict(quantiles)}
                for name, *numbers, quantiles in self._summaries()
            }
        return self._statistics

    def unit(self, column: str) -> str:
        """The unit of a metric; empty for a count, a ratio, a word, and for keys, whose own text tells it.

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
        """Its rows, as Arrow's PyCapsule interface has them: null where a run has no value."""
        return _arrow.stream(self.columns.items(), self._told(), {"scenario": self.scenario.name})

    def __arrow_c_schema__(self) -> object:
        """The schema of its rows, as Arrow's PyCapsule interface has it."""
        return _arrow.schema(self.columns.items(), self._told(), {"scenario": self.scenario.name})

    def _figures(self, kind: str | None, metrics: Sequence[str]) -> list[tuple[str, engine.Figure]]:
        """The engine's figures of the table, each after its name, as `flexsc.plot` draws them."""
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
        return _html.heading(self.scenario.name, f"{len(self)} runs") + figure + statistics

    def __repr__(self) -> str:
        return f"<flexsc.Table of {self.scenario.name}: {len(self)} runs>"


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
    """Simulate many runs of a scenario: its `[uncertain]` keys and its noise drawn anew for each.

    A run does not depend on the other runs of the call: parts such as `range(500, 1000)` make up a whole. Nor
    does it depend on threads, processes or machines.

    Args:
        scenario: What the runs are drawn from.
        runs: Their number, or their range (of step 1).
        jobs: Threads, at most 1024; left out, one for each core, and in each task of an executor one. Parts
            written in Python run one at a time, whatever their threads: with them one is the default.
        seed: Seed, instead of the scenario's.
        yes: Run even if the estimate is more than 10 h on one core, 4 GB of memory or 20 GB of logs.
        metrics: The metrics that the table has; left out, all of them.
        sample: How the `[uncertain]` keys are drawn.
        replicas: Runs of each point that is drawn, which differ in their noise only.
        out: The directory that keeps the rows as Parquet files, made if missing, or a place that `fsspec`
            knows, such as `s3://bucket/study`. The same call goes on where a stopped one ended.
        executor: Where the runs are made, such as a `concurrent.futures.ProcessPoolExecutor`, or
            Dask's through `flexsc.dask.campaign`. Workers write their rows to `out`, which they all must
            reach; without `out` rows come back through this process.
        task_s: About how long a task of the executor takes (s).
        force: Replace another campaign in `out`.
        progress: Called with the number of runs that are done and that of all, after each task.

    Raises:
        ScenarioError: The scenario cannot vary so. A single run that fails is a row with an `error`.
        ValueError: There are more than 100 000 000 runs, `yes` is needed, or `out` holds another campaign.
        OSError: `out` cannot be written, or another process is at work there.

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
        raise ValueError(
            f"runs must be a number of runs, or a range of step 1 with a run in it, got {runs!r}"
        )
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
    """Simulate a scenario once for each value of a key, or each combination of the values of several.

    Over one key run i has value i. Over several the last key's values go from run to run:
    `table[metric].reshape(len(first), len(second))` is a map.

    Args:
        scenario: What is varied.
        key: The key, such as `law.relay.k_t`, or the values of each key by its name.
        values: The values of a single key, of shape (runs,), such as `numpy.linspace(0.28, 0.40, 25)`.
        jobs: Threads, at most 1024; left out, one for each core.
        seed: Seed, instead of the scenario's.
        yes: Run even if the estimate is more than 10 h on one core, 4 GB of memory or 20 GB of logs.
        metrics: The metrics that the table has; left out, all of them.
        replicas: Runs of each point, one after another, which differ in their noise only.

    Raises:
        ScenarioError: There is no such key, it does not accept the first or the last value, or a value is not
            finite. Any other value that is not accepted is a row with an `error`.

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
            raise ValueError(f"values must be of shape (runs,) with a value in it, got {numbers.shape}")
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
    """Read the directory of a campaign, as `flexsc simulate --runs`, `flexsc sweep` and `campaign` write it.

    Columns are read when they are first asked for. A campaign that is still at work, or was stopped, has the
    rows of the parts that are whole. `path` may be a place that `fsspec` knows.

    Raises:
        ValueError: It is no directory of a campaign, or holds what is none of it.
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


def of_directory(directory: engine.Directory, kept: object = None) -> Table:
    """Make the table of a directory. `kept` lives as long as the table."""
    table = Table(directory.work, directory.column, directory.statistics)
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
    """Give a column its final form: metrics that count are float64, too, as some runs may have none."""
    import numpy as np

    if isinstance(column, list):
        if column and not isinstance(column[0], str):
            return objects(column)
        return np.array(column, dtype=np.str_)
    array: npt.NDArray[Any] = column
    return array if is_given or array.dtype != np.int64 else array.astype(np.float64)
