"""Many environments of a scenario that are advanced together."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import gymnasium
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from flexsc._episodes import Mask, Observation, Observe, Reward, Task, Terminate, drawn_run
from flexsc._numpy import np, npt
from flexsc._result import Detail, Result
from flexsc._scenario import Scenario
from flexsc._simulators import Simulators


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
        jobs: Number of threads; 0, or if omitted, one per core.
        keep_commands: Whether the commands of episodes are kept, 64 bytes each, so that `result` can repeat
            them; with `metrics` they are.

    >>> envs = flexsc.gym.SpacecraftVectorEnv("four-clamped-modes", num_envs=100, dt=1.0, limit=1.0)
    >>> observations, info = envs.reset(seed=1)
    >>> envs.step(envs.action_space.sample())[1].shape
    (100,)
    """

    metadata: dict[str, Any] = {"render_modes": [], "autoreset_mode": AutoresetMode.NEXT_STEP}  # noqa: RUF012
    """Render modes, of which there are none, and when the next episode starts, for Gymnasium.

    >>> envs.metadata["autoreset_mode"].value
    'NextStep'
    """

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
            render_mode,
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
            runs[index] = drawn_run(self._randoms[index])
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
