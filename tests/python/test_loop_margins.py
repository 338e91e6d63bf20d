"""Stability margins of loops: against poles of loops that are off, and responses at the crossings."""

from __future__ import annotations

import math

import flexsc
import numpy as np
import pytest


@pytest.mark.parametrize("name", ["wheel-fast-mode", "attitude-hold", "earth-observer"])
def test_margins_are_those_of_poles(name: str) -> None:
    scenario = flexsc.Scenario.example(name)
    opened, margins = scenario.linearise(loop="command"), scenario.margins()
    assert margins.spectral_radius == pytest.approx(opened.closed().spectral_radius(), abs=1e-12)
    assert (margins.loop, margins.period) == ("command", opened.period)
    assert margins.samples * len(margins.loops) == len(opened.inputs)
    for signal, found in margins.loops.items():
        expected = opened.common_margins([signal])
        assert found.gain_below == pytest.approx(expected.gain_below, rel=1e-4)
        assert found.gain_above == pytest.approx(expected.gain_above, rel=1e-4)
        assert found.phase == pytest.approx(expected.phase, rel=1e-4)
        assert 0.0 < margins.disk <= found.disk < 2.0
        assert 0.0 < margins.modulus <= found.modulus <= 1.0 + 1e-9
        assert math.isnan(found.delay) == (margins.samples > 1)


def test_crossings_are_on_the_circle_and_on_the_axis() -> None:
    scenario = flexsc.Scenario.example("wheel-slow-mode")
    opened, margins = scenario.linearise(loop="torque"), scenario.margins("torque")
    found = margins.loops["torque"]
    gain, phase = found.gain_crossings, found.phase_crossings
    values = opened.response(gain["frequency"])[:, 0, 0]
    np.testing.assert_allclose(abs(values), 1.0, rtol=1e-9)
    np.testing.assert_allclose(np.angle(-values), gain["phase"], atol=1e-9)
    np.testing.assert_allclose(np.mod(gain["phase"], 2.0 * np.pi) / gain["frequency"], gain["delay"])
    assert found.delay == gain["delay"].min()
    values = opened.response(phase["frequency"])[:, 0, 0]
    np.testing.assert_allclose(values * phase["factor"], -1.0, rtol=1e-9)
    distance = abs(1.0 + opened.response([found.modulus_frequency])[0, 0, 0])
    assert distance == pytest.approx(found.modulus, rel=1e-9)
    assert (abs(1.0 + opened.response()[:, 0, 0]) > found.modulus - 1e-9).all()


def test_what_has_no_margins_is_refused() -> None:
    with pytest.raises(flexsc.ScenarioError, match=r"law\.relay: is not linear"):
        flexsc.Scenario.example("relay-fixed").margins()
    with pytest.raises(ValueError, match=r"not stable and has no margins: .*1\.0476992 at 0\.0174 Hz"):
        flexsc.Scenario.example("wheel-unstable-band").margins()
    with pytest.raises(
        ValueError, match="loop must be one of 'command', 'torque', 'measurement', got 'wheel'"
    ):
        flexsc.Scenario.example("attitude-hold").margins("wheel")  # type: ignore[arg-type]
