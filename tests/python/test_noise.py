"""Noise of loops: against Lyapunov equations of SciPy, and the shapes of what is returned."""

from __future__ import annotations

from typing import Any

import flexsc
import numpy as np
import pytest
from scipy.linalg import solve_discrete_lyapunov


def test_deviations_are_those_of_lyapunov_equations() -> None:
    scenario = flexsc.Scenario.example("attitude-hold")
    opened, spectrum = scenario.linearise(loop="measurement"), scenario.spectrum(window=2.0, separation=60.0)
    closed = opened.a - opened.b @ opened.c
    into = opened.b * np.array([1e-4, 3e-5] * 3)
    covariance = solve_discrete_lyapunov(closed, into @ into.T, method="direct")
    deviations = np.sqrt(np.diag(opened.c @ covariance @ opened.c.T))[::2]
    assert list(spectrum.outputs) == ["roll", "pitch", "yaw"]
    for noise, expected in zip(spectrum.outputs.values(), deviations, strict=True):
        assert noise.sample_rms == pytest.approx(expected, rel=1e-9)
        assert noise.cumulative_rms[-1] == pytest.approx(expected, rel=2e-3)
        assert noise.density.shape == spectrum.frequency_hz.shape
        total = sum(noise.density_by_source.values())
        np.testing.assert_allclose(total, noise.density, rtol=1e-12)
        window = noise.window
        assert window is not None
        assert window["mpe"] ** 2 + window["rpe_uniform"] ** 2 == pytest.approx(noise.rms**2, rel=1e-6)
        assert 0.0 < window["pde"] < 2.0 * window["mpe"]


def test_wheels_have_lines_over_their_speed() -> None:
    wheels = flexsc.Scenario.example("wheel-run-up").spectrum("yaw", speeds=np.array([40.0, 92.9])).wheels
    assert wheels is not None
    assert [(each.wheel, each.order) for each in wheels.harmonics[:4]] == [(k, 1.0) for k in (1, 2, 3, 4)]
    first = wheels.harmonics[0]
    assert first.amplitude["yaw"][1] > 3.0 * first.amplitude["yaw"][0]
    # The Nyquist frequency of the law is 4 pi rad/s.
    assert (first.alias_frequency["yaw"] <= 4.0 * np.pi + 1e-9).all()


def test_what_has_no_spectrum_is_refused() -> None:
    with pytest.raises(flexsc.ScenarioError, match=r"law\.relay: is not linear"):
        flexsc.Scenario.example("relay-fixed").spectrum()
    with pytest.raises(ValueError, match=r"not stable and has no spectrum: .*1\.0476992 at 0\.0174 Hz"):
        flexsc.Scenario.example("wheel-unstable-band").spectrum()
    with pytest.raises(ValueError, match="signal must be `all` or some of roll, pitch"):
        flexsc.Scenario.example("attitude-hold").spectrum(["angle"])
    with pytest.raises(ValueError, match="separation needs a window"):
        flexsc.Scenario.example("attitude-hold").spectrum(separation=3.0)


SHARP: dict[str, Any] = {
    "name": "sharp",
    "quantity": "mtf",
    "point": "bench",
    "spatial_frequency": 2e5,
    "exposure": 0.02,
    "least": 0.99,
}


def test_required_contrasts_are_those_of_the_worst_speed_and_axis() -> None:
    craft = flexsc.Scenario.example("wheel-run-up")
    pixel = craft.spectrum(window=0.02, pixel=0.5 / SHARP["spatial_frequency"])
    assert pixel.wheels is not None
    assert pixel.wheels.mtf is not None
    least = min(values.min() for name, values in pixel.wheels.mtf.items() if name.startswith("line_of_sight"))
    found = craft.with_("requirement", [SHARP]).spectrum().contrasts["sharp"]
    assert found.mtf == pytest.approx(least, rel=1e-6)
    assert found.met == (found.mtf >= 0.99)
    assert found.curve["mtf"][0] == pytest.approx(1.0)
    assert found.curve["spatial_frequency"][-1] == pytest.approx(4e5)
    wheels = found.costs["actuator.wheels.imbalance"]
    assert wheels["alone"] == pytest.approx(found.mtf, rel=1e-3)
    # Neither noise nor broadband loads: no circle has a size.
    assert pixel.circles[0]["radius_95"] == 0.0


def test_the_worst_contrast_is_searched_for_by_linear_loops() -> None:
    ranges = {"actuator.wheels.imbalance.static[0]": {"uniform": [4e-6, 1e-5]}}
    craft = flexsc.Scenario.example("wheel-run-up").with_("requirement", [SHARP]).with_("uncertain", ranges)
    worst = craft.worst(requirement="sharp", points=8)
    assert worst.least
    assert worst.value <= worst.nominal
