"""Environments: accepted by the checkers, many as each alone, ends of episodes, a study's table."""

import doctest
import subprocess
import sys
import warnings
from collections.abc import Iterator
from importlib import import_module
from types import ModuleType
from typing import Any

import flexsc
import numpy as np
import numpy.typing as npt
import pytest
from conftest import shipped
from test_stepping import UNCERTAIN

gymnasium = pytest.importorskip("gymnasium")

from flexsc.gym import (  # noqa: E402
    Beyond,
    Quadratic,
    SpacecraftEnv,
    SpacecraftVectorEnv,
    stable_baselines,
)
from gymnasium.utils.env_checker import check_env  # noqa: E402

UNBOUNDED = "ignore:.*A Box observation space m"


@pytest.fixture(scope="module")
def uncertain() -> flexsc.Scenario:
    return flexsc.Scenario(UNCERTAIN).with_("duration", 5.0)


@pytest.fixture
def one_angle() -> flexsc.Scenario:
    values = {"duration": 3.0, "law": {"open": {}}, "body": {"planar": {"inertia": 2.0, "angle": 1.0}}}
    return flexsc.Scenario(values)


@pytest.mark.filterwarnings(UNBOUNDED)
def test_gymnasium_accepts_them(uncertain: flexsc.Scenario, one_angle: flexsc.Scenario) -> None:
    check_env(SpacecraftEnv(uncertain), skip_render_check=True)
    check_env(SpacecraftEnv(one_angle, limit=1.0), skip_render_check=True)
    env = gymnasium.make("flexsc/Spacecraft-v0", scenario="four-clamped-modes", dt=1.0, limit=1.0)
    with warnings.catch_warnings():
        # Of what `make` wraps around it.
        warnings.simplefilter("ignore")
        check_env(env.unwrapped, skip_render_check=True)


@pytest.mark.filterwarnings("ignore")
def test_stable_baselines_accepts_them(uncertain: flexsc.Scenario) -> None:
    checker = pytest.importorskip("stable_baselines3.common.env_checker")
    checker.check_env(SpacecraftEnv(uncertain))


def test_an_episode_is_the_run_that_it_names(uncertain: flexsc.Scenario) -> None:
    env = SpacecraftEnv(uncertain, dt=0.25, observe={"measured.rate": 0.01, "state.modes": 1.0})
    first, info = env.reset(seed=4)
    again, other = env.reset()
    assert info["run"] != other["run"]
    assert not np.array_equal(first, again)
    observation, told = env.reset(seed=4)
    np.testing.assert_array_equal(observation, first)
    assert told == info
    run = info["run"]
    sim = flexsc.Simulator(uncertain.draw(run), run)
    action = np.array([0.3, -0.2, 1.0])
    for _ in range(20):
        observation, _, terminated, truncated, _ = env.step(action)
        sim.step(action * sim.command_limit, 0.25)
        expected = np.append(sim.measured["rate"] / 0.01, sim.state["modes"]).astype(np.float32)
        np.testing.assert_array_equal(observation, expected)
        assert not terminated
        assert truncated == sim.done
    assert sim.done
    observation, told = env.reset(options={"run": run})
    np.testing.assert_array_equal(observation, first)


