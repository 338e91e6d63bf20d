"""Campaigns and sweeps: many runs of one scenario, as a table."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from operator import index
from typing import TYPE_CHECKING, Any, NamedTuple

from flexsc import _native as engine
from flexsc._analysis import analysis
from flexsc._design import Noise, Points, Sample, design
from flexsc._missing import reading
from flexsc._named import no_such
from flexsc._numpy import npt
from flexsc._progress import Progress, callback
from flexsc._result import Detail
from flexsc._scenario import Scenario
from flexsc._table import Table
from flexsc._threads import threads as threads_of
from flexsc._values import checked, run_number

if TYPE_CHECKING:
    from concurrent.futures import Executor


def campaign(
    scenario: Scenario,
    runs: int | range = 1000,
    jobs: int | None = None,
    seed: int | None = None,
    yes: bool = False,
    *,
    metrics: str | Sequence[str] | None = None,
    sample: Sample = "random",
    replicas: int = 1,
    out: str | os.PathLike[str] | None = None,
    log: Detail = "none",
    executor: Executor | None = None,
    task_s: float = 1.0,
    force: bool = False,
    progress: Progress = None,
    at: npt.ArrayLike | None = None,
    topics: str | Sequence[str] | None = None,
) -> Table:
    """Simulate many runs of a scenario, with new noise and newly drawn `[uncertain]` keys for each.

    A run does not depend on the other runs of the call: partial campaigns such as `range(500, 1000)` add up
    to the whole. It does not depend on threads, processes or machines either.

    Args:
        scenario: The scenario from which the runs are drawn.
        runs: The number of runs, or their range (of step 1).
        jobs: Number of threads, at most 1024; 0 for one per core. If omitted, one per core, or one in each
            task of an executor.
            Parts written in Python run one at a time on any number of threads: with them the default is one.
        seed: Seed that replaces the scenario's.
        yes: Run even if the estimate is more than 10 h on one core, 4 GB of memory or 20 GB of logs.
        metrics: The metrics in the table; if omitted, all of them.
        sample: The method by which the `[uncertain]` keys are drawn: `random`, `latin-hypercube` or `sobol`.
            A Latin hypercube has as many points as runs of these end with; `("latin-hypercube", 1000)` gives
            their number, so that `range(0, 500)` is a part of it.
        replicas: Number of runs per drawn point, which differ only in their noise.
        out: The directory for the rows, as Parquet files; it is created if missing. The same call continues a
            stopped campaign, more runs extend it, and a range of runs adds to those that are there. A path
            that ends in `.csv` or `.parquet` is one file for the rows, written at the end. A location that
            `fsspec` supports, such as `s3://bucket/study`, is accepted for both.
        log: The detail of a log of each run, `NAME-RUN.mcap` in the directory `out`: `events`, `full` or
            `scene`, as in `Scenario.simulate`. Runs with logs are simulated one by one, and not in batches.
        executor: The executor of the runs, such as a `concurrent.futures.ProcessPoolExecutor`, or Dask's
            through `flexsc.dask.campaign`. Workers write their rows to `out`, which all of them must be able
            to reach; without `out` the rows return through this process. Parts written in Python travel with
            the tasks, if they can be pickled.
        task_s: Approximate duration of a task of the executor (s).
        force: Replace another campaign in `out`, one with more runs, a file, and logs of other runs.
        progress: True to print a line with the finished runs and the remaining time to standard error, False
            for none, or a function that is called after each task with the number of finished runs and the
            total number; if omitted, a line on a terminal for work of more than a minute on one core.
        at: Times (s), of shape (times,) and in any order, at which the exact motion of each run is kept, as
            `Table.samples`, in the same run. It stays in memory: without `out`, `executor` and `progress`.
        topics: The topics of the motion that are kept, such as `["pointing"]`; if omitted, all.

    Raises:
        ScenarioError: The scenario does not allow this variation.
        SimulationError: All runs failed. If only some of them fail, each is a row with an `error`.
        ValueError: There are more than 100 000 000 runs, `yes` is needed, `out` contains another campaign,
            more runs of this one or a log of another run, or is a file that exists, `log` has no directory,
            parts written in Python cannot be pickled, or the motion at `at` has more than 200 000 000 values.
        KeyError: The scenario has no topic of `topics`.
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
    span = _span(numbers, None)
    checked(scenario)
    replicas = _replicas(replicas)
    method, points = sample if isinstance(sample, tuple) else (sample, -(-span[1] // replicas))
    drawn = engine.Design()
    drawn.draw(method, index(points))
    drawn.repeat(replicas)
    part = isinstance(runs, range)
    return _Study(scenario, span, drawn, metrics, seed, yes, True, log, part).table(
        jobs, out, executor, task_s, force, progress, at, topics
    )


def sweep(
    scenario: Scenario,
    key: str | Mapping[str, Sequence[Any] | npt.NDArray[Any]] | None = None,
    values: Sequence[Any] | npt.NDArray[Any] | None = None,
    jobs: int | None = None,
    seed: int | None = None,
    yes: bool = False,
    *,
    points: Points | None = None,
    sample: Sample | None = None,
    metrics: str | Sequence[str] | None = None,
    replicas: int = 1,
    uncertain: bool = False,
    noise: Noise | None = None,
    runs: range | None = None,
    out: str | os.PathLike[str] | None = None,
    log: Detail = "none",
    executor: Executor | None = None,
    task_s: float = 1.0,
    force: bool = False,
    progress: Progress = None,
) -> Table:
    """Simulate a scenario once per value of a key, per combination of values of several keys, or per point
    of a table or a sample.

    For one key, run i has value i. For several keys, the value of the last key changes fastest:
    `table[metric].reshape(len(first), len(second))` is a map. The rows are those of `flexsc sweep` with the
    same points.

    Args:
        scenario: The scenario to vary.
        key: The key, such as `law.relay.k_t`, or a mapping from each key to its values.
        values: The values of a single key, such as `numpy.linspace(0.28, 0.40, 25)`: numbers, words,
            booleans, or whatever else the key accepts. Of an array of shape (runs, n) each row is a value.
        jobs: Number of threads, at most 1024; 0, or if omitted, one per core.
        seed: Seed that replaces the scenario's.
        yes: Run even if the estimate is more than 10 h on one core, 4 GB of memory or 20 GB of logs.
        points: Points that set several keys together: a mapping from each key to a column of values, a
            sequence of mappings, a data frame of pandas or Polars, a `Table`, whose varied keys count, or the
            path of a CSV file of numbers.
            With `key` too, each point is combined with its values.
        sample: A method with a number of points, such as `("sobol", 1024)`, `("latin-hypercube", 1000)` or
            `("random", 1000)`: a tuple `(low, high)` as values is then a range, and the points are spread
            over the ranges of all such keys together. With `uncertain`, the method draws the `[uncertain]`
            keys.
        metrics: The metrics in the table; if omitted, all that the scenario itself has.
        replicas: Number of runs per point, in sequence, which differ only in their noise.
        uncertain: Draw the `[uncertain]` keys too, anew for each point; otherwise they keep their values.
        noise: The noise of the points: `same`, that of run 0 at all of them (replica i has that of run i), so
            that they differ by their keys alone, or `new`; if omitted, `same`, and `new` with drawn keys.
        runs: A part of the runs, such as `range(500, 1000)`; if omitted, all of them.
        out: The directory or the file for the rows, as in `campaign`. The same call continues a stopped
            sweep.
        log: The detail of a log of each run in the directory `out`, as in `campaign`.
        executor: The executor of the runs, as in `campaign`.
        task_s: Approximate duration of a task of the executor (s).
        force: Replace another campaign in `out`, and logs of other runs.
        progress: True, or a function that is called after each task, as in `campaign`.

    Raises:
        ScenarioError: There is no such key, it does not accept the first or the last value, or a value of a
            table is not finite. Any other value that is not accepted becomes a row with an `error`.
        SimulationError: All runs failed. If only some of them fail, each is a row with an `error`.
        ValueError: The points do not have equally many values of each key, or there are none.

    >>> import flexsc
    >>> scenario = flexsc.Scenario.example("relay-fixed").with_("duration", 600.0)
    >>> flexsc.sweep(scenario, "law.relay.k_t", [0.30, 0.31, 0.32])["switchings"].tolist()
    [82.0, 81.0, 81.0]

    Points that set two keys together, and a sample of a range of each:

    >>> pairs = {"law.relay.k_t": [0.30, 0.32], "body.planar.angle": [0.0, 1e-4]}
    >>> flexsc.sweep(scenario, points=pairs)["law.relay.k_t"].tolist()
    [0.3, 0.32]
    >>> ranges = {"law.relay.k_t": (0.28, 0.40), "body.planar.angle": (0.0, 1e-3)}
    >>> table = flexsc.sweep(scenario, ranges, sample=("sobol", 8))
    >>> table.rows, bool((table["law.relay.k_t"] < 0.34).sum() == 4)
    (8, True)
    """
    checked(scenario)
    if key is None and points is None:
        raise ValueError("a sweep needs a key")
    if (key is None or not isinstance(key, str)) != (values is None):
        raise ValueError("values must be given with a single key, and with no mapping of keys")
    varied = {} if key is None else {key: values} if isinstance(key, str) else key
    if points is None and not varied:
        raise ValueError("a sweep needs a key")
    if isinstance(points, (str, os.PathLike)) and out is not None and _is_same_file(points, out):
        raise ValueError(f"out: {os.fspath(out)} is the table of the points, which would be lost")
    draws = uncertain and bool(scenario.to_dict().get("uncertain"))
    made = design(scenario.name, varied, points, sample, _replicas(replicas), draws, noise)
    span = _span(runs, made.runs)
    part = runs is not None
    return _Study(scenario, span, made, metrics, seed, yes, uncertain, log, part).table(
        jobs, out, executor, task_s, force, progress
    )


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
    design: engine.Design
    metrics: str | Sequence[str] | None
    seed: int | None
    yes: bool
    draws: bool
    log: Detail
    # Whether the runs are a part of those of the directory.
    part: bool

    def table(
        self,
        jobs: int | None,
        out: str | os.PathLike[str] | None,
        executor: Executor | None,
        task_s: float,
        force: bool,
        progress: Progress,
        at: npt.ArrayLike | None = None,
        topics: str | Sequence[str] | None = None,
    ) -> Table:
        """Simulate the runs: on threads here, on an executor, or into a directory."""
        if not task_s > 0.0:
            raise ValueError(f"task_s must be a positive number, got {task_s}")
        if self.log != "none":
            _check_place(out)
        scenario = self.scenario if self.seed is None else self.scenario.with_("seed", self.seed)
        names = [self.metrics] if isinstance(self.metrics, str) else self.metrics
        names = None if names is None else list(names)
        work = engine.Work.create(
            scenario._native,
            self.span,
            self.design,
            names,
            None if executor is None else task_s,
            self.yes,
            self.draws,
            self.log,
        )
        # A task of an executor has one thread unless it is to have more.
        threads = threads_of(1 if jobs is None and executor is not None else jobs, scenario)
        if at is not None:
            if not (out is None and executor is None and not progress):
                raise ValueError("at keeps the motion in memory: leave out `out`, `executor` and `progress`")
            return _sampled(scenario, work, threads, at, topics)
        if topics is not None:
            raise ValueError("topics needs `at`, the times at which they are kept")

        def seconds() -> float:
            runs = self.span[1] - self.span[0]
            found: float = analysis("estimate", scenario, runs=runs, log=self.log)["seconds"]
            return found

        if progress is None and executor is None and scenario.own_parts:
            # No directory can hold these parts: their runs are made in one call, which has no progress.
            progress = False
        report = callback(progress, seconds)
        if out is None and executor is None and report is None:
            columns, summaries = work.make(work.runs, threads)
            return _checked(Table(work, columns.__getitem__, lambda: summaries))
        if executor is not None and out is None and scenario.own_parts:
            from flexsc import _own_parts_campaign

            study = (self.span, self.design.text, names, self.draws)
            return _checked(_own_parts_campaign.run(scenario, study, work, executor, threads, task_s, report))
        from flexsc._executor import run

        return _checked(run(work, out, executor, threads, task_s, force, report, self.log, self.part))


def _sampled(
    scenario: Scenario,
    work: engine.Work,
    threads: int,
    at: npt.ArrayLike,
    topics: str | Sequence[str] | None,
) -> Table:
    """Simulate runs on threads here, with their motion at some times."""
    from flexsc._ensemble import Ensemble
    from flexsc._sample_times import SampleTimes

    if "duration" in scenario.to_dict().get("uncertain", {}):
        raise ValueError("at needs runs of the same duration, and `uncertain` draws it for each run")
    times = SampleTimes(at, scenario.duration)
    chosen = [topics] if isinstance(topics, str) else topics
    names = None if chosen is None else [name.removeprefix("/") for name in chosen]
    sizes = work.sample_sizes()
    for name in names or ():
        if sizes and name not in sizes:
            raise no_such("no topic", name, sizes)
    first, end = work.runs
    # A run has all topics while it is simulated.
    times.check_size(sizes, min(end - first, threads or os.cpu_count() or 1))
    kept = sizes if names is None else {name: sizes.get(name, 0) for name in names}
    times.check_size(kept, end - first)
    columns, summaries, seen = work.make_at(work.runs, threads, times.grown, names)
    for name in names or ():
        if seen and name not in seen[0][1]:
            raise no_such("no topic", name, seen[0][1])
    table = _checked(Table(work, columns.__getitem__, lambda: summaries))
    table.samples = Ensemble(scenario, table["run"], times, seen)
    return table


def _is_same_file(one: str | os.PathLike[str], other: str | os.PathLike[str]) -> bool:
    return os.path.exists(one) and os.path.exists(other) and os.path.samefile(one, other)


def _checked(table: Table) -> Table:
    """Return a table unless all of its runs failed."""
    errors = table["error"]
    if all(errors):
        name, count = table.scenario.name, len(errors)
        raise engine.SimulationError(
            f"{name}: {count} of {count} runs failed; run {table['run'][0]}: {errors[0]}"
        )
    return table


def _check_place(out: str | os.PathLike[str] | None) -> None:
    """Refuse logs of runs without a directory."""
    if out is None:
        raise ValueError("log needs `out`, the directory of the logs")
    if "://" in os.fspath(out):
        raise ValueError(f"log needs a directory that every worker reaches by its path, not {out}")


def _span(runs: range | None, count: int | None) -> tuple[int, int]:
    """Return the first run and the one after the last, of at most `count` runs."""
    if runs is None:
        return 0, count or 0
    if not isinstance(runs, range) or runs.step != 1 or not runs:
        raise ValueError(f"runs must be a number of runs, or a non-empty range of step 1, got {runs!r}")
    if count is not None and runs.stop > count:
        raise ValueError(f"runs must be within the {count} runs of the sweep, got {runs!r}")
    return run_number(runs.start), run_number(runs.stop)


def _replicas(replicas: int) -> int:
    """Check the number of runs of each point."""
    if index(replicas) < 1:
        raise ValueError(f"replicas must be at least 1, got {replicas}")
    return index(replicas)


def _whole(name: str, number: object) -> int:
    """Check an integer; a float with the value of one is named as such."""
    try:
        return index(number)  # type: ignore[arg-type]
    except TypeError:
        raise TypeError(f"{name} must be an integer or a range, got {number!r}") from None
