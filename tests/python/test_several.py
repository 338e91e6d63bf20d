"""Several actuators: from parts, with own parts among them, stepped, swept, and as a linear loop."""

from __future__ import annotations

import flexsc
import numpy as np
import numpy.typing as npt
import pytest
from flexsc.scenario import Assigned, AttitudeLaw, Ideal, NamedPoint, Planar, Spatial, Wheels
from flexsc.scenario import Wheel as Flywheel
from own import Servo

PLANAR = """
duration = 50.0
law = { pd = { k_p = 4.0, k_d = 30.0, period = 0.25 } }
sensor = { sampled = { period = 0.25 } }
[body.planar]
inertia = 100.0
angle = 2e-3
modes = [{ frequency = 1.3, gain = 0.2, damping = 0.02 }]
[log]
period = 0.25
[[actuator]]
ideal = {}
share = 0.4
[[actuator]]
wheel = { gain = 1.0 }
share = 0.6
"""
ONE = PLANAR[: PLANAR.index("[[actuator]]")]


def angles(scenario: flexsc.Scenario) -> npt.NDArray[np.float64]:
    return np.asarray(scenario.simulate(log="full")["attitude"]["angle_rad"])


def test_typed_parts_make_a_list() -> None:
    scenario = flexsc.Scenario(
        duration=10.0,
        body=Planar(inertia=100.0, angle=1e-3),
        law=AttitudeLaw(period=0.25, bandwidth=0.3),
        actuator=[Assigned(ideal=Ideal(), share=0.25), Assigned(wheel=Flywheel(gain=1.0), share=0.75)],
    )
    assert scenario.to_dict()["actuator"][1]["share"] == 0.75
    assert scenario.with_("actuator[0].share", 0.25) == scenario
    with pytest.raises(
        flexsc.ScenarioError, match=r"`actuator\[1\].share` must sum to 1 with the others, got 1.5"
    ):
        scenario.with_("actuator[0].share", 0.75)
    spatial = flexsc.Scenario(
        duration=10.0,
        body=Spatial(
            inertia=np.diag([30.0, 40.0, 35.0]), points=[NamedPoint(name="hub")], rate=[1e-3, 0.0, 2e-3]
        ),
        law=AttitudeLaw(period=0.25, bandwidth=0.3),
        actuator=[
            Assigned(wheels=Wheels(arrangement="orthogonal", inertia=0.02), axes=["roll", "pitch"]),
            Assigned(ideal=Ideal(), axes=["yaw"]),
        ],
    )
    assert spatial.simulate().metrics["pointing_error_end_rad"] < 1e-3


def test_shares_are_one_actuator() -> None:
    np.testing.assert_allclose(
        angles(flexsc.Scenario.parse(PLANAR)), angles(flexsc.Scenario.parse(ONE)), rtol=0, atol=1e-17
    )


def test_steps_go_through_the_list() -> None:
    motions = []
    for text in (PLANAR, ONE):
        simulator = flexsc.Simulator(flexsc.Scenario.parse(text))
        assert simulator.command_unit == "N m"
        for number in range(40):
            simulator.step(0.01 * np.sin(number), 0.25)
        motions.append([np.array(simulator.state[name]) for name in ("angle", "rate")])
    np.testing.assert_allclose(motions[0], motions[1], rtol=1e-12)


def test_an_own_actuator_has_a_place() -> None:
    scenario = flexsc.Scenario.parse(PLANAR)
    mixed = scenario.with_parts(actuator={1: Servo(1e6, 1e-12, 0.05)})
    assert list(mixed.own_parts) == ["actuator 1"]
    assert mixed.to_dict()["actuator"][1]["share"] == 0.6
    off = np.max(np.abs(angles(mixed) - angles(scenario)))
    # It is late by 0.05 s.
    assert 1e-9 < off < 1e-4
    again = mixed.with_("duration", 20.0)
    assert list(again.own_parts) == ["actuator 1"]
    with pytest.raises(
        flexsc.ScenarioError, match=r"actuator\[2\]: is not there: the scenario has 2 actuators"
    ):
        scenario.with_parts(actuator={2: Servo(1e6, 1e-12, 0.05)})


def test_linear_loops_have_the_sum_of_the_shares() -> None:
    several, one = (flexsc.Scenario.parse(text).linearise(loop="command") for text in (PLANAR, ONE))
    np.testing.assert_allclose(several.b, one.b, rtol=1e-14)
    stronger = flexsc.Scenario.parse(PLANAR).with_("actuator[1].wheel.gain", 2.0).linearise(loop="command")
    np.testing.assert_allclose(
        stronger.closed().a, one.closed().a + 0.6 * (one.closed().a - one.a), rtol=1e-9
    )
    late = flexsc.Scenario.parse(PLANAR).with_("actuator[1].wheel.delay", 0.1)
    with pytest.raises(ValueError, match="actuator: has different delays"):
        late.linearise(loop="command")
    held = flexsc.Scenario.parse(PLANAR.replace("ideal = {}", "hold = { period = 0.25 }"))
    with pytest.raises(ValueError, match=r"actuator.*hold: is not linear"):
        held.linearise(loop="command")


def test_keys_of_a_list_are_swept_and_uncertain() -> None:
    uncertain = '[uncertain]\n"actuator[1].wheel.gain" = { uniform = [0.8, 1.2] }\n'
    scenario = flexsc.Scenario.parse(PLANAR + uncertain)
    table = flexsc.campaign(scenario, runs=3)
    assert len(set(table["actuator[1].wheel.gain"])) == 3
