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
from copy import deepcopy
from typing import Any, NoReturn

try:
    import gymnasium
except ModuleNotFoundError as error:
    raise ModuleNotFoundError(f"flexsc.gym needs Gymnasium: pip install flexsc[gym] ({error})") from error
from gymnasium.vector import AutoresetMode

from flexsc._episodes import (
    Beyond,
    Observation,
    Observe,
    Quadratic,
    QuickStep,
    Reward,
    Task,
    Terminate,
    drawn_run,
    with_success,
)
from flexsc._numpy import np, npt
from flexsc._result import Detail, Result
from flexsc._scenario import Scenario
from flexsc._simulators import Simulators
from flexsc._vector_env import SpacecraftVectorEnv

__all__ = ["Beyond", "Quadratic", "SpacecraftEnv", "SpacecraftVectorEnv", "stable_baselines"]


class SpacecraftEnv(gymnasium.Env[Observation, npt.NDArray[Any]]):
    """A scenario as an environment: an agent acts in place of its law.

    Each episode is a separate run of the scenario, with new noise and newly drawn `[uncertain]` keys. Its run
    number follows from the seed and is `info["run"]`. An episode is truncated at the end of the scenario's
    `duration`.

    Args:
        scenario: The scenario, the name of a shipped one, or the path of a file `.toml`. Its `[law]` is not
            used.
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
            render_mode,
        )
        self._given = (scenario, dt, limit, self._task.observed, reward, terminate, metrics)
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

    def render(self) -> NoReturn:
        """Raise an error: `result` has the figures of an episode.

        >>> env = flexsc.gym.SpacecraftEnv("four-clamped-modes", dt=1.0, limit=1.0)
        >>> start = env.reset(seed=1)
        >>> env.result().svg()[:4]
        '<svg'
        """
        raise NotImplementedError("an episode has no frames: `result` has its log and its figures")

    def __deepcopy__(self, memo: dict[int, Any]) -> SpacecraftEnv:
        """Return an environment in the same state, as searches of trees of actions need it."""
        other = SpacecraftEnv(*deepcopy(self._given, memo))
        other._task.simulators.restore(self._task.simulators.snapshot())
        other._np_random = deepcopy(self._np_random, memo)
        other._np_random_seed = self._np_random_seed
        return other

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
        run = drawn_run(self.np_random)
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
            info = with_success(self._task.metrics_of(0))
        return observation, reward, terminated, truncated, info


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


for _class in (Beyond, Quadratic, SpacecraftVectorEnv):
    _class.__module__ = __name__

gymnasium.register(
    id="flexsc/Spacecraft-v0",
    entry_point="flexsc.gym:SpacecraftEnv",
    vector_entry_point="flexsc.gym:SpacecraftVectorEnv",
)
