"""The sampled loop: regions of the extra gain, robust gains, the map, beside NumPy's own eigenvalues."""

from typing import Any

import numpy as np
import pytest
from flexsc import Scenario, ScenarioError
from flexsc.papers import gain_region, robust_gains, stability_map
from scipy.linalg import expm

W, K = np.array([0.3, 0.8, 1.0, 2.0]), np.array([1.44, 0.21, 0.165, 0.72])


def fitted(**law: Any) -> Scenario:
    modes = [{"frequency": w, "gain": k} for w, k in zip(W, K, strict=True)]
    pd = {"k_p": 7.5, "k_d": 275.0, "period": 0.3, "differentiation": "raw", **law}
    return Scenario(
        {
            "duration": 600.0,
            "body": {"planar": {"angle": 0.06, "modes": modes}},
            "actuator": {"wheel": {"gain": 5e-4, "back_emf": 1e-4}},
            "law": {"pd": pd},
            "sensor": {"sampled": {"period": 0.3}},
            **({"estimator": {"truth": {}}} if "extra" in law else {}),
        }
    )


def radius(frequency: float, period: float, gain: float) -> float:
    system, push, felt = np.zeros((10, 10)), np.zeros(10), np.zeros(10)
    push[1], push[3::2], felt[1::2], system[0, 1] = 1.0, K, 1.0, 1.0
    for i, w in enumerate(W * frequency / 0.3):
        system[2 + 2 * i, 3 + 2 * i], system[3 + 2 * i, 2 + 2 * i] = 1.0, -(w**2)
    whole = np.zeros((11, 11))
    whole[:10, :10], whole[:10, 10] = (system - 1e-4 * np.outer(push, felt)) * period, 5e-4 * push * period
    held, fed = expm(whole), np.tile([1.0, 0.0], 5)
    fed[2] += gain
    closed = np.zeros((11, 11))
    closed[:10, :10] = held[:10, :10] - np.outer(held[:10, 10], 282.5 * fed)
    closed[:10, 10], closed[10, :10] = 275.0 * held[:10, 10], fed
    return float(abs(np.linalg.eigvals(closed)).max())


def test_the_region_of_the_extra_gain() -> None:
    region = gain_region(fitted(), np.array([0.1, 0.2, 0.3]))
    np.testing.assert_allclose(region["gain_min"], [np.nan, -0.8, -0.9], atol=1e-9)
    np.testing.assert_allclose(region["gain_max"], [np.nan, 1.0, 3.7], atol=1e-9)
    np.testing.assert_allclose(region["midpoint"], [np.nan, 0.1, 1.4], atol=1e-9)
    assert region["spectral_radius"][1] == pytest.approx(radius(0.2, 0.3, 0.1), abs=1e-12)


def test_the_map() -> None:
    frequencies, periods = np.linspace(0.1, 0.4, 4), np.array([0.2, 0.9])
    cells = stability_map(fitted(extra={"gain": 1.2}), frequencies, periods, horizon=300.0)
    exact = [[radius(w, t, 1.2) for t in periods] for w in frequencies]
    np.testing.assert_allclose(cells["spectral_radius"], exact, atol=1e-11)
    np.testing.assert_array_equal(cells["frequency_rad_s"][:, 1], frequencies)
    np.testing.assert_array_equal(cells["period_s"][0], periods)
    assert cells["settling_s"].shape == (4, 2)


def test_robust_gains_make_a_schedule() -> None:
    found = robust_gains(fitted(), [0.2, 0.3], off=0.05, gains=(-1.0, 2.0, 0.25))
    assert (found["settling_quantile_s"] >= found["settling_s"]).all()
    pairs = zip(found["frequency_rad_s"], found["gain"], strict=True)
    points = [{"frequency": w, "gain": k} for w, k in pairs]
    scheduled = fitted(extra={"schedule": points})
    gain = found["gain"].mean()
    between = stability_map(scheduled, [0.25], [0.3])
    assert between["spectral_radius"][0, 0] == pytest.approx(radius(0.25, 0.3, gain), abs=1e-12)


def test_what_cannot_be_analysed() -> None:
    with pytest.raises(ScenarioError, match=r"law.*must be `pd`"):
        gain_region(Scenario({**fitted().to_dict(), "law": {"open": {}}}), [0.2])
    with pytest.raises(ValueError, match="frequencies must be positive numbers, got 0"):
        gain_region(fitted(), [0.2, 0.0])
    with pytest.raises(ValueError, match="quantile is out of its range, got 0"):
        robust_gains(fitted(), [0.2], quantile=0.0)
