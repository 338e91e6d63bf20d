"""Campaigns of scenarios with parts written in Python, on executors: the objects travel with the tasks."""

from __future__ import annotations

import pickle
import time
from collections.abc import Callable, Sequence
from concurrent.futures import Executor, ThreadPoolExecutor
from typing import Any

from flexsc import _native as engine
from flexsc._executor import Span, distribute
from flexsc._numpy import np
from flexsc._scenario import Scenario
from flexsc._table import Table
from flexsc.parts import CompiledLaw

# The runs of a campaign: their range, the text of the design, the metrics, and whether uncertain keys are
# drawn.
Study = tuple[Span, str, list[str] | None, bool]


def run(
    scenario: Scenario,
    study: Study,
    work: engine.Work,
    executor: Executor,
    jobs: int,
    task_s: float,
    progress: Callable[[int, int], None] | None,
) -> Table:
    """Simulate the runs as tasks, and return their table."""
    _check(scenario, executor)
    first, end = study[0]
    # Small parts, of which tasks take several: what a run takes is not known.
    size = max(1, min(64, (end - first) // 64))
    parts = [(start, min(start + size, end)) for start in range(first, end, size)]
    rows: dict[Span, dict[str, Any]] = {}
    finished = 0

    def keep(results: list[tuple[Span, dict[str, Any]]]) -> None:
        rows.update(results)

    def done(made: Sequence[Span]) -> None:
        nonlocal finished
        finished += sum(stop - start for start, stop in made)
        if progress is not None:
            progress(finished, end - first)

    distribute(executor, parts, task_s, done, lambda some: (_rows, scenario, study, some, jobs), keep)
    columns = {name: _joined([rows[part][name] for part in parts]) for name in rows[parts[0]]}

    def statistics() -> Any:
        numbers = {
            name: values
            for name, values in columns.items()
            if isinstance(values, list) or getattr(values, "dtype", None) in ("float64", "int64")
        }
        return engine.campaign_statistics(work, numbers, end - first)

    return Table(work, columns.__getitem__, statistics)


def _check(scenario: Scenario, executor: Executor) -> None:
    """Refuse parts that no other process can have."""
    if isinstance(executor, ThreadPoolExecutor):
        return
    for role, part in scenario.own_parts.items():
        if isinstance(part, CompiledLaw):
            why = "is a function at an address of this process"
            raise ValueError(f"{scenario.name}: the {role} {why}, which no worker has: leave out `executor`")
    # Dask sends what pickle does not take, such as classes of a notebook.
    of_dask = getattr(executor, "_client", None) is not None
    try:
        (_cloudpickle() if of_dask else pickle).dumps(scenario)
    except Exception as error:
        why = f"cannot be sent to the workers of the executor: {error}"
        raise ValueError(f"{scenario.name}: its parts in Python {why}") from error


def _cloudpickle() -> Any:
    from importlib import import_module

    return import_module("cloudpickle")


def _rows(
    scenario: Scenario, study: Study, parts: Sequence[Span], jobs: int
) -> tuple[float, list[tuple[Span, dict[str, Any]]]]:
    """Simulate parts of a campaign: a worker's task. Return its duration (s) and the columns of each part."""
    began = time.perf_counter()
    runs, text, names, draws = study
    design = engine.Design.parse(text)
    work = engine.Work.create(scenario._native, runs, design, names, None, True, draws, "none")
    results = [(part, work.make(part, jobs)[0]) for part in parts]
    return time.perf_counter() - began, results


def _joined(pieces: list[Any]) -> Any:
    """The pieces of a column in sequence."""
    if isinstance(pieces[0], list):
        return [cell for piece in pieces for cell in piece]
    return np.concatenate(pieces)
