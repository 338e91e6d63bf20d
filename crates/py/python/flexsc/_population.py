"""Metrics of a population of points, for optimisers that evaluate many at once."""

from __future__ import annotations

from collections.abc import Sequence
from math import nan

from flexsc import _native as engine
from flexsc._keys import is_known
from flexsc._numpy import np, npt
from flexsc._scenario import Scenario
from flexsc._threads import threads
from flexsc._values import checked, run_number


def evaluate(
    scenario: Scenario,
    keys: Sequence[str],
    population: npt.ArrayLike,
    metrics: str | Sequence[str],
    *,
    run: int = 0,
    missing: float = nan,
    jobs: int | None = None,
    yes: bool = False,
) -> npt.NDArray[np.float64]:
    """Return metrics of a scenario at each point of a population, simulated in parallel.

    This is the objective of optimisers that evaluate a population at once. Point i has the value of
    `scenario.with_(dict(zip(keys, population[i]))).simulate(run).metrics[...]`: all points have the same
    noise, and a value does not depend on the other points. No file is written.

    Args:
        scenario: The scenario to vary. Its `[uncertain]` keys keep their values.
        keys: The keys that vary, such as `["law.relay.k_t", "body.planar.angle"]`.
        population: The points, of shape (points, keys); all finite. The value of a key that holds an integer
            is rounded.
        metrics: The name of a metric, or several names. A goal counts 1 if it is met and 0 if it is missed.
        run: Number of the run, which selects the noise.
        missing: The value of a metric at a point where it has none, or that the scenario does not accept, or
            whose run fails: NaN, or `math.inf` for an optimiser that minimises.
        jobs: Number of threads, at most 1024; 0, or if omitted, one per core. With parts written in Python,
            which run one at a time, the default is one.
        yes: Run even if the estimate is more than 10 h on one core or 4 GB of memory.

    Returns:
        The metrics, of shape (points,) for one name and (points, metrics) for several.

    Raises:
        ScenarioError: There is no such key.
        ValueError: There is no such metric, it is no number, the population has another shape or a value that
            is not finite, or `yes` is needed.

    >>> import flexsc, numpy
    >>> scenario = flexsc.Scenario.example("relay-fixed").with_("duration", 600.0)
    >>> keys, population = ["law.relay.k_t"], numpy.array([[0.30], [0.32], [7.0]])
    >>> flexsc.evaluate(scenario, keys, population, "switchings").tolist()
    [82.0, 81.0, nan]
    >>> flexsc.evaluate(scenario, keys, population, ["switchings", "duty"], missing=numpy.inf).shape
    (3, 2)
    """
    checked(scenario)
    names = [metrics] if isinstance(metrics, str) else list(metrics)
    if isinstance(keys, str) or not keys:
        raise ValueError(f"keys must be a sequence of at least one key, got {keys!r}")
    points = np.ascontiguousarray(population, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != len(keys):
        raise ValueError(f"population must be of shape (points, {len(keys)}), got {points.shape}")
    if not len(points):
        return np.empty((0,) if isinstance(metrics, str) else (0, len(names)))
    design = engine.Design()
    design.add_table(list(keys), points)
    design.share_noise(run_number(run))
    work = engine.Work.for_points(scenario._native, design, names, yes)
    values, error = work.numbers(work.runs, threads(jobs, scenario), names)
    if error is not None and np.isnan(values).all() and not all(is_known(scenario, key) for key in keys):
        # The error of a key for which no value would be accepted.
        scenario.with_(dict(zip(keys, points[0].tolist(), strict=True)))
    values[np.isnan(values)] = missing
    return values[:, 0] if isinstance(metrics, str) else values