@pytest.mark.parametrize("mode", ["NextStep", "SameStep", "Disabled"])
def test_many_are_what_each_is_alone(uncertain: flexsc.Scenario, mode: str) -> None:
    # Five seconds are seven steps; some end before, as their rate is too large.
    options: dict[str, Any] = {"dt": 0.8, "terminate": Beyond(rate=0.03), "reward": Quadratic(effort=0.5)}
    many = SpacecraftVectorEnv(uncertain, num_envs=6, autoreset_mode=mode, **options)
    each = [SpacecraftEnv(uncertain, **options) for _ in range(6)]
    observations, info = many.reset(seed=10)
    began = [env.reset(seed=10 + index) for index, env in enumerate(each)]
    np.testing.assert_array_equal(observations, [observation for observation, _ in began])
    np.testing.assert_array_equal(info["run"], [told["run"] for _, told in began])
    random = np.random.default_rng(5)
    ended = np.zeros(6, dtype=bool)
    ends, terminations = 0, 0
    told_all: Any = None
    for _ in range(30):
        actions = random.uniform(-1.2, 1.2, (6, 3)).astype(np.float32)
        if mode == "Disabled" and ended.any():
            observations, info = many.reset(options={"reset_mask": ended})
            for place in np.flatnonzero(ended):
                observation, told = each[place].reset()
                np.testing.assert_array_equal(observations[place], observation)
                assert info["run"][place] == told["run"]
            ended[:] = False
        told_all = many.step(actions)
        for index, env in enumerate(each):
            if mode == "NextStep" and ended[index]:
                observation, told = env.reset()
                expected: tuple[Any, ...] = (observation, 0.0, False, False)
                assert told_all[4]["run"][index] == told["run"]
                assert told_all[4]["_run"][index]
            else:
                expected = env.step(actions[index])[:4]
            ended[index] = expected[2] or expected[3]
            terminations += int(expected[2])
            ends += int(ended[index])
            if mode == "SameStep" and ended[index]:
                np.testing.assert_array_equal(told_all[4]["final_obs"][index], expected[0])
                assert told_all[4]["_final_obs"][index]
                expected = (env.reset()[0], *expected[1:])
            np.testing.assert_array_equal(told_all[0][index], expected[0])
            assert tuple(part[index] for part in told_all[1:4]) == expected[1:]
    assert ends > terminations > 0
    assert many.observation_space.contains(told_all[0])
    assert many.metadata["autoreset_mode"].value == mode


def test_episodes_end_by_time_or_by_what_happens(one_angle: flexsc.Scenario) -> None:
    env = SpacecraftEnv(one_angle, dt=1.0, limit=2.0, terminate=Beyond(error=3.0))
    env.reset(seed=0)
    # 1 rad/s² from 1 rad: 1.5, 3 and 5.5 rad.
    told = [env.step(np.ones(1))[2:4] for _ in range(3)]
    assert told == [(False, False), (False, False), (True, True)]
    env.reset()
    assert [env.step(np.zeros(1))[2:4] for _ in range(3)] == [(False, False)] * 2 + [(False, True)]
    envs = SpacecraftVectorEnv(one_angle, 2, 1.0, 2.0, autoreset_mode="Disabled")
    with pytest.raises(gymnasium.error.ResetNeeded):
        envs.step(np.zeros((2, 1)))
    envs.reset(seed=0)
    for _ in range(3):
        envs.step(np.zeros((2, 1)))
    with pytest.raises(ValueError, match="2 episodes have ended"):
        envs.step(np.zeros((2, 1)))


def test_rewards_and_observations_are_free(one_angle: flexsc.Scenario) -> None:
    env = SpacecraftEnv(
        one_angle,
        dt=1.0,
        limit=4.0,
        observe=lambda sims: np.stack([sims.time, sims.state["angle"]], axis=1),
        reward=lambda sims, actions: actions[:, 0] + 10.0 * sims.state["rate"],
    )
    assert env.reset(seed=0)[0].tolist() == [0.0, 1.0]
    observation, reward, *_ = env.step(np.array([0.5]))
    assert observation.tolist() == [1.0, 1.5]
    assert reward == 10.5
    default = SpacecraftEnv(one_angle, dt=1.0, limit=4.0)
    default.reset(seed=0)
    # 1.5 rad and 1 rad/s, each a tenth of which costs 1.
    assert default.step(np.array([0.5]))[1] == pytest.approx(-(225.0 + 100.0 + 0.01 * 0.25))


@pytest.mark.parametrize(
    "action",
    [
        np.array([0.3, -2.0, 1.5]),
        np.array([0.1, -0.7, 1e-3], dtype=np.float32),
        np.array([0.1, -0.7, 1.0], dtype=">f8"),
        np.array([0.1, 0.5, -0.2], dtype=np.float16),
        np.array([1, 0, -3]),
        [0.5, np.inf, -0.0],
    ],
)
def test_the_quick_step_is_the_usual_step(uncertain: flexsc.Scenario, action: Any) -> None:
    quick = SpacecraftEnv(uncertain, dt=0.3, terminate=Beyond(rate=0.02))
    # A reward of one's own is not known to be quadratic.
    usual = SpacecraftEnv(
        uncertain, dt=0.3, terminate=Beyond(rate=0.02), reward=lambda sims, given: Quadratic()(sims, given)
    )
    assert quick._quick is not None
    assert usual._quick is None
    np.testing.assert_array_equal(quick.reset(seed=3)[0], usual.reset(seed=3)[0])
    for _ in range(17):
        one, other = quick.step(action), usual.step(action)
        np.testing.assert_array_equal(one[0], other[0])
        assert one[0].dtype == other[0].dtype == np.float32
        assert one[1:] == other[1:]
        assert [type(part) for part in one[1:]] == [type(part) for part in other[1:]]


