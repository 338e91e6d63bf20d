"""Loops with a Kalman filter: its steady gain, its poles, and the motion of a run."""

from __future__ import annotations

from typing import Any

import flexsc
import numpy as np
import numpy.typing as npt
import pytest
from conftest import shipped
from scipy.linalg import solve_discrete_are

ANGLE = 1e-3
PLANAR = """
duration = 30.0
[law.pd]
k_p = 40.0
k_d = 250.0
period = 0.5
[sensor.sampled]
period = 0.5
[estimator.kalman]
angle_noise = 2e-5
moment_noise = 1e-8
feeds = "rigid"
[body.planar]
inertia = 250.0
angle = 1e-3
modes = [{ frequency = 1.3, gain = 0.4, damping = 0.01 }, { frequency = 4.0, gain = 0.2, damping = 0.005 }]
[log]
period = 0.5
"""


def poles(matrix: npt.NDArray[np.float64]) -> npt.NDArray[np.complex128]:
    return np.sort_complex(np.linalg.eigvals(matrix).astype(np.complex128))


def steady(scenario: flexsc.Scenario) -> tuple[Any, ...]:
    """F, H and the steady gain, by SciPy."""
    body = scenario.linearise(period=0.5)
    f, h = body.a, np.tile([[1.0, 0.0]], (1, len(body.a) // 2))
    push = scenario.linearise().b[:, 0] / scenario.linearise().b[1, 0]
    keys = scenario.to_dict()["estimator"]["kalman"]
    noise = keys["moment_noise"] * 0.5 * np.outer(push, push)
    r = np.array([[keys["angle_noise"] ** 2]])
    p = solve_discrete_are(f.T, h.T, noise, r)
    return f, h, p @ h.T / (h @ p @ h.T + r)


@pytest.mark.parametrize("feeds", ["rigid", "hub"])
@pytest.mark.parametrize("loop", ["command", "torque", "measurement"])
def test_the_poles_are_those_of_law_and_filter(feeds: str, loop: Any) -> None:
    scenario = flexsc.Scenario.parse(PLANAR).with_("estimator.kalman.feeds", feeds)
    closed = scenario.linearise(loop=loop).closed()
    f, h, gain = steady(scenario)
    # The separation principle: what the law gives to the true state, and what the filter errs.
    b = scenario.linearise(period=0.5).b
    read = np.eye(2, 6) if feeds == "rigid" else np.tile(np.eye(2), (1, 3))
    law = f - b @ np.array([[40.0, 250.0]]) @ read
    filtered = f @ (np.eye(6) - gain @ h)
    expected = np.concatenate([poles(law), poles(filtered), [0.0]])
    found = poles(closed.a)
    assert len(found) == len(expected)
    for pole in expected:
        assert np.abs(found - pole).min() < 1e-7
    names = [state.name for state in closed.states]
    assert "expected_rigid_rate" in names
    assert "expected_mode1_displacement" in names


@pytest.mark.parametrize("delay", [0.0, 0.5, 1.0])
def test_the_loop_moves_as_the_simulated_one(delay: float) -> None:
    # A filter that begins with the truth and knows the body stays with it, if it knows what acts, and when.
    # Of delays that are no whole periods it takes the mean torque.
    keys: dict[str, Any] = {}
    if delay > 0.0:
        keys = {"actuator": {"wheel": {"gain": 2.0, "delay": delay}}, "law.pd.k_p": 20.0, "law.pd.k_d": 125.0}
    scenario = flexsc.Scenario.parse(PLANAR).with_(keys | {"estimator.kalman.prior": "true"})
    closed = scenario.linearise(loop="command").closed()
    names = [state.name for state in closed.states]
    state = np.zeros(len(names))
    state[0] = state[names.index("expected_rigid_angle")] = ANGLE
    motion = []
    for _ in range(61):
        motion.append(state[[0, 2, 4]].sum())
        state = closed.a @ state
    run = scenario.simulate(log="full")["attitude"]
    _, first = np.unique(run["time_s"], return_index=True)
    np.testing.assert_allclose(run["angle_rad"][first], motion, atol=1e-9 * ANGLE, rtol=0)


@pytest.mark.parametrize("delay", [0.2, 0.7])
def test_the_breaks_of_a_delayed_loop_close_to_the_same(delay: float) -> None:
    wheel = {"wheel": {"gain": 2.0, "delay": delay}}
    scenario = flexsc.Scenario.parse(PLANAR).with_(
        {"actuator": wheel, "law.pd.k_p": 20.0, "law.pd.k_d": 125.0}
    )
    late = np.abs(scenario.linearise(loop="command").closed().eigenfrequencies())
    breaks: tuple[Any, ...] = ("torque", "measurement")
    for loop in breaks:
        closed = scenario.linearise(loop=loop).closed()
        np.testing.assert_allclose(closed.eigenfrequencies(), late, rtol=1e-5)


def test_a_filter_without_a_steady_gain_is_refused() -> None:
    scenario = flexsc.Scenario.parse(PLANAR)
    with pytest.raises(flexsc.ScenarioError, match="do not settle: give it `moment_noise`"):
        scenario.with_("estimator.kalman.moment_noise", 0.0).linearise(loop="command")
    with pytest.raises(flexsc.ScenarioError, match=r"attitude\.elastic: is not supported"):
        shipped("flexible-boom").linearise(loop="command")
    # One that is only assessed is no part of the loop.
    watched = scenario.with_("estimator.kalman.watch_only", True).linearise(loop="command")
    assert len(watched.states) == 7
