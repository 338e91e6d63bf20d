"""Environments for reinforcement learning: one, `SpacecraftEnv`, or many together, `SpacecraftVectorEnv`.

The extra `flexsc[gym]` installs the dependencies. Importing this module registers both as
`flexsc/Spacecraft-v0`:

    >>> import gymnasium, flexsc.gym
    >>> env = gymnasium.make("flexsc/Spacecraft-v0", scenario="four-clamped-modes", limit=1.0, dt=1.0)
    >>> observation, info = env.reset(seed=7)
    >>> observation.shape
    (6,)
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import gymnasium
import numpy as np
import numpy.typing as npt
from gymnasium.spaces import Box
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from flexsc._quantities import Quantities
from flexsc._scenario import Scenario
from flexsc._simulators import Simulators

__all__ = ["Beyond", "Quadratic", "SpacecraftEnv", "SpacecraftVectorEnv"]

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


def _size(quantities: Quantities, *names: str) -> Array:
    """The magnitude of the first quantity that exists, of shape (n,)."""
    values = next(quantities[name] for name in names if name in quantities)
    return np.abs(values) if values.ndim == 1 else np.sqrt(np.sum(values * values, axis=1))


@dataclass(frozen=True)
class Quadratic:
    """A reward: minus a quadratic cost of the true error, the true rate and the action.

    -((error/`error`)² + (rate/`rate`)² + `effort` action²), with the magnitudes of the vectors on three axes.

    >>> flexsc.gym.Quadratic(error=0.01, effort=0.1).rate
    0.1
    """

    error: float = 0.1
    """The error with a cost of 1 (rad)."""
    rate: float = 0.1
    """The rate with a cost of 1 (rad/s)."""
    effort: float = 0.01
    """The cost of the largest command about one axis."""

    def __call__(self, simulators: Simulators, actions: Array) -> Array:
        state = simulators.state
        error = _size(state, "error", "angle") / self.error
        rate = _size(state, "rate") / self.rate
        cost: Array = error * error + rate * rate + self.effort * np.sum(actions * actions, axis=1)
        return -cost


@dataclass(frozen=True)
class Beyond:
    """Terminates an episode if the true error or rate exceeds a limit.

    >>> flexsc.gym.Beyond(rate=0.5).error
    inf
    """

    error: float = np.inf
    """The largest error (rad)."""
    rate: float = np.inf
    """The largest rate (rad/s)."""

    def __call__(self, simulators: Simulators) -> Mask:
        state = simulators.state
        return (_size(state, "error", "angle") > self.error) | (_size(state, "rate") > self.rate)


class _Task:
    """The common part of one environment and of many."""

    def __init__(
        self,
        scenario: Scenario | str,
        count: int,
        dt: float,
        limit: npt.ArrayLike | None,
        observe: Observe | None,
        reward: Reward | None,
        terminate: Terminate | None,
        jobs: int | None,
    ) -> None:
        scenario = Scenario.example(scenario) if isinstance(scenario, str) else scenario
        self.simulators = Simulators(scenario, count, jobs)
        self.dt = float(dt)
        axes = self.simulators.axes
        most = self.simulators.command_limit if limit is None else np.asarray(limit, dtype=np.float64)
        self.limit: Array = np.broadcast_to(most, (axes,))
        if not (np.isfinite(self.limit) & (self.limit > 0.0)).all():
            unit = self.simulators.command_unit
            hint = "the actuator has none: give `limit`" if limit is None else f"got {limit!r}"
            raise ValueError(f"the largest command about each axis must be positive numbers ({unit}), {hint}")
        if observe is None:
            error = "error" if axes == 3 else "angle"
            observe = {f"believed.{error}": 1.0, "believed.rate": 1.0}
        self._observe = observe
        self._reward = Quadratic() if reward is None else reward
        self._terminate = Beyond() if terminate is None else terminate
        size = self.observe().shape[1]
        self.observation_space = Box(-np.inf, np.inf, (size,), np.float32)
        self.action_space = Box(-1.0, 1.0, (axes,), np.float32)

    def observe(self) -> Observation:
        """Observations of shape (n, numbers)."""
        sims = self.simulators
        if callable(self._observe):
            observation = np.asarray(self._observe(sims), dtype=np.float32)
            if observation.ndim != 2 or len(observation) != len(sims):
                raise ValueError(
                    f"observe must give an array of shape ({len(sims)}, numbers), got {observation.shape}"
                )
            return observation
        groups = {"state": sims.state, "measured": sims.measured, "believed": sims.believed}
        columns = []
        for name, scale in self._observe.items():
            group, _, quantity = name.partition(".")
            if group not in groups:
                raise ValueError(
                    f"observe must name `state.`, `measured.` or `believed.` quantities, got {name!r}"
                )
            columns.append(groups[group][quantity].reshape(len(sims), -1) / scale)
        observation = np.concatenate(columns, axis=1, dtype=np.float32, casting="same_kind")
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
        terminated = self._told(self._terminate(sims), np.bool_, "terminate")
        return reward, terminated, sims.done

    def _told(self, values: npt.ArrayLike, dtype: Any, name: str) -> npt.NDArray[Any]:
        array = np.array(values, dtype=dtype)
        if array.shape != (len(self.simulators),):
            raise ValueError(
                f"{name} must give an array of shape ({len(self.simulators)},), got {array.shape}"
            )
        return array


def _run(random: np.random.Generator) -> int:
    """The run number of an episode."""
    return int(random.integers(2**63))


class SpacecraftEnv(gymnasium.Env[Observation, npt.NDArray[Any]]):
    """A scenario as an environment: an agent acts in place of its law.

    Each episode is a separate run of the scenario, with new noise and newly drawn `[uncertain]` keys. Its run
    number follows from the seed and is `info["run"]`. An episode is truncated at the end of the scenario's
    `duration`.

    Args:
        scenario: The scenario, or the name of a shipped one. Its `[law]` is not used.
        dt: The length of a step, over which a command is held (s).
        limit: The command that corresponds to an action of 1 about each axis, a number or of shape (axes,),
            in the unit of `Simulator.command_unit`; if omitted, the largest that the actuator can execute.
            Larger actions are clipped to 1.
        observe: The observation, as names with scales or as a callable; if omitted, `believed.error` (on one
            axis `believed.angle`) and `believed.rate`, unscaled (rad, rad/s).
        reward: The reward of a step, computed from simulators and actions; if omitted, `Quadratic()`.
        terminate: Whether an episode has ended before its time; if omitted, never.
        render_mode: None is the only value: use logs of `scenario.draw(run)` to view a run.

    Raises:
        ValueError: The actuator has no limit and `limit` is not given; `dt` is not a positive time; or
            `observe` names a quantity that does not exist.

    >>> env = flexsc.gym.SpacecraftEnv("four-clamped-modes", dt=1.0, limit=1.0)
    >>> observation, info = env.reset(seed=1)
    >>> observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
    """

    metadata = {"render_modes": []}  # noqa: RUF012

    def __init__(
        self,
        scenario: Scenario | str,
        dt: float = 0.1,
        limit: npt.ArrayLike | None = None,
        observe: Observe | None = None,
        reward: Reward | None = None,
        terminate: Terminate | None = None,
        render_mode: None = None,
    ) -> None:
        self._task = _Task(scenario, 1, dt, limit, observe, reward, terminate, 1)
        self.observation_space = self._task.observation_space
        self.action_space = self._task.action_space
        self.render_mode = render_mode

    @property
    def simulators(self) -> Simulators:
        """The simulator of the environment: one copy."""
        return self._task.simulators

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Start an episode: the next of its seed, or with `options={"run": n}` the run with this number."""
        super().reset(seed=seed)
        run = _run(self.np_random)
        run = (options or {}).get("run", run)
        self._task.simulators.reset(runs=[run])
        return self._task.observe()[0], {"run": run}

    def step(self, action: npt.NDArray[Any]) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Hold a command for a step; return observation, reward, terminated, truncated and info."""
        reward, terminated, truncated = self._task.step(np.asarray(action)[None], None)
        observation = self._task.observe()[0]
        return observation, float(reward[0]), bool(terminated[0]), bool(truncated[0]), {}


class SpacecraftVectorEnv(VectorEnv[Observation, npt.NDArray[Any], npt.NDArray[Any]]):
    """Many `SpacecraftEnv` advanced together, on all cores.

    Copy i has, with seed s, the episodes of `SpacecraftEnv` with seed s + i.

    Args:
        scenario, dt, limit, observe, reward, terminate: As in `SpacecraftEnv`.
        num_envs: The number of environments.
        autoreset_mode: When the next episode starts. `NextStep`: in the step after the end of an episode.
            `SameStep`: in the step that ends the episode; `info["final_obs"]` has its last observation.
            `Disabled`: at `reset` with `options={"reset_mask": mask}`.
        jobs: Number of threads; if omitted, one per core.

    >>> envs = flexsc.gym.SpacecraftVectorEnv("four-clamped-modes", num_envs=100, dt=1.0, limit=1.0)
    >>> observations, info = envs.reset(seed=1)
    >>> envs.step(envs.action_space.sample())[1].shape
    (100,)
    """

    metadata: dict[str, Any] = {"render_modes": [], "autoreset_mode": AutoresetMode.NEXT_STEP}  # noqa: RUF012

    def __init__(
        self,
        scenario: Scenario | str,
        num_envs: int = 1,
        dt: float = 0.1,
        limit: npt.ArrayLike | None = None,
        observe: Observe | None = None,
        reward: Reward | None = None,
        terminate: Terminate | None = None,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        jobs: int | None = None,
        render_mode: None = None,
    ) -> None:
        self.num_envs = num_envs
        self._task = _Task(scenario, num_envs, dt, limit, observe, reward, terminate, jobs)
        self._mode = AutoresetMode(autoreset_mode)
        self.metadata = {**self.metadata, "autoreset_mode": self._mode}
        self.single_observation_space = self._task.observation_space
        self.single_action_space = self._task.action_space
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.render_mode = render_mode
        self._ended: Mask = np.zeros(num_envs, dtype=np.bool_)
        self._randoms: list[np.random.Generator] = []

    @property
    def simulators(self) -> Simulators:
        """The simulators of the environments: one copy each."""
        return self._task.simulators

    def reset(
        self, *, seed: int | list[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Start episodes: all, or those of `options["reset_mask"]`."""
        count = self.num_envs
        mask = (options or {}).get("reset_mask", np.ones(count, dtype=np.bool_))
        seeds: list[int | None]
        if isinstance(seed, int):
            seeds = [seed + index for index in range(count)]
        else:
            seeds = [None] * count if seed is None else list(seed)
        if len(seeds) != count:
            raise ValueError(f"there must be {count} seeds, got {len(seeds)}")
        if not self._randoms:
            self._randoms = [seeding.np_random(seed)[0] for seed in seeds]
        else:
            for index, of in enumerate(seeds):
                if of is not None and mask[index]:
                    self._randoms[index] = seeding.np_random(of)[0]
        info = self._begin(mask)
        self._ended = self._ended & ~mask
        return self._task.observe(), info

    def _begin(self, mask: Mask) -> dict[str, Any]:
        """Start the next episodes of some environments."""
        runs = self._task.simulators.runs
        for index in np.flatnonzero(mask):
            runs[index] = _run(self._randoms[index])
        self._task.simulators.reset(mask, runs)
        return {"run": np.where(mask, runs, 0), "_run": mask.copy()}

    def step(
        self, actions: npt.NDArray[Any]
    ) -> tuple[Observation, npt.NDArray[Any], npt.NDArray[Any], npt.NDArray[Any], dict[str, Any]]:
        """Hold commands of shape (n, axes); return observations, rewards, terminations, truncations and
        info."""
        if not self._randoms:
            raise gymnasium.error.ResetNeeded("Cannot call env.step() before calling env.reset()")
        begins = self._ended
        if self._mode is AutoresetMode.DISABLED and begins.any():
            raise ValueError(f"{int(begins.sum())} episodes have ended: reset them with `reset_mask`")
        reward, terminated, truncated = self._task.step(actions, ~begins if begins.any() else None)
        info: dict[str, Any] = {}
        if begins.any():
            reward[begins] = 0.0
            terminated &= ~begins
            truncated = truncated & ~begins
            info = self._begin(begins)
        ended = terminated | truncated
        if self._mode is AutoresetMode.SAME_STEP:
            if ended.any():
                last = np.full(self.num_envs, None, dtype=object)
                observation = self._task.observe()
                for index in np.flatnonzero(ended):
                    last[index] = observation[index]
                info = self._begin(ended)
                info |= {"final_obs": last, "_final_obs": ended, "final_info": {}, "_final_info": ended}
        else:
            self._ended = ended
        return self._task.observe(), reward, terminated, truncated, info


gymnasium.register(
    id="flexsc/Spacecraft-v0",
    entry_point="flexsc.gym:SpacecraftEnv",
    vector_entry_point="flexsc.gym:SpacecraftVectorEnv",
)
