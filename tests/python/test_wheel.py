"""Wheels and drifting frequencies against direct integration by SciPy, and the filter in the loop."""

from typing import Any

import numpy as np
import pytest
from conftest import shipped
from flexsc import Scenario, campaign
from scipy.integrate import solve_ivp

W, K = np.array([0.3, 0.8, 1.0, 2.0]), np.array([1.44, 0.21, 0.165, 0.72])
ZETA = np.array([0.0, 0.02, 0.0, 0.3])
PERIOD, INERTIA = 0.3, 250.0
SINUSOID = {"sinusoid": {"amplitude": 0.3, "period": 60.0, "phase": 7.0}}
TABLE = {"table": [{"time": 3.1, "ratio": 1.0}, {"time": 10.25, "ratio": 0.4}, {"time": 20.0, "ratio": 1.3}]}
RAMP = {"ramp": {"from": 5.0, "time": 20.0, "to": 0.5}}


def sinusoid(t: float) -> float:
    at = 2 * np.pi / 60 * (np.array([t, 0.0]) + 7.0)
    return float(1 + 0.3 * (np.cos(at[0]) - np.cos(at[1])))


def table(t: float) -> float:
    return float(np.interp(t, [3.1, 10.25, 20.0], [1.0, 0.4, 1.3]))


def ramp(t: float) -> float:
    return float(np.interp(t, [5.0, 25.0], [1.0, 0.5]))


def integrate(ratios: Any, total: bool, end: float) -> np.ndarray[Any, Any]:
    """Angles at the samples: u = -(k_p x + k_d dx/T0), held and an eighth of a second late."""
    delay, gain, back_emf = 0.125, 2.0, 3.0

    def field(t: float, z: Any, u: float) -> Any:
        x, v = z[2::2], z[3::2]
        r = ratios(t)
        rate = z[1] + (v.sum() if total else 0.0)
        m = (gain * u - back_emf * rate) / INERTIA
        out = np.empty_like(z)
        out[0], out[1], out[2::2] = z[1], m, v
        out[3::2] = K * m - 2 * ZETA * W * r * v - (W * r) ** 2 * x
        return out

    z, command, last, angles = np.zeros(10), 0.0, None, []
    z[0] = 0.06
    for k in range(round(end / PERIOD)):
        t = k * PERIOD
        angle = float(z[0::2].sum())
        angles.append(angle)
        new = -(0.5 * angle + 5.0 * (angle - (angle if last is None else last)) / PERIOD)
        last = angle
        stops = [t, t + delay, t + PERIOD, *(kink for kink in KINKS if t < kink < t + PERIOD)]
        for a, b in zip(sorted(stops), sorted(stops)[1:], strict=False):
            u = command if a < t + delay - 1e-9 else new
            z = solve_ivp(field, (a, b), z, "DOP853", rtol=1e-13, atol=1e-16, args=(u,)).y[:, -1]
        command = new
    return np.array(angles)


KINKS = [3.1, 5.0, 10.25, 20.0, 25.0]


@pytest.mark.parametrize(
    ("drift", "ratios"),
    [
        (None, lambda t: 1.0),
        ({"common": SINUSOID}, sinusoid),
        ({"common": TABLE}, table),
        (
            {"each": [RAMP, TABLE, SINUSOID, RAMP]},
            lambda t: np.array([ramp(t), table(t), sinusoid(t), ramp(t)]),
        ),
    ],
)
@pytest.mark.parametrize("opposes", ["body_rate", "rigid_rate"])
def test_the_motion_is_that_of_an_integrator(drift: Any, ratios: Any, opposes: str) -> None:
    modes = [{"frequency": w, "gain": k, "damping": z} for w, k, z in zip(W, K, ZETA, strict=True)]
    scenario = Scenario(
        {
            "duration": 30.0,
            "log": {"period": PERIOD},
            "body": {"planar": {"inertia": INERTIA, "angle": 0.06, "modes": modes}},
            "actuator": {"wheel": {"gain": 2.0, "back_emf": 3.0, "opposes": opposes, "delay": 0.125}},
            "law": {"pd": {"k_p": 0.5, "k_d": 5.0, "period": PERIOD, "differentiation": "difference"}},
            "sensor": {"sampled": {"period": PERIOD}},
            **({"drift": drift} if drift else {}),
        }
    )
    ours = scenario.simulate(log="full")["attitude"]["angle_rad"]
    exact = integrate(ratios, opposes == "body_rate", 30.0)
    assert np.abs(ours[: len(exact)] - exact).max() < 2e-13


def test_the_filter_in_the_loop() -> None:
    result = shipped("wheel-settling-fit").simulate(log="full")
    estimate = result["estimator"]
    late = (estimate["time_s"] > 30) & (estimate["time_s"] < 200)
    error = (estimate["frequency_rad_s"] - estimate["true_frequency_rad_s"])[late]
    deviations = error / estimate["frequency_sd_rad_s"][late]
    rms = np.sqrt(np.mean(error**2))
    assert rms == pytest.approx(result.metrics["frequency_error_rms_rad_s"], rel=0.01)
    assert rms < 3e-3
    assert np.abs(deviations).max() < 6
    assert result.metrics["lock_lost"] == 0
    assert result.metrics["settling_time_s"] < 200
    assert result.metrics["spectral_radius"] < 1


def test_a_stuck_sensor_is_reported() -> None:
    stuck = shipped("wheel-ekf").with_("sensor.sampled.faults", [{"stuck": {"from": 60.0}}])
    result = stuck.simulate(log="full")
    assert result.metrics["lock_lost"] == 1
    assert 60 < result.metrics["lock_lost_at_s"] < 200
    assert all(np.isfinite(result["estimator"][name]).all() for name in ["nis", "nees", "frequency_rad_s"])


def test_a_campaign_of_filters() -> None:
    runs = campaign(shipped("wheel-ekf").with_("duration", 200.0), runs=16)
    assert np.mean(runs["nis_mean"]) == pytest.approx(1.0, abs=0.1)
    assert np.all(runs["lock_lost"] == 0)
