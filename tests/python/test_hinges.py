"""Appendages on hinges in Python: typed parts, topics and states, campaigns, linear models."""

import flexsc
import numpy as np
import pytest
from conftest import shipped
from flexsc.scenario import Appendage, Hinge, LogContents, NamedPoint, Open, Spacecraft


def swinging(angle: float, hub: float = 1e9) -> flexsc.Scenario:
    panel = Appendage(
        name="panel",
        mass=12.0,
        centre=[0.0, 1.5, 0.0],
        inertia=np.diag([9.0, 1.0, 10.0]).tolist(),
        at=[0.0, 0.5, 0.0],
        hinge=Hinge(about=[1, 0, 0], stiffness=20.0, damping=1.5, angle=angle),
    )
    return flexsc.Scenario(
        duration=30.0,
        spacecraft=Spacecraft(mass=hub, inertia=np.diag([hub] * 3).tolist(), points=[NamedPoint(name="hub")]),
        appendage=[panel],
        law=Open(),
        log=LogContents(period=0.5),
    )


def test_a_panel_swings_on_a_heavy_hub_as_an_oscillator() -> None:
    topic = swinging(0.8).simulate(log="full")["hinges"]
    assert topic.unit("hinges.angle_rad") == "rad"
    inertia = 9.0 + 12.0 * 1.5**2
    w, decay = np.sqrt(20.0 / inertia), 0.5 * 1.5 / inertia
    v, t = np.sqrt(w**2 - decay**2), topic["time_s"]
    exact = 0.8 * np.exp(-decay * t) * (np.cos(v * t) + decay / v * np.sin(v * t))
    np.testing.assert_allclose(topic["hinges.angle_rad"][:, 0], exact, rtol=0, atol=1e-6)


def test_steps_have_angles_and_rates() -> None:
    steps = flexsc.Simulator(swinging(0.3, hub=100.0))
    steps.step(np.zeros(3), dt=2.0)
    assert steps.state["hinge_angles"].shape == (1,)
    assert abs(steps.state["hinge_rates"][0]) > 0.01


def test_hinges_may_be_uncertain_and_have_linear_modes() -> None:
    drawn = (
        shipped("panel-deployment")
        .with_("duration", 20.0)
        .with_("uncertain", {"appendage[0].hinge.stiffness": {"relative_uniform": 0.1}})
    )
    table = flexsc.campaign(drawn, runs=3)
    assert len(set(table["pointing_error_end_rad"])) == 3
    poles = np.linalg.eigvals(swinging(0.0).linearise().a)
    swings = poles[np.abs(poles) > 0.1]
    inertia = 9.0 + 12.0 * 1.5**2
    assert np.abs(swings) == pytest.approx(np.sqrt(20.0 / inertia), rel=1e-6)
