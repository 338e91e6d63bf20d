"""Rotations against direct integration of the generalised coordinates by SciPy."""

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from conftest import shipped
from scipy.integrate import solve_ivp

# The matrices of [Rotation]'s example, from its data in exact decimals: q = [theta, v1, v2, v3, v4].
M = np.array(
    [
        [4616.67, 75.0, 137.5, 200.0, 177.5],
        [75.0, 20.0, 2.5, 0.0, 0.0],
        [137.5, 2.5, 20.0, 2.5, 0.0],
        [200.0, 0.0, 2.5, 20.0, 2.5],
        [177.5, 0.0, 0.0, 2.5, 15.0],
    ]
)
K = np.zeros((5, 5))
K[1:, 1:] = [
    [4160, -2560, 640, 0],
    [-2560, 3840, -2560, 640],
    [640, -2560, 3200, -1280],
    [0, 640, -1280, 640],
]
LENGTH = 2.5


def integrate(field: Any, breaks: list[float], t: npt.NDArray[Any], start: Any) -> npt.NDArray[Any]:
    """A solution at the times t, restarted where the torque breaks."""
    states, state, begin = [], start, 0.0
    for end in [*breaks, t[-1]]:
        inside = t[(t >= begin) & ((t < end) | (end == t[-1]))]
        at = np.unique(np.append(inside, end))
        run = solve_ivp(field, (begin, end), state, method="DOP853", rtol=3e-14, atol=1e-16, t_eval=at)
        states.append(run.y[:, : len(inside)])
        state, begin = run.y[:, -1], end
    return np.hstack(states)


def linear(torque: Any, breaks: list[float], t: npt.NDArray[Any]) -> npt.NDArray[Any]:
    inverse = np.linalg.inv(M)

    def field(time: float, y: Any) -> Any:
        return np.concatenate([y[5:], inverse @ (np.array([torque(time), 0, 0, 0, 0]) - K @ y[:5])])

    return integrate(field, breaks, t, np.zeros(10))


@pytest.mark.parametrize("name", ["rotation-sine", "rotation-cosine", "rotation-spin-up"])
def test_the_exact_response_is_that_of_the_generalised_coordinates(name: str) -> None:
    scenario = shipped(name)
    run = scenario.simulate(log="full")
    plan = scenario.plan()
    t = run["attitude"]["time_s"]
    assert t[-1] == 32.0
    exact = linear(lambda time: float(plan.torque(np.array([time]))[0]) if time < 12.0 else 0.0, [12.0], t)
    v = np.vstack([np.zeros_like(t), exact[1:5]])
    np.testing.assert_allclose(run["attitude"]["angle_rad"], exact[0], rtol=0, atol=1e-10)
    np.testing.assert_allclose(run["rate"]["rate_rad_s"], exact[5], rtol=0, atol=1e-10)
    sections = np.diff(v, axis=0).T / LENGTH
    np.testing.assert_allclose(run["outputs"]["outputs.value"], sections, rtol=0, atol=1e-10)


def test_the_exact_chain_is_that_of_finite_angles() -> None:
    scenario = shipped("rotation-nonlinear").with_("duration", 16.0)
    run = scenario.simulate(log="full")
    plan = scenario.plan()
    to_nodes = np.zeros((5, 5))
    to_nodes[0, 0] = 1.0
    for k in range(1, 5):
        to_nodes[k, 1 : k + 1] = LENGTH
        to_nodes[k, 0] = -k * LENGTH
    a, stiffness = to_nodes.T @ M @ to_nodes, to_nodes.T @ K @ to_nodes

    def field(time: float, y: Any) -> Any:
        psi, rate = y[:5], y[5:]
        difference = psi[:, None] - psi[None, :]
        torque = float(plan.torque(np.array([time]))[0]) if time < 12.0 else 0.0
        force = np.array([torque, 0, 0, 0, 0]) - stiffness @ psi - (a * np.sin(difference)) @ rate**2
        return np.concatenate([rate, np.linalg.solve(a * np.cos(difference), force)])

    t = run["attitude"]["time_s"]
    exact = integrate(field, [12.0], t, np.zeros(10))
    np.testing.assert_allclose(run["attitude"]["angle_rad"], exact[0], rtol=0, atol=2e-9)
    sections = (exact[1:5] - exact[0]).T
    np.testing.assert_allclose(run["outputs"]["outputs.value"], sections, rtol=0, atol=2e-9)
