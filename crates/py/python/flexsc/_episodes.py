"""What environments of one and of many runs have in common: observations, rewards and ends of episodes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import isfinite, sqrt
from typing import Any

from gymnasium.spaces import Box

from flexsc._numpy import np, npt
from flexsc._one_copy import OneCopy
from flexsc._quantities import Quantities
from flexsc._result import Detail, Result
from flexsc._scenario import Scenario
from flexsc._simulator import Simulator
from flexsc._simulators import Simulators

Array = npt.NDArray[np.float64]
Observation = npt.NDArray[np.float32]
Mask = npt.NDArray[np.bool_]

Observe = Mapping[str, float] | Callable[[Simulators], npt.ArrayLike]
"""The observation: names such as `believed.rate`, each with the value by which it is divided; or a callable
that returns an array of shape (n, numbers) from the simulators."""
Reward = Callable[[Simulators, Array], npt.ArrayLike]
"""Rewards of shape (n,), computed from the simulators after a step and from the actions of shape (n,
axes)."""
Terminate = Callable[[Simulators], npt.ArrayLike]
"""Whether each episode has ended for a reason other than its time, of shape (n,)."""

# The runs of which the largest error and rate at the start are the scales of observations.
_RUNS_OF_SCALES = 16
# The error (rad) and the rate (rad/s) that are observed as 1 where a scenario gives no scale.
_NO_SCALE = 0.1


def _squares(values: Array) -> Array:
    """The sum of the squares of each row, of shape (n,), added in the order of the columns."""
    if values.ndim == 1:
        return values * values
    total: Array = values[:, 0] * values[:, 0]
    for column in range(1, values.shape[1]):
        total = total + values[:, column] * values[:, column]
    return total


def _size(quantities: Quantities, *names: str) -> Array:
    """The magnitude of the first quantity that exists, of shape (n,)."""
    values = next(quantities[name] for name in names if name in quantities)
    sizes: Array = np.sqrt(_squares(values))
    return sizes


@dataclass(frozen=True)
class Quadratic:
    """A reward: minus a quadratic cost of the true error, the true rate and the action.

    -((error/`error`)² + (rate/`rate`)² + `effort` action²), with the magnitudes of the vectors on three axes.

    >>> flexsc.gym.Quadratic(error=0.01, effort=0.1).rate
    0.1
    """

    error: float = 0.1
    """The error with a cost of 1 (rad).

    >>> flexsc.gym.Quadratic(error=0.01).error
    0.01
    """
    rate: float = 0.1
    """The rate with a cost of 1 (rad/s).

    >>> flexsc.gym.Quadratic(rate=0.02).rate
    0.02
    """
    effort: float = 0.01
    """The cost of the largest command about one axis.

    >>> flexsc.gym.Quadratic(effort=0.1).effort
    0.1
    """

    def __call__(self, simulators: Simulators, actions: Array) -> Array:
        """Return the rewards of a step, of shape (n,)."""
        state = simulators.state
        error = _size(state, "error", "angle") / self.error
        rate = _size(state, "rate") / self.rate
        cost: Array = error * error + rate * rate + self.effort * _squares(actions)
        return -cost


@dataclass(frozen=True)
class Beyond:
    """Terminates an episode if the true error or rate exceeds a limit.

    >>> flexsc.gym.Beyond(rate=0.5).error
    inf
    """

    error: float = np.inf
    """The largest error (rad).

    >>> flexsc.gym.Beyond(error=0.1).error
    0.1
    """
    rate: float = np.inf
    """The largest rate (rad/s).

    >>> flexsc.gym.Beyond(rate=0.5).rate
    0.5
    """

    def __call__(self, simulators: Simulators) -> Mask:
        """Return which episodes end, of shape (n,)."""
        state = simulators.state
        # Nothing is beyond an infinite limit.
        beyond = np.zeros(len(simulators), dtype=np.bool_)
        if self.error < np.inf:
            beyond |= _size(state, "error", "angle") > self.error
        if self.rate < np.inf:
            beyond |= _size(state, "rate") > self.rate
        return beyond


def scales(scenario: Scenario, dt: float, limit: Array) -> tuple[float, float]:
    """Return the error (rad) and the rate (rad/s) that are observed as 1, to two digits.

    They are the largest at the start of the runs 0 to 15, or those on the fastest way between rest at that
    error and the goal under the largest command, whichever is larger.
    """
    errors, rates = [0.0], [0.0]
    for run in range(_RUNS_OF_SCALES if scenario.get("uncertain") else 1):
        try:
            state = Simulator(scenario.draw(run), run).state
        except (ValueError, RuntimeError):
            # A run that cannot begin has no scale.
            continue
        errors.append(_magnitude(state["error"] if "error" in state else state["angle"]))
        rates.append(_magnitude(state["rate"]))
    ends = []
    for sign in (1.0, -1.0):
        sim = Simulator(scenario)
        sim.step(sign * limit, dt)
        ends.append(sim.state["rigid_rate"])
    acceleration = _magnitude(ends[0] - ends[1]) / (2.0 * dt)
    error, rate = max(errors), max(rates)
    if acceleration > 0.0 and isfinite(acceleration):
        error, rate = max(error, rate * rate / (2.0 * acceleration)), max(rate, sqrt(error * acceleration))
    return float(f"{error or _NO_SCALE:.2g}"), float(f"{rate or _NO_SCALE:.2g}")


def _magnitude(values: Array) -> float:
    return float(np.sqrt(np.sum(values * values)))


class Task:
    """The common part of one environment and of many."""

    def __init__(
        self,
        scenario: Scenario | str,
        dt: float,
        limit: npt.ArrayLike | None,
        observe: Observe | None,
        reward: Reward | None,
        terminate: Terminate | None,
        metrics: Sequence[str],
        simulators: Callable[[Scenario], Simulators],
        render_mode: None = None,
    ) -> None:
        if render_mode is not None:
            raise ValueError(f"render_mode must be None, as `result` has the figures, got {render_mode!r}")
        if isinstance(scenario, str):
            scenario = (Scenario.load if scenario.endswith(".toml") else Scenario.example)(scenario)
        self.simulators = simulators(scenario)
        self.dt = float(dt)
        self.metrics = tuple(metrics)
        axes = self.simulators.axes
        most = self.simulators.command_limit if limit is None else np.asarray(limit, dtype=np.float64)
        self.limit: Array = np.broadcast_to(most, (axes,))
        if not (np.isfinite(self.limit) & (self.limit > 0.0)).all():
            unit = self.simulators.command_unit
            hint = "the actuator has none: give `limit`" if limit is None else f"got {limit!r}"
            raise ValueError(f"the largest command about each axis must be positive numbers ({unit}), {hint}")
        if observe is None:
            error, rate = scales(scenario, self.dt, self.limit)
            observe = {"believed.error" if axes == 3 else "believed.angle": error, "believed.rate": rate}
        if not callable(observe) and not isinstance(observe, Mapping):
            raise TypeError(f"observe must map names to what they are divided by, got {observe!r}")
        self.observed = observe if callable(observe) else dict(observe)
        self._observe = observe if callable(observe) else None
        if not callable(observe):
            self.places, self.scales = self._named(observe)
        self._reward = Quadratic() if reward is None else reward
        self._terminate = terminate
        if isinstance(terminate, Beyond) and terminate == Beyond():
            self._terminate = None
        size = self.observe().shape[1]
        self.observation_space = Box(-np.inf, np.inf, (size,), np.float32)
        self.action_space = Box(-1.0, 1.0, (axes,), np.float32)

    def _named(self, observe: Mapping[str, float]) -> tuple[npt.NDArray[np.intp], Array]:
        """The positions of the named quantities in a row, and the value by which each number is divided."""
        sims = self.simulators
        # A row of positions, read like a row of numbers.
        count = sims._observe_row().shape[1]
        at = np.arange(count, dtype=np.float64).reshape(1, count)
        places, divisors = [], []
        for name, scale in observe.items():
            group, _, quantity = name.partition(".")
            if group not in ("state", "measured", "believed"):
                raise ValueError(
                    f"observe must name `state.`, `measured.` or `believed.` quantities, got {name!r}"
                )
            found = sims._fields.view(group, at)[quantity].reshape(-1)
            places.append(found)
            divisors.append(np.full(len(found), scale, dtype=np.float64))
        return np.concatenate(places).astype(np.intp), np.concatenate(divisors)

    def observe(self) -> Observation:
        """Observations of shape (n, numbers)."""
        sims = self.simulators
        if self._observe is None:
            chosen = sims._observe_row()[:, self.places]
            named: Observation = np.divide(chosen, self.scales).astype(np.float32)
            return named
        observation = np.asarray(self._observe(sims), dtype=np.float32)
        if observation.ndim != 2 or len(observation) != len(sims):
            raise ValueError(
                f"observe must give an array of shape ({len(sims)}, numbers), got {observation.shape}"
            )
        return observation

    def step(self, actions: npt.ArrayLike, mask: Mask | None) -> tuple[Array, Mask, Mask]:
        """Advance; return the rewards and which episodes were terminated and truncated."""
        sims, count = self.simulators, len(self.simulators)
        given = np.asarray(actions, dtype=np.float64)
        if given.shape != (count, sims.axes):
            raise ValueError(f"actions must have shape {(count, sims.axes)}, got {given.shape}")
        given = np.clip(given, -1.0, 1.0)
        sims.step(given * self.limit, self.dt, mask)
        reward = self._told(self._reward(sims, given), np.float64, "reward")
        if self._terminate is None:
            return reward, np.zeros(count, dtype=np.bool_), sims.done
        return reward, self._told(self._terminate(sims), np.bool_, "terminate"), sims.done

    def _told(self, values: npt.ArrayLike, dtype: Any, name: str) -> npt.NDArray[Any]:
        array = np.array(values, dtype=dtype)
        if array.shape != (len(self.simulators),):
            raise ValueError(
                f"{name} must give an array of shape ({len(self.simulators)},), got {array.shape}"
            )
        return array

    def result(self, index: int, log: Detail) -> Result:
        """The present episode of a copy as a result: its run is repeated under its commands."""
        return self.simulators[index].result(log)

    def metrics_of(self, index: int) -> dict[str, Any]:
        """The chosen metrics of the present episode of a copy."""
        of_run = self.result(index, "none").metrics
        return {name: of_run[name] for name in self.metrics}


def drawn_run(random: np.random.Generator) -> int:
    """Return the run number of the next episode."""
    return int(random.integers(2**63))


def with_success(metrics: dict[str, Any]) -> dict[str, Any]:
    """Return the info of an episode that has ended: its metrics, and whether its goal is met."""
    goal = {"is_success": metrics["goal"] == "met"} if "goal" in metrics else {}
    return {"metrics": metrics, **goal}


class QuickStep:
    """A step of one environment with named observations, a quadratic reward and limits, without small arrays.

    Its numbers are those of `Task`, to the bit: a call of NumPy costs more than arithmetic on three numbers.
    """

    @classmethod
    def of(cls, task: Task) -> QuickStep | None:
        """Return the quick step of a task, if it has one."""
        # Python's arithmetic refuses to divide by zero, which NumPy's does not.
        plain = task._observe is None and task.scales.all() and type(task._reward) is Quadratic
        return cls(task) if plain and isinstance(task._terminate, (Beyond, type(None))) else None

    def __init__(self, task: Task) -> None:
        sims = task.simulators
        assert isinstance(sims._native, OneCopy)
        assert isinstance(task._reward, Quadratic)
        self._task, self._sims, self._copy = task, sims, sims._native
        self._shape, self._limit, self._dt = (sims.axes,), task.limit.tolist(), task.dt
        self._command = np.empty(sims.axes)
        self._reward = task._reward
        beyond = Beyond() if task._terminate is None else task._terminate
        assert isinstance(beyond, Beyond)
        self._beyond = beyond
        at = np.arange(len(self._copy.row)).astype(np.float64)
        state = sims._fields.view("state", at)
        error = state["error"] if "error" in state else state["angle"]
        self._error = [int(place) for place in np.atleast_1d(error)]
        self._rate = [int(place) for place in np.atleast_1d(state["rate"])]
        self._scales = list(zip(task.places.tolist(), task.scales.tolist(), strict=True))

    def step(self, action: npt.ArrayLike) -> tuple[Observation, float, bool, bool]:
        """Advance; return observation, reward, terminated and truncated."""
        given = np.asarray(action)
        if given.dtype.char not in "fd":
            given = np.asarray(action, dtype=np.float64)
        if given.shape != self._shape:
            raise ValueError(f"actions must have shape {(1, *self._shape)}, got {(1, *given.shape)}")
        # What is not a number stays so: no comparison with it is true.
        values = [min(max(value, -1.0), 1.0) for value in given.tolist()]
        effort = _sum_of_squares(values)
        copy, sims, command = self._copy, self._sims, self._command
        for axis, value in enumerate(values):
            command[axis] = value * self._limit[axis]
        if effort != effort or copy.failed:
            # An action that is not a number, or a run that cannot go on, is answered by the usual step.
            sims.step(command[None], self._dt)
        copy.simulator.steer(command)
        copy.advance(self._dt)
        sims._rows = None
        if copy.failed:
            sims._raise()
        row = copy.row.tolist()
        of_error = sqrt(_sum_of_squares([row[place] for place in self._error]))
        of_rate = sqrt(_sum_of_squares([row[place] for place in self._rate]))
        error, rate = of_error / self._reward.error, of_rate / self._reward.rate
        cost = error * error + rate * rate + self._reward.effort * effort
        terminated = of_error > self._beyond.error or of_rate > self._beyond.rate
        observation = np.array([row[place] / scale for place, scale in self._scales], dtype=np.float32)
        return observation, -cost, terminated, copy.simulator.done


def _sum_of_squares(values: list[float]) -> float:
    total = values[0] * values[0]
    for value in values[1:]:
        total += value * value
    return total