@pytest.mark.filterwarnings("ignore:divide by zero", "ignore:invalid value")
def test_a_scale_of_zero_is_divided_by(one_angle: flexsc.Scenario) -> None:
    env = SpacecraftEnv(one_angle, dt=1.0, limit=1.0, observe={"state.angle": 0.0})
    env.reset(seed=1)
    assert env.step(np.ones(1))[0].tolist() == [np.inf]


def test_an_action_that_is_not_a_number_is_refused(uncertain: flexsc.Scenario) -> None:
    env = SpacecraftEnv(uncertain)
    env.reset(seed=1)
    with pytest.raises(ValueError, match=r"finite numbers of N m, not so at \[0, 1\]"):
        env.step(np.array([0.0, np.nan, 0.0]))
    assert env.simulators.time == 0.0


def test_bad_arguments_are_told(uncertain: flexsc.Scenario, one_angle: flexsc.Scenario) -> None:
    with pytest.raises(ValueError, match=r"\(N m\), the actuator has none: give `limit`"):
        SpacecraftEnv(one_angle)
    with pytest.raises(ValueError, match="must name `state"):
        SpacecraftEnv(uncertain, observe={"rate": 1.0})
    with pytest.raises(KeyError, match="no quantity 'speed'"):
        SpacecraftEnv(uncertain, observe={"state.speed": 1.0})
    with pytest.raises(ValueError, match=r"observe must give an array of shape \(1, numbers\)"):
        SpacecraftEnv(uncertain, observe=lambda sims: np.zeros(3))
    with pytest.raises(TypeError, match="observe must map names to what they are divided by"):
        SpacecraftEnv(uncertain, observe=["state.rate"])  # type: ignore[arg-type]
    for kind in (SpacecraftEnv, SpacecraftVectorEnv):
        with pytest.raises(ValueError, match="render_mode must be None, as `result` has the figures"):
            kind(uncertain, render_mode="human")  # type: ignore[arg-type]
    with pytest.raises(FileNotFoundError):
        SpacecraftEnv("nowhere.toml")
    env = SpacecraftEnv(uncertain, reward=lambda sims, actions: np.zeros((1, 2)))
    with pytest.raises(NotImplementedError, match="`result` has its log and its figures"):
        env.render()
    env.reset(seed=0)
    with pytest.raises(ValueError, match=r"actions must have shape \(1, 3\)"):
        env.step(np.zeros(2))
    with pytest.raises(ValueError, match=r"reward must give an array of shape \(1,\)"):
        env.step(np.zeros(3))
    with pytest.raises(ValueError, match="there must be 2 seeds"):
        SpacecraftVectorEnv(uncertain, 2).reset(seed=[1])


def rodrigues(attitude: npt.NDArray[Any]) -> npt.NDArray[Any]:
    return attitude[:, 1:] / (1.0 + attitude[:, :1])


def test_the_law_of_a_study_as_an_agent() -> None:
    """Docs: four clamped modes under -30 p - 60 w, at most 1 N m, held for a second."""
    scenario = shipped("four-clamped-modes").with_("spacecraft.whole_damping", True)
    envs = SpacecraftVectorEnv(
        scenario,
        num_envs=3,
        dt=1.0,
        limit=1.0,
        observe=lambda sims: np.hstack([rodrigues(sims.state["attitude"]), sims.state["rate"]]),
    )
    envs.reset(seed=0)
    state = envs.simulators.state

    def rates() -> Iterator[float]:
        nonlocal state
        for _ in range(10):
            envs.step(-30.0 * rodrigues(state["attitude"]) - 60.0 * state["rate"])
            state = envs.simulators.state
            yield float(np.abs(state["rate"]).max())

    most = max(rates())
    # Of tests/golden/outside.csv, and the largest rate of its docs.
    np.testing.assert_allclose(
        rodrigues(state["attitude"]), [[0.1684178601, 0.01825439783, -0.1075669416]] * 3, rtol=1e-9
    )
    exact = [-0.08445766623, -0.01487397736, 0.06782833490]
    np.testing.assert_allclose(state["rate"], [exact] * 3, rtol=2e-9)
    assert most == pytest.approx(0.08445766623, rel=2e-9)


