"""Environments for reinforcement learning: one, `SpacecraftEnv`, or many together, `SpacecraftVectorEnv`.

The extra `flexsc[gym]` installs the dependencies. Importing this module registers both as
`flexsc/Spacecraft-v0`:

    >>> import gymnasium, flexsc.gym
    >>> env = gymnasium.make("flexsc/Spacecraft-v0", scenario="four-clamped-modes", limit=1.0, dt=1.0)
    >>> observation, info = env.reset(seed=7)
    >>> observation.shape
    (6,)

`gymnasium.make("flexsc.gym:flexsc/Spacecraft-v0", ...)` imports it first. `stable_baselines` makes such an
environment for Stable-Baselines3.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import gymnasium
import numpy as np
import numpy.typing as npt
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from flexsc._episodes import (
    Beyond,
    Mask,
    Observation,
    Observe,
    Quadratic,
    QuickStep,
    Reward,
    Task,
    Terminate,
)
from flexsc._result import Detail, Result
from flexsc._scenario import Scenario
from flexsc._simulators import Simulators

__all__ = ["Beyond", "Quadratic", "SpacecraftEnv", "SpacecraftVectorEnv", "stable_baselines"]


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
            axis `believed.angle`) and `believed.rate`, each divided by its value in `observed`: the largest
            at the start of runs, or on the fastest way from there to the goal.
        reward: The reward of a step, computed from simulators and actions; if omitted, `Quadratic()`.
        terminate: Whether an episode has ended before its time; if omitted, never.
        metrics: The names of metrics of an episode that `info["metrics"]` has at its end; with `goal`,
            `info["is_success"]` says whether it is met. The run is repeated for them.
        render_mode: None is the only value: `result` has the log and the figures of an episode.

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
        metrics: Sequence[str] = (),
        render_mode: None = None,
    ) -> None:
        self._task = Task(
            scenario,
            dt,
            limit,
            observe,
            reward,
            terminate,
            metrics,
            lambda of_runs: Simulators._of_one(of_runs, 0),
        )
        self._quick = QuickStep.of(self._task)
        self.observation_space = self._task.observation_space
        self.action_space = self._task.action_space
        self.render_mode = render_mode

    @property
    def simulators(self) -> Simulators:
        """The simulator of the environment: one copy.

        >>> env = flexsc.gym.SpacecraftEnv("four-clamped-modes", dt=1.0, limit=1.0)
        >>> env.simulators.state["attitude"].shape
        (1, 4)
        """
        return self._task.simulators

    @property
    def observed(self) -> Observe:
        """The observation: names of quantities with the values by which they are divided, or a callable.

        >>> flexsc.gym.SpacecraftEnv("four-clamped-modes", dt=1.0, limit=1.0).observed
        {'believed.error': 1.4, 'believed.rate': 0.14}
        """
        return self._task.observed

    def result(self, log: Detail = "events") -> Result:
        """Return the present episode, until its next `reset`, as a result: metrics, columns, log and figures.

        The run is repeated under the commands of the episode.

        Args:
            log: The detail of the columns, as in `Scenario.simulate`.

        >>> env = flexsc.gym.SpacecraftEnv("four-clamped-modes", dt=1.0, limit=1.0)
        >>> start = env.reset(seed=1)
        >>> for _ in range(5):
        ...     told = env.step(env.action_space.sample())
        >>> env.result("full")["rates"]["time_s"][-1].item()
        5.0
        """
        return self._task.result(0, log)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Start an episode: the next of its seed, or with `options={"run": n}` the run with this number.

        >>> env = flexsc.gym.SpacecraftEnv("four-clamped-modes", dt=1.0, limit=1.0)
        >>> observation, info = env.reset(options={"run": 5})
        >>> info
        {'run': 5}
        """
        super().reset(seed=seed)
        run = _run(self.np_random)
        run = (options or {}).get("run", run)
        self._task.simulators.reset(runs=[run])
        return self._task.observe()[0], {"run": run}

    def step(self, action: npt.NDArray[Any]) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Hold a command for a step; return observation, reward, terminated, truncated and info.

        >>> env = flexsc.gym.SpacecraftEnv("four-clamped-modes", dt=1.0, limit=1.0)
        >>> start = env.reset(seed=1)
        >>> observation, reward, terminated, truncated, info = env.step([0.5, 0.0, -0.5])
        >>> reward < 0.0, terminated, truncated
        (True, False, False)

        Raises:
            ValueError: The action has another shape or is not finite.
            SimulationError: The run cannot go on.
        """
        if self._quick is not None:
            observation, reward, terminated, truncated = self._quick.step(action)
        else:
            rewards, terminations, truncations = self._task.step(np.asarray(action)[None], None)
            observation, reward = self._task.observe()[0], float(rewards[0])
            terminated, truncated = bool(terminations[0]), bool(truncations[0])
        info: dict[str, Any] = {}
        if self._task.metrics and (terminated or truncated):
            info = _with_success(self._task.metrics_of(0))
        return observation, reward, terminated, truncated, info


def _with_success(metrics: dict[str, Any]) -> dict[str, Any]:
    """The info of an episode that has ended: its metrics, and whether its goal is met."""
    goal = {"is_success": metrics["goal"] == "met"} if "goal" in metrics else {}
    return {"metrics": metrics, **goal}


class SpacecraftVectorEnv(VectorEnv[Observation, npt.NDArray[Any], npt.NDArray[Any]]):
    """Many `SpacecraftEnv` advanced together, on all cores.

    Copy i has, with seed s, the episodes of `SpacecraftEnv` with seed s + i.

    Args:
        scenario, dt, limit, observe, reward, terminate, metrics: As in `SpacecraftEnv`. In the mode
            `SameStep` the metrics are in `info["final_info"]`.
        num_envs: The number of environments.
        autoreset_mode: When the next episode starts. `NextStep`: in the step after the end of an episode.
            `SameStep`: in the step that ends the episode; `info["final_obs"]` has its last observation.
            `Disabled`: at `reset` with `options={"reset_mask": mask}`.
        jobs: Number of threads; if omitted, one per core.
        keep_commands: Whether the commands of episodes are kept, 40 bytes each, so that `result` can repeat
            them; with `metrics` they are.

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
        metrics: Sequence[str] = (),
        keep_commands: bool = False,
        render_mode: None = None,
    ) -> None:
        self.num_envs = num_envs
        keeps = keep_commands or bool(metrics)
        self._task = Task(
            scenario,
            dt,
            limit,
            observe,
            reward,
            terminate,
            metrics,
            lambda of_runs: Simulators(of_runs, num_envs, jobs, keep_commands=keeps),
        )
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
        """The simulators of the environments: one copy each.

        >>> envs = flexsc.gym.SpacecraftVectorEnv("four-clamped-modes", num_envs=8, dt=1.0, limit=1.0)
        >>> len(envs.simulators)
        8
        """
        return self._task.simulators

    @property
    def observed(self) -> Observe:
        """The observation: see `SpacecraftEnv.observed`.

        >>> flexsc.gym.SpacecraftVectorEnv("four-clamped-modes", num_envs=8, dt=1.0, limit=1.0).observed
        {'believed.error': 1.4, 'believed.rate': 0.14}
        """
        return self._task.observed

    def result(self, index: int, log: Detail = "events") -> Result:
        """Return the present episode of an environment as a result: see `SpacecraftEnv.result`.

        Args:
            index: The environment.
            log: The detail of the columns, as in `Scenario.simulate`.

        >>> options = {"num_envs": 8, "dt": 1.0, "limit": 1.0, "keep_commands": True}
        >>> envs = flexsc.gym.SpacecraftVectorEnv("four-clamped-modes", **options)
        >>> start = envs.reset(seed=1)
        >>> told = envs.step(envs.action_space.sample())
        >>> envs.result(3, "none").metrics["pointing_error_end_rad"] > 0.0
        True

        Raises:
            ValueError: The commands were not kept.
        """
        return self._task.result(index, log)

    def reset(
        self, *, seed: int | list[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Start episodes: all, or those of `options["reset_mask"]`.

        >>> envs = flexsc.gym.SpacecraftVectorEnv("four-clamped-modes", num_envs=8, dt=1.0, limit=1.0)
        >>> observations, info = envs.reset(seed=1)
        >>> observations.shape, info["run"].shape
        ((8, 6), (8,))
        """
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
        """Hold commands of shape (n, axes); return observations, rewards, terminations, truncations and info.

        >>> envs = flexsc.gym.SpacecraftVectorEnv("four-clamped-modes", num_envs=8, dt=1.0, limit=1.0)
        >>> start = envs.reset(seed=1)
        >>> observations, rewards, terminations, truncations, info = envs.step([[0.0, 0.0, 0.0]] * 8)
        >>> rewards.shape, truncations.any().item()
        ((8,), False)

        Raises:
            ValueError: The actions have another shape or are not finite, or episodes have ended and have to
                be reset.
            SimulationError: Runs cannot go on; the text names them.
        """
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
                final = self._metrics_of(ended)
                info = self._begin(ended)
                info |= {"final_obs": last, "_final_obs": ended, "final_info": final, "_final_info": ended}
        else:
            self._ended = ended
            info |= self._metrics_of(ended)
        return self._task.observe(), reward, terminated, truncated, info

    def _metrics_of(self, ended: Mask) -> dict[str, Any]:
        """The info about the metrics of episodes that have ended: an array for each, and which are set."""
        names = self._task.metrics
        if not names or not ended.any():
            return {}
        each = {index: self._task.metrics_of(index) for index in np.flatnonzero(ended).tolist()}
        arrays: dict[str, npt.NDArray[Any]] = {}
        for name in names:
            arrays[name] = np.full(self.num_envs, None, dtype=object)
            for index, metrics in each.items():
                arrays[name][index] = metrics[name]
        info: dict[str, Any] = {"metrics": arrays, "_metrics": ended.copy()}
        if "goal" in arrays:
            info |= {"is_success": arrays["goal"] == "met", "_is_success": ended.copy()}
        return info


def stable_baselines(
    scenario: Scenario | str,
    num_envs: int = 1,
    dt: float = 0.1,
    limit: npt.ArrayLike | None = None,
    observe: Observe | None = None,
    reward: Reward | None = None,
    terminate: Terminate | None = None,
    jobs: int | None = None,
    metrics: Sequence[str] = (),
    keep_commands: bool = False,
) -> Any:
    """Return many environments together as a `VecEnv` of Stable-Baselines3, which must be installed.

    It has the episodes of `SpacecraftVectorEnv`, whose arguments it takes, and the conventions of
    Stable-Baselines3: the next episode starts in the step that ends one, and the info of that step has
    `terminal_observation`, `TimeLimit.truncated`, and with `metrics` those of the episode and `is_success`.
    `venv.envs` is the `SpacecraftVectorEnv`.

    >>> venv = flexsc.gym.stable_baselines("four-clamped-modes", 16, dt=1.0, limit=1.0)  # doctest: +SKIP
    >>> model = stable_baselines3.PPO("MlpPolicy", venv).learn(20_000)                   # doctest: +SKIP

    Raises:
        ImportError: Stable-Baselines3 is not installed.
        ValueError: As in `SpacecraftEnv`.
    """
    from flexsc._stable_baselines import adapted

    envs = SpacecraftVectorEnv(
        scenario,
        num_envs,
        dt,
        limit,
        observe,
        reward,
        terminate,
        AutoresetMode.SAME_STEP,
        jobs,
        metrics,
        keep_commands,
    )
    return adapted(envs)


gymnasium.register(
    id="flexsc/Spacecraft-v0",
    entry_point="flexsc.gym:SpacecraftEnv",
    vector_entry_point="flexsc.gym:SpacecraftVectorEnv",
)
