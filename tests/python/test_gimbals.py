"""Control moment gyros in Python: typed parts, figures of the log, steering by hand, linear models."""

from typing import Any

import flexsc
import numpy as np
import numpy.typing as npt
import pytest
from conftest import shipped
from flexsc.scenario import (
    AttitudeLaw,
    ControlMomentGyros,
    LogContents,
    NamedPoint,
    NullMotion,
    Spacecraft,
    Target,
)

Array = npt.NDArray[np.float64]


def pyramid(cant: float, angles: Array) -> Array:
    """Return the directions in which gimbals change the momentum, by columns."""
    faces = np.array([[1.0, 0], [0, 1], [-1, 0], [0, -1]])
    spin = np.stack([-faces[:, 1], faces[:, 0], np.zeros(4)], 1)
    across = np.stack([-np.cos(cant) * faces[:, 0], -np.cos(cant) * faces[:, 1], np.full(4, np.sin(cant))], 1)
    directions: Array = across * np.cos(angles)[:, None] - spin * np.sin(angles)[:, None]
    return directions.T


def gyros(**keys: Any) -> ControlMomentGyros:
    return ControlMomentGyros(arrangement="pyramid", cant=0.9, momentum=6.0, **keys)


def scenario(actuator: ControlMomentGyros) -> flexsc.Scenario:
    return flexsc.Scenario(
        duration=20.0,
        spacecraft=Spacecraft(
            mass=100.0, inertia=np.diag([30.0, 40.0, 35.0]).tolist(), points=[NamedPoint(name="hub")]
        ),
        law=AttitudeLaw(period=0.1, bandwidth=0.6),
        target=[Target(from_=0.0, roll=0.1, pitch=-0.1, yaw=0.2)],
        actuator=actuator,
        log=LogContents(period=0.1),
    )


def test_rates_are_those_of_the_pseudo_inverse() -> None:
    run = scenario(gyros(steering="pseudo_inverse")).simulate(log="full")
    topic = run["control_moment_gyros"]
    assert topic.unit("gyros.angle_rad") == "rad"
    angles, rates = topic["gyros.angle_rad"], topic["gyros.rate_rad_s"]
    asked = run["torques"]["axes.feedback_nm"]
    for row in range(0, len(angles) - 1, 10):
        by_hand = np.linalg.pinv(pyramid(0.9, angles[row])) @ (-asked[row] / 6.0)
        np.testing.assert_allclose(rates[row], by_hand, rtol=0, atol=1e-12)
    measure = [np.sqrt(np.linalg.det(a @ a.T)) for a in (pyramid(0.9, row) for row in angles)]
    np.testing.assert_allclose(topic["singularity"], measure, rtol=0, atol=1e-12)
    assert run.metrics["singularity_min"] == pytest.approx(min(measure), abs=1e-9)
    assert run.metrics["gimbal_rate_peak_rad_s"] >= np.abs(rates).max()


def test_null_motion_brings_gimbals_back() -> None:
    preferred = [0.4, -0.4, 0.4, -0.4]
    null = NullMotion(angles=preferred, gain=0.5)
    away = scenario(gyros()).simulate(log="full")["control_moment_gyros"]["gyros.angle_rad"][-1]
    near = scenario(gyros(null_motion=null)).simulate(log="full")["control_moment_gyros"]["gyros.angle_rad"][
        -1
    ]
    assert np.linalg.norm(near - preferred) < 0.5 * np.linalg.norm(away - preferred)


def test_the_body_is_linear_and_the_loop_is_refused() -> None:
    turned = scenario(gyros(angles=[0.5, 0.0, -0.5, 0.0]))
    model = turned.linearise()
    # What the rotors store couples the axes: J w' = h x w.
    stored = 6.0 * np.array([2 * -np.cos(0.9) * np.sin(0.5), 0.0, 0.0])
    coupled = np.linalg.solve(np.diag([30.0, 40.0, 35.0]), np.cross(stored, np.eye(3)).T)
    np.testing.assert_allclose(model.a[3:6, 3:6], coupled, atol=1e-12)
    with pytest.raises(ValueError, match="control_moment_gyros: is not linear"):
        turned.linearise(loop="command")


def test_uncertain_keys_and_steps() -> None:
    uncertain = shipped("agile-observer").with_("duration", 2.0)
    drawn = uncertain.with_(
        "uncertain", {"actuator.control_moment_gyros.momentum": {"normal": {"mean": 15.0, "sd": 1.0}}}
    )
    table = flexsc.campaign(drawn, runs=3)
    assert len(set(table["gimbal_rate_peak_rad_s"])) == 3
    steps = flexsc.Simulator(uncertain)
    for _ in range(5):
        steps.step(np.zeros(3), dt=0.1)
    assert steps.state["gimbal_angles"].shape == (4,)