def test_the_examples_of_the_docstrings_run() -> None:
    module = import_module("flexsc.gym")
    told = doctest.testmod(module, extraglobs={"flexsc": flexsc})
    assert told.attempted > 8
    assert not told.failed


class _VecEnv:
    """The base class of Stable-Baselines3's vector environments: what its constructor does."""

    def __init__(self, num_envs: int, observation_space: Any, action_space: Any) -> None:
        self.num_envs, self.observation_space, self.action_space = num_envs, observation_space, action_space
        self.reset_infos: list[dict[str, Any]] = [{} for _ in range(num_envs)]
        self._seeds: list[int | None] = [None] * num_envs
        self._options: list[dict[str, Any]] = [{} for _ in range(num_envs)]
        self.render_mode = self.get_attr("render_mode")[0]

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        raise NotImplementedError


def stand_in() -> dict[str, Any]:
    """The modules of Stable-Baselines3 that are imported, with a class of its constructor only."""
    module: Any = ModuleType("stable_baselines3.common.vec_env")
    module.VecEnv = _VecEnv
    packages = ("stable_baselines3", "stable_baselines3.common")
    return {name: ModuleType(name) for name in packages} | {module.__name__: module}


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("library", ["a stand-in", "stable_baselines3"])
def test_episodes_of_stable_baselines_are_those_of_the_vector_environment(
    uncertain: flexsc.Scenario, monkeypatch: pytest.MonkeyPatch, library: str
) -> None:
    if library == "stable_baselines3":
        # In place of the stand-in where it is installed.
        pytest.importorskip(library)
    else:
        for name, module in stand_in().items():
            monkeypatch.setitem(sys.modules, name, module)
    venv = stable_baselines(uncertain, 3, dt=1.0, metrics=["goal"])
    envs = SpacecraftVectorEnv(uncertain, 3, dt=1.0, autoreset_mode="SameStep", metrics=["goal"])
    venv._seeds = [4, 5, 6]  # What `venv.seed(4)` does.
    expected, info = envs.reset(seed=4)
    np.testing.assert_array_equal(venv.reset(), expected)
    assert [each["run"] for each in venv.reset_infos] == info["run"].tolist()
    actions, infos = np.zeros((3, 3)), []
    for step in range(5):
        venv.step_async(actions)
        observations, rewards, done, infos = venv.step_wait()
        expected, expected_rewards, terminated, truncated, info = envs.step(actions)
        np.testing.assert_array_equal(observations, expected)
        np.testing.assert_array_equal(rewards, expected_rewards.astype(np.float32))
        assert done.tolist() == (terminated | truncated).tolist() == [step == 4] * 3
    for index, told in enumerate(infos):
        np.testing.assert_array_equal(told["terminal_observation"], info["final_obs"][index])
        assert told["TimeLimit.truncated"]
        assert told["metrics"]["goal"] == info["final_info"]["metrics"]["goal"][index]
        assert venv.reset_infos[index] == {"run": info["run"][index]}
    assert venv.get_attr("num_envs", 1) == [3]
    assert venv.env_is_wrapped(_VecEnv) == [False] * 3
    assert venv.env_method("result", "none", indices=[1])[0].metrics["goal"]


