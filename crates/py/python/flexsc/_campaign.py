"""Campaigns and sweeps: many runs of one scenario as a table."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from math import prod
from operator import index
from typing import TYPE_CHECKING, Any

from flexsc import _native as engine
from flexsc._scenario import Scenario, run_number
from flexsc._values import objects

if TYPE_CHECKING:
    import numpy.typing as npt


class Table:
    """The results of a campaign: a row for each run."""

    scenario: Scenario
    """What the runs were drawn from."""
    keys: list[str]
    """The keys of the scenario that vary."""
    columns: dict[str, npt.NDArray[Any]]
    """Columns by name, of shape (runs,): `run`, the keys that vary, the metrics, `error`.

    Metrics are float64 with NaN where there is none, words str, lists an array of arrays. `error` is why a
    run failed, else empty. `pandas.DataFrame(table.columns)` takes them as they are.
    """

    def __init__(
        self,
        scenario: Scenario,
        keys: list[str],
        columns: dict[str, npt.NDArray[Any]],
        statistics: dict[str, dict[str, Any]],
    ) -> None:
        self.scenario = scenario
        self.keys = keys
        self.columns = columns
        self._statistics = statistics

    def __len__(self) -> int:
        return len(self.columns["run"])

    def __getitem__(self, column: str) -> npt.NDArray[Any]:
        """A column, of shape (runs,)."""
        if column not in self.columns:
            raise KeyError(f"no column {column!r}; there are {', '.join(self.columns)}")
        return self.columns[column]

    def __iter__(self) -> Iterator[str]:
        return iter(self.columns)

    def statistics(self) -> dict[str, dict[str, Any]]:
        """Statistics of each numeric metric over the runs that have a value of it.

        By metric: its `unit`, the number of those `runs`, their `mean`, their standard deviation `sd` (with
        runs - 1; NaN for a single run), and `quantiles`, a dictionary from 0.05, 0.25, 0.5, 0.75 and 0.95.
        """
        return self._statistics

    def __repr__(self) -> str:
        return f"<flexsc.Table of {self.scenario.name}: {len(self)} runs>"


def campaign(
    scenario: Scenario,
    runs: int | range = 1000,
    jobs: int | None = None,
    seed: int | None = None,
    yes: bool = False,
) -> Table:
    """Simulate many runs of a scenario: its `[uncertain]` keys and its noise drawn anew for each.

    A run does not depend on the other runs of the call: parts such as `range(500, 1000)` make up a whole.

    Args:
        scenario: What the runs are drawn from.
        runs: Their number, or their range (of step 1).
        jobs: Threads, at most 1024; left out, one for each core.
        seed: Seed, instead of the scenario's.
        yes: Run even if the estimate is more than 10 h on one core, 4 GB of memory or 20 GB of logs.

    Raises:
        ScenarioError: The scenario cannot vary so. A single run that fails is a row with an `error`.
        ValueError: There are more than 100 000 000 runs, or `yes` is needed.
    """
    numbers = runs if isinstance(runs, range) else range(index(runs))
    if numbers.step != 1 or not numbers:
        raise ValueError(
            f"runs must be a number of runs, or a range of step 1 with a run in it, got {runs!r}"
        )
    return _campaign(scenario, numbers, jobs, seed, [], yes)


def sweep(
    scenario: Scenario,
    key: str | Mapping[str, Sequence[float] | npt.NDArray[Any]],
    values: Sequence[float] | npt.NDArray[Any] | None = None,
    jobs: int | None = None,
    seed: int | None = None,
    yes: bool = False,
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

    Raises:
        ScenarioError: There is no such key, or it does not accept the first or the last value. Any other
            value that is not accepted is a row with an `error`.
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
    return _campaign(scenario, range(prod(len(numbers) for _, numbers in grids)), jobs, seed, grids, yes)


def read_campaign(directory: str | os.PathLike[str]) -> Table:
    """The rows of a campaign's directory that are there, as `flexsc simulate --runs N -o DIR` leaves it.

    Raises:
        ValueError: It is no campaign, or has a part of another one.
        OSError: It cannot be read.
    """
    import numpy as np

    native, keys, told, summaries = engine.read_campaign(os.fspath(directory))
    columns: dict[str, npt.NDArray[Any]] = {}
    for name, cells in told.items():
        if isinstance(cells, np.ndarray):
            columns[name] = cells
        elif cells and isinstance(cells[0], np.ndarray):
            columns[name] = objects(cells)
        else:
            columns[name] = np.array(cells, dtype=np.str_)
    return Table(Scenario._of(native), keys, columns, _statistics(summaries))


def _statistics(summaries: list[Any]) -> dict[str, dict[str, Any]]:
    names = ("unit", "runs", "mean", "sd")
    return {
        name: {**dict(zip(names, numbers, strict=True)), "quantiles": dict(quantiles)}
        for name, *numbers, quantiles in summaries
    }


def _campaign(
    scenario: Scenario,
    runs: range,
    jobs: int | None,
    seed: int | None,
    grids: list[tuple[str, list[float]]],
    yes: bool,
) -> Table:
    import numpy as np

    jobs = 0 if jobs is None else index(jobs)
    if not (jobs == 0 or 1 <= jobs <= 1024):
        raise ValueError(f"jobs must be from 1 to 1024, got {jobs}")
    if seed is not None:
        scenario = scenario.with_("seed", seed)
    span = (run_number(runs.start), run_number(runs.stop))
    keys, told, summaries = engine.campaign(scenario._native, span, jobs, grids, yes)
    columns = {"run": np.array([run for run, *_ in told], dtype=np.int64)}
    for place, key in enumerate(keys):
        columns[key] = np.array([drawn[place] for _, drawn, *_ in told])
    first: dict[str, Any] = next((metrics for *_, metrics, _ in told if metrics), {})
    for name, kind in first.items():
        of_runs = [metrics and metrics[name] for *_, metrics, _ in told]
        if isinstance(kind, str):
            columns[name] = np.array([word or "" for word in of_runs], dtype=np.str_)
        elif isinstance(kind, np.ndarray):
            columns[name] = objects([np.empty(0) if numbers is None else numbers for numbers in of_runs])
        else:
            columns[name] = np.array(of_runs, dtype=np.float64)
    columns["error"] = np.array([error for *_, error in told], dtype=np.str_)
    return Table(scenario, keys, columns, _statistics(summaries))
