"""Guaranteed ranges of outputs: against random states and inputs, and their witness as a scenario."""

import math

import flexsc
import numpy as np
import pytest


def test_runs_stay_within_the_range() -> None:
    scenario = flexsc.Scenario.example("bounded-jitter")
    bound = scenario.bound()[0]
    assert (bound.output, bound.unit, bound.elastic, bound.until) == ("roll", "rad", True, 60.0)
    assert bound.verdict == "proved"
    assert bound.limits is not None
    assert bound.limits[0] < bound.range[0] < bound.attained[0]
    assert bound.attained[1] < bound.range[1] < bound.limits[1]
    model = scenario.linearise(period=0.05)
    random = np.random.default_rng(7)
    modes = [k for k, signal in enumerate(model.states) if signal.name.startswith("mode")]
    row = [signal.name for signal in model.outputs].index("roll")
    for _ in range(20):
        x = np.zeros(len(model.states))
        x[modes[::2]] = random.choice([-5e-5, 5e-5], 3)
        x[modes[1::2]] = random.choice([-1e-4, 1e-4], 3)
        steady = random.choice([1e-4, 3e-4])
        for _ in range(1200):
            torques = random.choice([-1e-3, 1e-3], 3) * [1.0, 1.0, 0.0] + [steady, 0.0, 0.0]
            x = model.a @ x + model.b @ torques
            elastic = model.c[row, modes] @ x[modes]
            assert bound.range[0] <= elastic <= bound.range[1]


def test_a_violated_claim_has_a_witness() -> None:
    narrow = flexsc.Scenario.example("bounded-jitter").with_("bound[0].limits", [-5e-6, 5e-6])
    bound = narrow.bound()[0]
    witness = bound.witness
    assert bound.verdict == "violated"
    assert witness is not None
    assert bound.safe_until <= bound.violated_at <= witness.time
    assert witness.simulated == pytest.approx(witness.value, rel=1e-9)
    assert math.isnan(bound.gap)
    times, values = witness.inputs["torque_roll"]
    assert times[0] == 0.0
    assert times.shape == values.shape
    assert witness.scenario is not None
    assert witness.scenario.simulate().metrics["elastic_energy_end_j"] > 0.0
    assert list(bound.rows) == ["time", "low", "high"]


def test_a_scenario_without_claims_is_refused() -> None:
    with pytest.raises(flexsc.ScenarioError, match=r"bound.*is missing"):
        flexsc.Scenario.example("relay-fixed").bound()