@pytest.mark.filterwarnings("ignore")
def test_stable_baselines_learns_and_wraps_them(uncertain: flexsc.Scenario) -> None:
    baselines = pytest.importorskip("stable_baselines3")
    vec_env = pytest.importorskip("stable_baselines3.common.vec_env")
    envs = stable_baselines(uncertain, 4, dt=0.5, metrics=["goal"])
    assert isinstance(envs, vec_env.VecEnv)
    envs.seed(4)
    first = envs.reset()
    monitored = vec_env.VecNormalize(vec_env.VecMonitor(envs))
    model = baselines.PPO("MlpPolicy", monitored, n_steps=16, batch_size=32, seed=4, device="cpu")
    model.learn(640)
    # Five seconds: each episode has ten steps.
    assert [episode["l"] for episode in model.ep_info_buffer] == [10] * 64
    assert np.isfinite([episode["r"] for episode in model.ep_info_buffer]).all()
    assert len(model.ep_success_buffer) == 64
    off_policy = baselines.SAC("MlpPolicy", envs, learning_starts=20, seed=4, device="cpu")
    off_policy.learn(60)
    envs.seed(4)
    np.testing.assert_array_equal(envs.reset(), first)


def test_stable_baselines_must_be_installed(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("stable_baselines3", "stable_baselines3.common.vec_env"):
        monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(ImportError, match=r"needs stable-baselines3: pip install stable-baselines3"):
        stable_baselines("four-clamped-modes", dt=1.0, limit=1.0)


def test_the_result_of_an_episode_is_that_of_its_commands(uncertain: flexsc.Scenario) -> None:
    env = SpacecraftEnv(uncertain, dt=1.0, metrics=["goal", "pointing_error_end_rad"])
    _, info = env.reset(seed=2)
    sim = flexsc.Simulator(uncertain.draw(info["run"]), info["run"])
    told: dict[str, Any] = {}
    for step in range(5):
        action = np.array([0.2, -0.1, 0.05]) * (-1.0) ** step
        *_, truncated, told = env.step(action)
        sim.step(action * sim.command_limit, 1.0)
        assert truncated == (step == 4)
    expected = sim.result("none").metrics
    assert env.result("none").metrics == expected
    assert told["metrics"] == {name: expected[name] for name in ("goal", "pointing_error_end_rad")}
    assert told["is_success"] == (expected["goal"] == "met")
    envs = SpacecraftVectorEnv(uncertain, 2, dt=1.0)
    envs.reset(seed=2)
    envs.step(np.zeros((2, 3)))
    with pytest.raises(ValueError, match="keep_commands"):
        envs.result(0)


def test_scales_are_those_of_the_fastest_way_to_the_goal() -> None:
    scenario = shipped("four-clamped-modes")
    observed = SpacecraftEnv(scenario, dt=1.0, limit=1.0).observed
    assert isinstance(observed, dict)
    sim = flexsc.Simulator(scenario)
    error, rate = np.linalg.norm(sim.state["error"]), np.linalg.norm(sim.state["rate"])
    # From the error at rest to rest at the goal: half the way at full torque, half against it.
    inertia = np.array(scenario.get("spacecraft.inertia"))
    slowest, fastest = 1.0 / np.linalg.eigvalsh(inertia)[[-1, 0]]
    assert set(observed) == {"believed.error", "believed.rate"}
    assert observed["believed.error"] >= 0.95 * error
    assert observed["believed.rate"] >= 0.95 * rate
    assert np.sqrt(error * slowest) / 2.0 < observed["believed.rate"] < 2.0 * np.sqrt(3.0 * error * fastest)


def test_a_copy_continues_as_its_original(uncertain: flexsc.Scenario) -> None:
    from copy import deepcopy

    env = SpacecraftEnv(uncertain, dt=0.5)
    env.reset(seed=3)
    actions = np.random.default_rng(1).uniform(-1.0, 1.0, (6, 3))
    for action in actions[:2]:
        env.step(action)
    tried = deepcopy(env)
    for action in actions[2:]:
        one, other = env.step(action), tried.step(action)
        assert one[0].tolist() == other[0].tolist()
        assert one[1:] == other[1:]
    assert tried.result().metrics == env.result().metrics
    # The next episode is the same too, and a step of one is none of the other.
    assert env.reset()[1] == tried.reset()[1]
    tried.step(actions[0])
    assert env.simulators.time == 0.0


def test_gymnasium_must_be_installed() -> None:
    code = "import sys; sys.modules['gymnasium'] = None; import flexsc.gym"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert "ModuleNotFoundError: flexsc.gym needs Gymnasium: pip install flexsc[gym]" in done.stderr
