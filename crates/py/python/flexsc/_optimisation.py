"""Minima of metrics over keys of a scenario, by SciPy."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from flexsc import _native as engine
from flexsc._named import library
from flexsc._numpy import np, npt
from flexsc._values import checked, number_to_vary

if TYPE_CHECKING:
    from flexsc._scenario import Scenario
    from flexsc._units import Metrics


class Optimum(NamedTuple):
    """Result of `optimise`: the scenario with the best values, and SciPy's account of the search.

    >>> best: flexsc.Optimum = flexsc.optimise(scenario, ["law.pd.k_d"], "itae")        # doctest: +SKIP
    """

    scenario: Scenario
    """The scenario with the best values.

    >>> best.scenario.get("law.pd.k_d")                                                 # doctest: +SKIP
    0.26
    """
    result: Any
    """SciPy's OptimizeResult: its `x` are the values of the keys, its `fun` is the metric.

    >>> best.result.fun == best.scenario.simulate().metrics["itae"]                     # doctest: +SKIP
    True
    """


def optimise(
    scenario: Scenario,
    keys: Sequence[str],
    metric: str | Callable[[Metrics], float],
    *,
    bounds: Mapping[str, tuple[float, float]] | Sequence[tuple[float, float]] | None = None,
    method: str = "Nelder-Mead",
    run: int = 0,
    **options: Any,
) -> Optimum:
    """Minimise a metric over keys of a scenario with `scipy.optimize.minimize`, which must be installed.

    The values of the scenario are the start. SciPy sees them divided by their size, so that steps and
    tolerances are relative. All runs have the same noise. A run that fails, has no value of the metric, or
    whose values the scenario does not accept counts as infinite, which gradient-free methods such as
    Nelder-Mead, Powell and COBYLA leave again.

    Args:
        scenario: The scenario.
        keys: The keys of numbers, such as `["law.pd.k_p", "law.pd.k_d"]`.
        metric: The metric, such as `settling_time_s`, or a function of all metrics of a run; a minus sign
            maximises.
        bounds: The smallest and largest value of each key, in the order of `keys` or by key.
        method: The method of `scipy.optimize.minimize`.
        run: Number of the run, which selects the noise. Keys of `[uncertain]` keep their values.
        options: Options of the method, such as `maxiter=200` or `xatol=1e-4`.

    Returns:
        The scenario with the best values, and SciPy's OptimizeResult: its `x` are the values of the keys,
        its `fun` is the metric.

    >>> scenario = flexsc.Scenario({
    ...     "duration": 100.0, "body": {"planar": {"inertia": 2.0, "angle": 0.1}},
    ...     "law": {"pd": {"k_p": 0.02, "k_d": 0.2, "period": 0.5}},
    ... })
    >>> better, result = flexsc.optimise(scenario, ["law.pd.k_d"], "itae")              # doctest: +SKIP
    >>> better.simulate().metrics["itae"] == result.fun                                 # doctest: +SKIP
    True

    Raises:
        ImportError: SciPy is not installed.
        ValueError: A key or the metric of the start is not a number, or a bound is missing.
        ScenarioError: There is no such key.
        SimulationError: The run of the start fails.
    """
    minimize = library("scipy.optimize", "flexsc.optimise", "scipy").minimize
    checked(scenario)
    if isinstance(keys, str) or not keys:
        raise ValueError(f"keys must be a list of names, got {keys!r}")
    start = np.array([number_to_vary(key, scenario.get(key)) for key in keys])
    scale = np.where(start == 0.0, 1.0, np.abs(start))
    limits = _limits(list(keys), bounds)

    def at(scaled: npt.NDArray[np.float64]) -> Scenario:
        values = scaled * scale
        if limits is not None:
            # Bounds are met to the last bit, whatever the scale.
            values = np.clip(values, *limits.T)
        return scenario.with_(dict(zip(keys, values.tolist(), strict=True)))

    def cost(scaled: npt.NDArray[np.float64]) -> float:
        try:
            found = _measured(at(scaled), metric, run)
        except (engine.ScenarioError, engine.SimulationError):
            return float("inf")
        return float("inf") if found is None or found != found else found

    first = _measured(scenario, metric, run)
    if first is None or not np.isfinite(first):
        raise ValueError(f"{scenario.name}: the metric has no value at the start, it is {first}")
    scaled = None if limits is None else [tuple(pair) for pair in (limits / scale[:, None]).tolist()]
    result = minimize(cost, start / scale, method=method, bounds=scaled, options=options)
    best = at(np.asarray(result.x, dtype=np.float64))
    result.x = np.array([best.get(key) for key in keys], dtype=np.float64)
    return Optimum(best, result)


def _measured(scenario: Scenario, metric: str | Callable[[Metrics], float], run: int) -> float | None:
    metrics = scenario.simulate(run, "none").metrics
    value: Any = metrics[metric] if isinstance(metric, str) else metric(metrics)
    if value is None:
        return None
    try:
        return float(value)
    except (TypeError, ValueError):
        raise ValueError(f"the metric must be a number, it is {value!r}") from None


def _limits(
    keys: list[str], bounds: Mapping[str, tuple[float, float]] | Sequence[tuple[float, float]] | None
) -> npt.NDArray[np.float64] | None:
    """The bounds of each key, of shape (keys, 2)."""
    if bounds is None:
        return None
    if isinstance(bounds, Mapping):
        other = [key for key in bounds if key not in keys]
        if other:
            raise ValueError(f"bounds of {', '.join(other)}, which are not among the keys")
        bounds = [bounds.get(key, (-np.inf, np.inf)) for key in keys]
    found = np.array(list(bounds), dtype=np.float64)
    if found.shape != (len(keys), 2) or not (found[:, 0] <= found[:, 1]).all():
        raise ValueError(
            f"bounds must be a smallest and a largest value of each of {len(keys)} keys, got {bounds!r}"
        )
    return found


Optimum.__module__ = "flexsc"
