"""Environments as a `VecEnv` of Stable-Baselines3."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from flexsc._named import library
from flexsc._numpy import np, npt

if TYPE_CHECKING:
    from flexsc.gym import SpacecraftVectorEnv


def adapted(envs: SpacecraftVectorEnv) -> Any:
    """Return environments that start their next episode in the same step as a `VecEnv`."""
    user, package = "flexsc.gym.stable_baselines", "stable-baselines3"
    vec_env = library("stable_baselines3.common.vec_env", user, package)
    kind: Any = type("StableBaselines", (_Methods, vec_env.VecEnv), {})
    return kind(envs)


class _Methods:
    """The methods of a `VecEnv`, which is imported only with Stable-Baselines3."""

    num_envs: int
    reset_infos: list[dict[str, Any]]
    _seeds: list[int | None]
    _options: list[dict[str, Any]]

    def __init__(self, envs: SpacecraftVectorEnv) -> None:
        self.envs = envs
        self._actions: npt.NDArray[Any] | None = None
        between: Any = super()
        between.__init__(envs.num_envs, envs.single_observation_space, envs.single_action_space)

    def reset(self) -> npt.NDArray[np.float32]:
        """Start the next episode of each environment; return observations of shape (n, numbers)."""
        seeded = any(seed is not None for seed in self._seeds)
        observations, info = self.envs.reset(seed=list(self._seeds) if seeded else None)
        self.reset_infos = [{"run": int(run)} for run in info["run"]]
        self._seeds = [None] * self.num_envs
        self._options = [{} for _ in range(self.num_envs)]
        return observations

    def step_async(self, actions: npt.NDArray[Any]) -> None:
        """Keep the actions for `step_wait`."""
        self._actions = actions

    def step_wait(
        self,
    ) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32], npt.NDArray[Any], list[dict[str, Any]]]:
        """Hold the actions for a step; return observations, rewards, ends of episodes and infos."""
        assert self._actions is not None
        observations, rewards, terminated, truncated, info = self.envs.step(self._actions)
        done = terminated | truncated
        infos: list[dict[str, Any]] = [{} for _ in range(self.num_envs)]
        for index in np.flatnonzero(done).tolist():
            infos[index] = {
                "terminal_observation": info["final_obs"][index],
                "TimeLimit.truncated": bool(truncated[index] and not terminated[index]),
            }
            self.reset_infos[index] = {"run": int(info["run"][index])}
            final = info["final_info"]
            if "metrics" in final:
                infos[index]["metrics"] = {name: of[index] for name, of in final["metrics"].items()}
            if "is_success" in final:
                infos[index]["is_success"] = bool(final["is_success"][index])
        return observations, rewards.astype(np.float32), done, infos

    def close(self) -> None:
        """Do nothing: there is nothing to close."""

    def get_attr(self, attr_name: str, indices: int | Sequence[int] | None = None) -> list[Any]:
        """Return an attribute of the environments, which is the same for each."""
        return [getattr(self.envs, attr_name)] * len(self._chosen(indices))

    def set_attr(self, attr_name: str, value: Any, indices: int | Sequence[int] | None = None) -> None:
        """Set an attribute of all environments."""
        setattr(self.envs, attr_name, value)

    def env_method(
        self, method_name: str, *args: Any, indices: int | Sequence[int] | None = None, **kwargs: Any
    ) -> list[Any]:
        """Call a method with the index of each environment, such as `result`."""
        return [getattr(self.envs, method_name)(index, *args, **kwargs) for index in self._chosen(indices)]

    def env_is_wrapped(
        self, wrapper_class: type[Any], indices: int | Sequence[int] | None = None
    ) -> list[bool]:
        """Return False for each: there are no wrappers."""
        return [False] * len(self._chosen(indices))

    def _chosen(self, indices: int | Sequence[int] | None) -> list[int]:
        if indices is None:
            return list(range(self.num_envs))
        return [indices] if isinstance(indices, int) else list(indices)
