"""Planned manoeuvres: what the plan comes to, its command as arrays, the field."""

import numpy as np
import pytest
from flexsc import Scenario, ScenarioError

TURN = {"angle": 1.5707963267948966, "time": 12.0, "command": {"sine": {"suppress": 1}}}


def turn(**manoeuvre: object) -> Scenario:
    mode = {"frequency": 3.330081535753227, "gain": 9.414365255919522}
    output = {"name": "phi4", "modes": [-2.1322537638298835]}
    return Scenario(
        {
            "duration": 20.0,
            "body": {"planar": {"inertia": 4616.67, "modes": [mode], "outputs": [output]}},
            "manoeuvre": {**TURN, **manoeuvre},
        }
    )


def test_a_plan_tells_what_the_command_tells() -> None:
    plan = turn().plan()
    np.testing.assert_allclose(plan["coefficients_nm"], [411.465238316, -190.087330099], rtol=1e-11)
    assert plan["residual_rad"]["phi4"] < 1e-14
    assert set(plan["residual_worst_rad"]) == {"angle", "phi4"}
    assert turn().plan(band=0.01)["residual_worst_rad"]["phi4"] < plan["residual_worst_rad"]["phi4"]
    assert repr(plan) == "<flexsc.Plan: 1.5708 rad in 12 s>"


def test_a_load_elsewhere_than_on_the_hub() -> None:
    shipped = Scenario.example("rotation-panel-torque")
    # By tests/golden/load_oracle.py, every 5 ms.
    assert shipped.plan()["peak_deflection_rad"] == pytest.approx(0.08971696456, rel=1e-5)
    at_hub = shipped.with_("manoeuvre.load", {"hub": 3.0})
    assert at_hub.plan()["peak_deflection_rad"] == pytest.approx(0.3048027468, rel=1e-9)
    assert turn(load={"rigid": 1.0, "modes": [0.0]}).plan()["peak_deflections_rad"]["angle"] == 0.0
    with pytest.raises(
        ScenarioError, match=r"`manoeuvre\.load\.sections` must have one number for each of 4"
    ):
        shipped.with_("manoeuvre.load", {"sections": [1.0]})


def test_the_command_over_time() -> None:
    plan = turn().plan()
    time = np.linspace(0.0, 12.0, 12_001)
    torque = plan.torque(time)
    sines = [np.sin(k * 2.0 * np.pi / 12.0 * time) for k in (1, 2)]
    np.testing.assert_allclose(torque, plan["coefficients_nm"] @ np.array(sines), atol=1e-9)
    assert abs(torque).max() == pytest.approx(plan["peak_torque_nm"], rel=1e-7)
    assert plan.torque([[1.0, -1.0], [12.0, 13.0]]).tolist() == [[plan.torque(1.0), 0.0], [0.0, 0.0]]


def test_the_field() -> None:
    rows = {row["command"]: row for row in turn().plan().compare()}
    assert rows["sine p=1"]["peak_torque_nm"] == pytest.approx(521.080754063, rel=1e-11)
    assert "sine p=2" not in rows
    slower = {row["command"]: row for row in turn().plan().compare(peak_torque=521.080754063)}
    assert slower["sine p=1"]["time_s"] == pytest.approx(12.0, rel=1e-11)


def test_what_cannot_be_planned() -> None:
    with pytest.raises(ScenarioError, match=r"manoeuvre.peak_torque.*at least 521.08.*got 500"):
        turn(peak_torque=500.0)
    with pytest.raises(ValueError, match="band must be between 0 and 1, got 2"):
        turn().plan(band=2.0)
    with pytest.raises(ValueError, match="peak_torque must be a positive number, got 0"):
        turn().plan().compare(peak_torque=0.0)
    bare = turn().to_dict()
    del bare["manoeuvre"]
    with pytest.raises(ValueError, match="no manoeuvre to plan"):
        Scenario(bare).plan()
