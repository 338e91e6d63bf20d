"""Derivatives of metrics by keys of a scenario."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from flexsc import _units
from flexsc._columns import Lookup
from flexsc._equality import Compared
from flexsc._named import Named, library, no_such
from flexsc._numpy import np, npt
from flexsc._population import evaluate
from flexsc._values import checked, number_to_vary

if TYPE_CHECKING:
    from flexsc._scenario import Scenario

    Values = npt.NDArray[np.float64]

# Step of a key, of its value.
_STEP = 1e-3
# Steps of the runs, by that of the key: pairs of the whole step and of half of it.
_PLACES = (-1.0, 1.0, -0.5, 0.5)
# Derivatives with the two steps that differ by more than this share are of no smooth function, if they also
# differ by more than rounding and the steps of an integrator leave in a metric.
_TOLERANCE, _ROUNDING = 0.1, 1e-8


@dataclass(frozen=True, eq=False)
class Sensitivities(Compared, Lookup["Named[float]"]):
    """Derivatives of metrics by keys: a mapping from each metric to its derivatives by key.

    >>> scenario, key = flexsc.Scenario.example("wheel-fixed-gain"), "body.planar.modes[0].frequency"
    >>> found = flexsc.sensitivities(scenario, [key], ["settling_time_s"])
    >>> list(found), found.unit("settling_time_s", key)
    (['settling_time_s'], 's per (rad/s)')
    """

    scenario: Scenario
    """The scenario with its own values.

    >>> found.scenario == scenario
    True
    """
    varied: list[str]
    """The keys.

    >>> found.varied
    ['body.planar.modes[0].frequency']
    """
    metrics: list[str]
    """The metrics.

    >>> found.metrics
    ['settling_time_s']
    """
    nominal: Values
    """The metrics of the scenario itself, of shape (metrics,).

    >>> found.nominal.round(1).tolist()                                # s
    [302.0]
    """
    derivatives: Values
    """The derivatives, of shape (metrics, keys), NaN where a metric is not smooth or has no value.

    >>> found.derivatives.shape
    (1, 1)
    """
    errors: Values
    """Estimated absolute errors of the derivatives, of shape (metrics, keys).

    >>> (found.errors < 1e-3 * abs(found.derivatives)).tolist()
    [[True]]
    """

    _instead = "use `derivatives`, or index it by metric"

    def _described(self) -> str:
        return "a table of sensitivities"

    def __getitem__(self, metric: str) -> Named[float]:
        return self._of(self.derivatives, metric)

    def __iter__(self) -> Iterator[str]:
        return iter(self.metrics)

    def __len__(self) -> int:
        return len(self.metrics)

    def error(self, metric: str, key: str) -> float:
        """Return the estimated absolute error of a derivative, in its unit.

        >>> scenario = flexsc.Scenario.example("rotation-sine")
        >>> found = flexsc.sensitivities(scenario, ["manoeuvre.angle"], ["peak_torque_nm"])
        >>> found.error("peak_torque_nm", "manoeuvre.angle") < 1e-6
        True

        Raises:
            KeyError: There is no such metric or key.
        """
        return self._of(self.errors, metric)[key]

    def unit(self, metric: str, key: str) -> str:
        """Return the unit of a derivative, such as `rad per (rad/s)`: that of the metric per that of the key.

        >>> scenario = flexsc.Scenario.example("rotation-sine")
        >>> found = flexsc.sensitivities(scenario, ["manoeuvre.angle"], ["peak_torque_nm"])
        >>> found.unit("peak_torque_nm", "manoeuvre.angle")
        'N m per rad'

        Raises:
            KeyError: There is no such metric or key.
        """
        self._of(self.errors, metric)[key]
        above, below = _units.meanings(self.scenario)[metric]["unit"], _units.of_key(key)
        if not below:
            return above
        if _units.is_reduced(self.scenario):
            below = _units.reduced_unit(below)
        return f"{above or '1'} per {below if below.isalpha() else f'({below})'}"

    def _of(self, array: Values, metric: str) -> Named[float]:
        if metric not in self.metrics:
            raise no_such("no metric", metric, self.metrics)
        row = array[self.metrics.index(metric)].tolist()
        return Named.of(dict(zip(self.varied, row, strict=True)), "no key")

    def to_pandas(self) -> Any:
        """Return the derivatives as a `pandas.DataFrame`, which must be installed (`pip install pandas`).

        The metrics are the rows and the keys the columns. `frame.attrs` has the frame of `errors`, and the
        `units` by metric and key.

        >>> scenario = flexsc.Scenario.example("rotation-sine")
        >>> found = flexsc.sensitivities(scenario, ["manoeuvre.angle"], ["peak_torque_nm"])
        >>> found.to_pandas().loc["peak_torque_nm", "manoeuvre.angle"]          # doctest: +SKIP

        Raises:
            ImportError: pandas is not installed.
        """
        pandas = library("pandas", "Sensitivities.to_pandas")
        frame = pandas.DataFrame(self.derivatives, index=self.metrics, columns=self.varied)
        units = {metric: {key: self.unit(metric, key) for key in self.varied} for metric in self.metrics}
        errors = {metric: dict(self._of(self.errors, metric)) for metric in self.metrics}
        frame.attrs.update({"errors": errors, "units": units})
        return frame

    def _repr_html_(self) -> str:
        from flexsc import _html

        rows = ((metric, *self[metric].values()) for metric in self.metrics)
        return _html.heading(self.scenario.name, "derivatives") + _html.table(("metric", *self.varied), rows)

    def __repr__(self) -> str:
        def line(metric: str, key: str) -> str:
            value = f"{self[metric][key]:.6g} +- {self.error(metric, key):.2g}"
            return f"  {metric} by {key}: {value} {self.unit(metric, key)}".rstrip()

        lines = "\n".join(line(metric, key) for metric in self.metrics for key in self.varied)
        return f"<flexsc.Sensitivities of {self.scenario.name}:\n{lines}>"


def sensitivities(
    scenario: Scenario,
    keys: Sequence[str],
    metrics: Sequence[str],
    *,
    step: float | Mapping[str, float] | None = None,
    run: int = 0,
    jobs: int | None = None,
    yes: bool = False,
) -> Sensitivities:
    """Return derivatives of metrics by keys of a scenario, from central differences of runs.

    Runs are reproducible to the bit and all have the same noise, so differences of metrics have no noise of
    their own. A key takes four values, a step and half a step below and above its own; extrapolation of the
    two differences to a step of zero gives the derivative, and their distance the estimate of its error.

    A metric that counts leaps, and one that a switching or the end of the run cuts off bends. Where the two
    differences disagree by more than a tenth, of the larger one or of what the curvature changes within a
    step, the derivative is NaN and a RuntimeWarning names it.

    Args:
        scenario: The scenario.
        keys: The keys of numbers, such as `["law.relay.k_t"]`.
        metrics: The metrics of single numbers, such as `["cycle_period_s"]`.
        step: The step of each key relative to its value, 1e-3 if omitted; or a mapping from each key to its
            step in the unit of the key, which a key with the value 0 needs.
        run: Number of the run, which selects the noise. Keys of `[uncertain]` keep their values.
        jobs: Number of threads, as in `evaluate`.
        yes: As in `Scenario.simulate`.

    Returns:
        The derivatives, their errors and units.

    >>> scenario = flexsc.Scenario.example("rotation-sine")
    >>> found = flexsc.sensitivities(scenario, ["manoeuvre.angle"], ["peak_torque_nm"])
    >>> torque, angle = found.nominal[0], scenario.get("manoeuvre.angle")
    >>> bool(abs(found["peak_torque_nm"]["manoeuvre.angle"] - torque / angle) < 1e-6)    # It is linear.
    True

    Raises:
        ValueError: A key or metric is not a number, or a step is missing or not accepted.
        KeyError: The run has no such metric.
        ScenarioError: There is no such key, or it does not accept a value of a step.
        SimulationError: A run fails.
    """
    checked(scenario)
    keys, metrics = _names("keys", keys), _names("metrics", metrics)
    steps = {key: _step(scenario, key, step) for key in keys}
    # A row for each place of each key: the values of all keys.
    points = np.repeat([[float(scenario.get(key)) for key in keys]], len(keys) * len(_PLACES), axis=0)
    for k, own in enumerate(steps.values()):
        points[k * len(_PLACES) : (k + 1) * len(_PLACES), k] += np.array(_PLACES) * own
    of_run = scenario.simulate(run, "none", yes).metrics
    first = np.array([_number(name, of_run[name]) for name in metrics], dtype=np.float64)
    around = evaluate(scenario, keys, points, metrics, run=run, jobs=jobs, yes=yes)
    _check_runs(scenario, keys, points[np.isnan(around).all(axis=1)], run, yes)
    around = around.reshape(len(keys), len(_PLACES), len(metrics))
    h = np.array(list(steps.values()))[:, None]
    wide, narrow = (around[:, 1] - around[:, 0]) / (2.0 * h), (around[:, 3] - around[:, 2]) / h
    found = (4.0 * narrow - wide) / 3.0
    largest = np.maximum(np.abs(around).max(axis=1), np.abs(first))
    apart = np.abs(narrow - wide)
    errors = np.abs(found - narrow) + 4.0 * np.finfo(np.float64).eps * largest / h
    # Where the derivative vanishes, as at a minimum, the curvature shows whether the metric is smooth.
    bend = (around[:, 1] - 2.0 * first + around[:, 0]) / h**2
    bend_narrow = 4.0 * (around[:, 3] - 2.0 * first + around[:, 2]) / h**2
    smooth = _agree(wide, narrow) | (_agree(bend, bend_narrow) & (apart <= _TOLERANCE * abs(bend) * h))
    leaps = ~np.isfinite(found) | (~smooth & (apart * h > _ROUNDING * largest))
    found[leaps] = errors[leaps] = np.nan
    _warn([(metrics[metric], keys[key]) for key, metric in np.argwhere(leaps)])
    return Sensitivities(scenario, keys, metrics, first, found.T, errors.T)


def _agree(one: Values, other: Values) -> npt.NDArray[np.bool_]:
    """True where two estimates of a value agree."""
    agree: npt.NDArray[np.bool_] = abs(one - other) <= _TOLERANCE * np.maximum(abs(one), abs(other))
    return agree


def _names(what: str, names: Sequence[str]) -> list[str]:
    if isinstance(names, str) or not names:
        raise ValueError(f"{what} must be a list of names, got {names!r}")
    return list(names)


def _check_runs(scenario: Scenario, keys: list[str], points: Values, run: int, yes: bool) -> None:
    """Raise the error of the first point without any value, if it has one."""
    for point in points.tolist():
        scenario.with_(dict(zip(keys, point, strict=True))).simulate(run, "none", yes)


def _step(scenario: Scenario, key: str, step: float | Mapping[str, float] | None) -> float:
    """The step of a key, in its unit."""
    value = scenario.get(key)
    number_to_vary(key, value)
    if isinstance(value, int):
        raise ValueError(f"{key} is a whole number, {value}, by which there are no derivatives")
    if isinstance(step, Mapping):
        if key not in step:
            raise ValueError(f"step has no entry for {key}; it has {', '.join(step) or 'none'}")
        found = float(step[key])
    else:
        found = abs(value) * float(_STEP if step is None else step)
        if value == 0.0:
            raise ValueError(f"{key} is 0, so its step must be given: step={{{key!r}: ...}}")
    if not 0.0 < found < float("inf"):
        raise ValueError(f"the step of {key} must be a positive number, got {found}")
    return found


def _number(name: str, value: Any) -> float:
    """A metric as a number, NaN if it has no value."""
    if value is None:
        return float("nan")
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise ValueError(f"{name} is not a single number, it is {value!r}")
    return float(value)


def _warn(pairs: list[tuple[str, str]]) -> None:
    """Name the derivatives that do not exist."""
    if pairs:
        each = ", ".join(f"{metric} by {key}" for metric, key in pairs)
        why = "no derivative, as the metric leaps, bends or has no value within the step"
        warnings.warn(f"{why}: {each}; another step may help", RuntimeWarning, stacklevel=3)


Sensitivities.__module__ = "flexsc"
