"""Campaigns and sweeps: many runs of one scenario, as a table."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from math import prod
from operator import index
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

from flexsc import _native as engine
from flexsc._missing import reading
from flexsc._progress import Progress, callback
from flexsc._scenario import Scenario
from flexsc._table import Table
from flexsc._values import checked, run_number

if TYPE_CHECKING:
    from concurrent.futures import Executor

    import numpy.typing as npt

Sample = Literal["random", "latin-hypercube", "sobol"]
"""The method by which the `[uncertain]` keys are drawn."""


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
    progress: Progress = None,
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
        progress: True to print a line with the finished runs and the remaining time to standard error, or a
            function that is called after each task with the number of finished runs and the total number.

    Raises:
        ScenarioError: The scenario does not allow this variation.
        SimulationError: All runs failed. If only some of them fail, each is a row with an `error`.
        ValueError: There are more than 100 000 000 runs, `yes` is needed, `out` contains another campaign, or
            parts written in Python cannot be pickled.
        OSError: `out` cannot be written, or another process is using it.

    >>> import flexsc
    >>> scenario = flexsc.Scenario.example("relay-sampled").with_("duration", 600.0)
    >>> table = flexsc.campaign(scenario, runs=8, metrics=["switchings", "duty"])
    >>> table.rows, table["switchings"].shape
    (8, (8,))
    >>> round(table.statistics()["duty"]["mean"], 3)
    0.041
    """
    numbers = runs if isinstance(runs, range) else range(_whole("runs", runs))
    if numbers.step != 1 or not numbers:
        raise ValueError(f"runs must be a number of runs, or a non-empty range of step 1, got {runs!r}")
    if not task_s > 0.0:
        raise ValueError(f"task_s must be a positive number, got {task_s}")
    if index(replicas) < 1:
        raise ValueError(f"replicas must be at least 1, got {replicas}")
    checked(scenario)
    span = (run_number(numbers.start), run_number(numbers.stop))
    study = _Study(scenario, span, [], sample, replicas, metrics, seed, yes, True)
    return study.table(jobs, out, executor, task_s, force, progress)


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
    uncertain: bool = False,
    out: str | os.PathLike[str] | None = None,
    executor: Executor | None = None,
    task_s: float = 1.0,
    force: bool = False,
    progress: Progress = None,
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
        uncertain: Draw the `[uncertain]` keys too, anew for each point; otherwise they keep their values.
        out: The directory for the rows, as in `campaign`. The same call continues a stopped sweep.
        executor: The executor of the runs, as in `campaign`.
        task_s: Approximate duration of a task of the executor (s).
        force: Replace another campaign in `out`.
        progress: True, or a function that is called after each task, as in `campaign`.

    Raises:
        ScenarioError: There is no such key, it does not accept the first or the last value, or a value is not
            finite. Any other value that is not accepted becomes a row with an `error`.
        SimulationError: All runs failed. If only some of them fail, each is a row with an `error`.

    >>> import flexsc
    >>> scenario = flexsc.Scenario.example("relay-fixed").with_("duration", 600.0)
    >>> flexsc.sweep(scenario, "law.relay.k_t", [0.30, 0.31, 0.32])["switchings"].tolist()
    [82.0, 81.0, 81.0]
    """
    import numpy as np

    checked(scenario)
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
    if not task_s > 0.0:
        raise ValueError(f"task_s must be a positive number, got {task_s}")
    runs = replicas * prod(len(numbers) for _, numbers in grids)
    study = _Study(scenario, (0, runs), grids, "random", replicas, metrics, seed, yes, uncertain)
    return study.table(jobs, out, executor, task_s, force, progress)


def read_campaign(path: str | os.PathLike[str]) -> Table:
    """Read the directory of a campaign, as written by `flexsc simulate --runs`, `flexsc sweep` and
    `campaign`.

    Columns are read at the first access. A campaign that is running or was stopped has the rows of its
    complete parts. `path` may be a location that `fsspec` supports.

    Raises:
        FileNotFoundError: There is no such directory. The error is a `ValueError` too.
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
    from flexsc._executor import Local, place

    where = place(path)
    return reading(path, lambda _: where.table()) if isinstance(where, Local) else where.table()


class _Study(NamedTuple):
    """The runs of a campaign or a sweep."""

    scenario: Scenario
    span: tuple[int, int]
    grids: list[tuple[str, list[float]]]
    sample: Sample
    replicas: int
    metrics: Sequence[str] | None
    seed: int | None
    yes: bool
    draws: bool

    def table(
        self,
        jobs: int | None,
        out: str | os.PathLike[str] | None,
        executor: Executor | None,
        task_s: float,
        force: bool,
        progress: Progress,
    ) -> Table:
        """Simulate the runs: on threads here, on an executor, or into a directory."""
        scenario = self.scenario if self.seed is None else self.scenario.with_("seed", self.seed)
        if jobs is None and scenario.parts:
            jobs = 1
        names = None if self.metrics is None else list(self.metrics)
        work = engine.Work.create(
            scenario._native,
            self.span,
            self.grids,
            self.sample,
            self.replicas,
            names,
            None if executor is None else task_s,
            self.yes,
            self.draws,
        )
        threads, report = _threads(jobs), callback(progress)
        if out is None and executor is None and report is None:
            columns, summaries = work.make(work.runs, threads)
            return _checked(Table(work, columns.__getitem__, lambda: summaries))
        if executor is not None and out is None and scenario.parts:
            from flexsc import _own_parts

            study = (self.span, self.grids, self.sample, self.replicas, names, self.draws)
            return _checked(_own_parts.run(scenario, study, work, executor, threads, task_s, report))
        from flexsc._executor import run

        return _checked(run(work, out, executor, threads, task_s, force, report))


def _checked(table: Table) -> Table:
    """Return a table unless all of its runs failed."""
    errors = table["error"]
    if all(errors):
        name, count = table.scenario.name, len(errors)
        raise engine.SimulationError(
            f"{name}: {count} of {count} runs failed; run {table['run'][0]}: {errors[0]}"
        )
    return table


def _whole(name: str, number: object) -> int:
    """Check an integer; a float with the value of one is named as such."""
    try:
        return index(number)  # type: ignore[arg-type]
    except TypeError:
        raise TypeError(f"{name} must be an integer or a range, got {number!r}") from None


def _threads(jobs: int | None) -> int:
    jobs = 0 if jobs is None else index(jobs)
    if not (jobs == 0 or 1 <= jobs <= 1024):
        raise ValueError(f"jobs must be from 1 to 1024, got {jobs}")
    return jobs
