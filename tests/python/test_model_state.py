"""States of linear models at the states of runs: model and run go on side by side."""

from __future__ import annotations

from typing import Any

import flexsc
import numpy as np
import numpy.typing as npt
import pytest
from conftest import shipped

PERIOD = 0.25


def alone(name: str, changes: dict[str, Any]) -> flexsc.Scenario:
    """A shipped body under external commands, without what its linear model leaves out."""
    keys = shipped(name).to_dict()
    for key in ("estimator", "manoeuvre", "disturbance", "uncertain", "reference", "drift", "target"):
        keys.pop(key, None)
    keys.get("spacecraft", {}).pop("attitude", None)
    # Linear models have the whole damping matrix, and small angles modes that damping does not couple.
    craft = keys.get("spacecraft", {})
    if "small_angles" in craft:
        for mode in (mode for appendage in keys["appendage"] for mode in appendage["modes"]):
            mode["damping"] = 0.0
    elif craft:
        craft["whole_damping"] = True
    keys |= {"duration": 1000.0, "law": {"open": {}}, "sensor": "continuous"}
    return flexsc.Scenario(keys | changes, name)


def beside(scenario: flexsc.Scenario, size: float, delay: float | None = None) -> npt.NDArray[np.float64]:
    """The largest differences between model and run in 50 steps, and the largest values, by state."""
    sim, rng = flexsc.Simulator(scenario), np.random.default_rng(11)
    model = scenario.linearise(period=PERIOD, delay=delay)
    torques = size * rng.normal(size=(70, sim.axes))
    for torque in torques[:20]:
        sim.step(torque, PERIOD)
    x = model.state_of(sim)
    assert x.shape == (len(model.states),)
    differences, values = [], []
    for torque in torques[20:]:
        sim.step(torque, PERIOD)
        x = model.a @ x + model.b @ torque
        there = model.state_of(sim)
        differences.append(np.abs(x - there))
        values.append(np.abs(there))
    return np.array([np.max(differences, axis=0), np.max(values, axis=0)])


@pytest.mark.parametrize(
    ("name", "changes"),
    [
        ("relay-sampled", {}),
        ("rotation-robust", {}),
        ("rotation-kinematic", {}),
        ("relay-wheel", {}),
        ("slew-wheel-lqg", {}),
        ("relay-wheel", {"actuator.wheel.delay": 0.1}),
        ("slew-wheel-lqg", {"actuator.wheel.delay": 0.2}),
    ],
)
def test_one_axis_is_linear(name: str, changes: dict[str, Any]) -> None:
    scenario = alone(name, {}).with_(changes) if changes else alone(name, {})
    difference, value = beside(scenario, 1e-3)
    assert (difference <= 1e-11 * value).all()


def at_bench(**more: Any) -> dict[str, Any]:
    return {"sensor": [{"sampled": {"period": PERIOD, "point": "bench"}}], **more}


WHEELS = shipped("earth-observer").to_dict()["actuator"]


@pytest.mark.parametrize(
    ("name", "changes", "size"),
    [
        ("four-clamped-modes", {}, 0.01),
        ("earth-observer", {}, 0.01),
        ("earth-observer", at_bench(), 0.01),
        # Wheels that store momentum couple the axes.
        (
            "earth-observer",
            {"actuator": {"wheels": WHEELS["wheels"] | {"speeds": [300.0, 100.0, 250.0, 50.0]}}},
            0.01,
        ),
        # The first sensor is on the boom.
        ("flexible-boom", {"sensor": [{"sampled": {"period": PERIOD, "point": "head"}}]}, 0.003),
    ],
)
def test_three_axes_are_linear_up_to_the_second_order(
    name: str, changes: dict[str, Any], size: float
) -> None:
    scenario = alone(name, changes)
    large, value = beside(scenario, size)
    small, _ = beside(scenario, size / 2)
    assert (large[:6] < 5e-3 * value[:6]).all()
    # By symmetry some differences are of higher order, and smaller than the rounding of a run.
    clear = large > 1e-7 * value
    assert clear.mean() > 0.8
    np.testing.assert_allclose((large / small)[clear], 4.0, rtol=0.05)


def test_small_angles_are_linear() -> None:
    difference, value = beside(alone("relays-three-axes", {}), 1e-3)
    assert (difference <= 1e-11 * value).all()


def test_many_runs_have_a_row_each() -> None:
    scenario = shipped("half-turn").with_({"law": {"open": {}}})
    sims, model = flexsc.Simulators(scenario, 3), scenario.linearise()
    sims.step(np.full((3, 3), 0.02), 2.0)
    states = model.state_of(sims)
    assert states.shape == (3, len(model.states))
    for copy, state in enumerate(states):
        # Each copy has the modes of its own draw.
        np.testing.assert_array_equal(state, model.state_of(sims[copy]))
    assert np.abs(states[0] - states[1]).max() > 1e-5
    one = alone("relay-sampled", {})
    many = flexsc.Simulators(one, 4)
    many.step(np.full(4, 1e-3), 1.0)
    assert one.linearise().state_of(many).shape == (4, 12)


def test_what_a_simulator_does_not_have_is_named() -> None:
    scenario = shipped("earth-observer")
    opened, sim = scenario.linearise(loop="command"), flexsc.Simulator(scenario)
    with pytest.raises(ValueError, match=r"does not have the states expected_roll, .*gyro_roll"):
        opened.state_of(sim)
    body = alone("relay-wheel", {})
    with pytest.raises(ValueError, match="does not have the states torque_1_ago, torque_2_ago of"):
        body.linearise(period=PERIOD, delay=0.4).state_of(flexsc.Simulator(body))
    with pytest.raises(ValueError, match="rigid_angle"):
        body.linearise().state_of(sim)
