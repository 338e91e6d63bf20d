"""Requirements over time: as parts of a scenario, as a number for optimisers, and against rtamt on rows."""

import math

import flexsc
import numpy as np
import pytest

WAVE = """
name = "wave"
duration = 60.0
log.period = 0.05
[body.planar]
angle = 1e-4
modes = [{ frequency = 2.13, gain = 1.0, displacement = 3e-4, damping = 0.002 }]
[sensor.sampled]
period = 10.0
[law.open]
"""
FORMULAS = {
    "always[10, 60] pointing_error < 5e-4": ("always[10:60](e < 0.0005)", 5e-4),
    "eventually[0, 20] always[0, 1] pointing_error < 3e-4": (
        "eventually[0:20](always[0:1](e < 0.0003))",
        3e-4,
    ),
}


def judged() -> flexsc.Result:
    wanted = [flexsc.requirement(text) for text in FORMULAS]
    scenario = flexsc.Scenario.parse(WAVE).with_("requirement", wanted)
    return scenario.simulate(log="full")


def test_robustness_is_a_number() -> None:
    answer = judged().answer
    assert all(0 < answer.robustness(text) < 1 for text in FORMULAS)
    with pytest.raises(KeyError, match="no requirement `fine`"):
        answer.robustness("fine")
    idle = flexsc.requirement("when pointing_error > 1: truth.rate < 1", name="idle")
    late = flexsc.requirement("always[0, 61] pointing_error < 1", name="late")
    scenario = flexsc.Scenario.parse(WAVE).with_("requirement", [idle, late])
    answer = scenario.simulate(log="none").answer
    assert answer.robustness("idle") == math.inf
    assert math.isnan(answer.robustness("late"))


def test_rows_are_optimistic() -> None:
    run = judged()
    sizes = np.abs(run["attitude"]["angle_rad"])
    exact = run.answer.robustness("always[10, 60] pointing_error < 5e-4")
    rows = (5e-4 - sizes[200:].max()) / 5e-4
    # Rows 0.05 s apart miss a peak by at most (2.13 0.025)^2/2 of it.
    assert 0 <= rows - exact < 3e-4 * 1.5e-3 / 5e-4


def test_rtamt_agrees_on_rows() -> None:
    rtamt = pytest.importorskip("rtamt", reason="rtamt is not installed: no second implementation on rows")
    run = judged()
    attitude = run["attitude"]
    for text, (formula, limit) in FORMULAS.items():
        specification = rtamt.StlDiscreteTimeOfflineSpecification()
        specification.declare_var("e", "float")
        specification.unit = "s"
        specification.spec = f"out = {formula}"
        specification.set_sampling_period(50, "ms", 0.1)
        specification.parse()
        rows = {"time": list(attitude["time_s"]), "e": list(np.abs(attitude["angle_rad"]))}
        found = specification.evaluate(rows)[0][1] / limit
        assert abs(found - run.answer.robustness(text)) < 0.02, text
