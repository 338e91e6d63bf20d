"""Derivatives and minima of metrics against closed forms and SciPy."""

from __future__ import annotations

import math
import pickle
import sys
from typing import Any

import flexsc
import numpy as np
import numpy.typing as npt
import pytest
from conftest import shipped
from scipy.optimize._numdiff import approx_derivative

ANGLE, RATE, DURATION = "body.planar.angle", "body.planar.rate", "duration"
RELAY = [f"law.relay.{name}" for name in ("dead_zone", "hysteresis", "strong", "weak")]


def drifting(angle: float = 0.1, rate: float = 0.003, duration: float = 100.0) -> flexsc.Scenario:
    """A free body: its angle is a + w t, so the integral of the time times the angle is a T²/2 + w T³/3."""
    body = {"planar": {"inertia": 2.0, "angle": angle, "rate": rate}}
    return flexsc.Scenario({"duration": duration, "body": body, "law": {"open": {}}})


def held() -> flexsc.Scenario:
    body = {"planar": {"inertia": 2.0, "angle": 0.1}}
    law = {"pd": {"k_p": 0.02, "k_d": 0.2, "period": 0.5}}
    return flexsc.Scenario({"duration": 100.0, "body": body, "law": law})


def test_derivatives_are_those_of_a_closed_form() -> None:
    found = flexsc.sensitivities(drifting(), [ANGLE, RATE, DURATION], ["itae"])
    expected = {ANGLE: 100.0**2 / 2, RATE: 100.0**3 / 3, DURATION: 100.0 * (0.1 + 0.003 * 100.0)}
    assert found["itae"] == pytest.approx(expected, rel=1e-9)
    for key, value in expected.items():
        assert abs(found["itae"][key] - value) <= found.error("itae", key) < 1e-6 * value
    assert found.nominal[0] == pytest.approx(0.1 * 5000.0 + 0.003 * 1e6 / 3.0, rel=1e-12)
    assert [found.unit("itae", key) for key in found.varied] == [
        "rad s² per rad",
        "rad s² per (rad/s)",
        "rad s² per s",
    ]
    assert repr(found).splitlines()[1].startswith("  itae by body.planar.angle: 5000 +- ")
    assert pickle.loads(pickle.dumps(found))["itae"] == found["itae"]


def test_the_period_of_a_limit_cycle_is_homogeneous() -> None:
    # The period stays if angles and torques grow together, and is divided by s if torques grow by s²: by
    # Euler's theorem these sums of its derivatives are 0 and minus half of it.
    scenario = shipped("relay-fixed").with_({"body.planar.modes": [], DURATION: 3000.0})
    found = flexsc.sensitivities(scenario, RELAY, ["cycle_period_s"])
    period = found.nominal[0]
    parts = found.derivatives[0] * [scenario.get(key) for key in RELAY]
    assert period == pytest.approx(44.142354635, rel=1e-9)
    assert abs(parts.sum()) < 1e-9 * period
    assert parts[2:].sum() == pytest.approx(-0.5 * period, rel=1e-9)
    assert found.unit("cycle_period_s", RELAY[2]) == "s per (rad/s²)"


def test_derivatives_are_those_of_scipy() -> None:
    scenario, keys = held(), ["law.pd.k_p", "law.pd.k_d", "body.planar.inertia"]
    metrics = ["itae", "settling_time_s", "peak_feedback_torque_nm"]

    def measured(values: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        run = scenario.with_(dict(zip(keys, values.tolist(), strict=True))).simulate(log="none")
        return np.array([run.metrics[name] for name in metrics])

    start = np.array([scenario.get(key) for key in keys])
    expected: Any = approx_derivative(measured, start, method="3-point", rel_step=1e-5)
    found = flexsc.sensitivities(scenario, keys, metrics)
    np.testing.assert_allclose(found.derivatives, expected, rtol=1e-5, atol=1e-7)
    # k_p times the angle at the start.
    assert found["peak_feedback_torque_nm"]["law.pd.k_p"] == pytest.approx(0.1, rel=1e-9)
    assert found.errors.max() < 1e-3


def test_errors_are_of_the_fourth_order() -> None:
    # The settling time is no polynomial: its errors fall with the steps, and stay above the true ones.
    scenario, key = held(), "law.pd.k_d"
    best = flexsc.sensitivities(scenario, [key], ["itae"], step=2e-3)["itae"][key]
    for step in (0.1, 0.05):
        found = flexsc.sensitivities(scenario, [key], ["itae"], step=step)
        assert abs(found["itae"][key] - best) < found.error("itae", key)
    wide, narrow = (
        abs(flexsc.sensitivities(scenario, [key], ["itae"], step=step)["itae"][key] - best)
        for step in (0.1, 0.05)
    )
    assert 8.0 < wide / narrow < 32.0


def test_all_runs_have_the_noise_of_one() -> None:
    scenario, key = held().with_("sensor", {"sampled": {"period": 0.5, "noise": 1e-3}}), "law.pd.k_d"

    def measured(values: npt.NDArray[np.float64]) -> float:
        metric: float = scenario.with_(key, float(values[0])).simulate(4, "none").metrics["itae"]
        return metric

    # Between runs the noise changes the metric far more than a step of the key does.
    other: float = scenario.simulate(5, "none").metrics["itae"]
    assert abs(measured(np.array([0.2])) - other) > 1e-3
    expected: Any = approx_derivative(measured, [0.2], method="3-point", rel_step=1e-6)
    found = [flexsc.sensitivities(scenario, [key], ["itae"], step=1e-5, run=4, jobs=n) for n in (1, 3)]
    assert found[0]["itae"][key] == pytest.approx(expected[0], rel=1e-5)
    np.testing.assert_array_equal(found[0].derivatives, found[1].derivatives)


def test_leaps_have_no_derivative() -> None:
    scenario = shipped("relay-fixed").with_(DURATION, 2000.0)
    counts = [
        scenario.with_("law.relay.k_t", 0.31 * part).simulate().metrics["switchings"] for part in (0.9, 1.1)
    ]
    assert counts[0] != counts[1]
    with pytest.warns(RuntimeWarning, match=r"leaps.*: switchings by law\.relay\.k_t"):
        found = flexsc.sensitivities(scenario, ["law.relay.k_t"], ["switchings"], step=0.1)
    assert math.isnan(found["switchings"]["law.relay.k_t"])
    assert math.isnan(found.error("switchings", "law.relay.k_t"))
    # Between leaps a count is constant; a body without a band has no settling time.
    with pytest.warns(RuntimeWarning, match="settling_time_s by body.planar.angle;"):
        none = flexsc.sensitivities(drifting(), [ANGLE], ["settling_time_s", "itae"])
    assert np.isnan(none.derivatives[0]).all()
    assert none["itae"][ANGLE] == pytest.approx(5000.0)


def test_a_smooth_minimum_has_derivatives() -> None:
    # The angle changes its sign at t = -a/w, so J = T³ w/3 + a T²/2 with the signs turned there, and
    # dJ/dw = 2 t³/3 - T³/3, which vanishes at t = T / 2^(1/3).
    least = -0.1 * 2.0 ** (1.0 / 3.0) / 100.0
    for factor in (1.0, 1.0 + 1e-5, 1.0 - 1e-4, 1.01):
        rate = factor * least
        expected = 2.0 * (0.1 / -rate) ** 3 / 3.0 - 100.0**3 / 3.0
        for step in (1e-3, 0.02):
            found = flexsc.sensitivities(drifting(rate=rate), [RATE], ["itae"], step=step)
            assert abs(found["itae"][RATE] - expected) < 1e-5 * 100.0**3 / 3.0
            assert abs(found["itae"][RATE] - expected) <= found.error("itae", RATE)


@pytest.mark.parametrize("place", [0.05, 1.0 / 3.0, 0.45, 0.7, -1.0 / 3.0])
def test_a_bend_has_no_derivative(place: float) -> None:
    # A body at rest has J = |a| T²/2, which bends at a = 0: here `place` steps away.
    step = 1e-3
    with pytest.warns(RuntimeWarning, match=r"bends.*: itae by body\.planar\.angle"):
        found = flexsc.sensitivities(drifting(-place * step, rate=0.0), [ANGLE], ["itae"], step={ANGLE: step})
    assert math.isnan(found["itae"][ANGLE])
    assert found == pickle.loads(pickle.dumps(found))


def test_wrong_arguments_are_named() -> None:
    scenario = drifting(rate=0.0)
    with pytest.raises(ValueError, match=r"body\.planar\.rate is 0, so its step must be given"):
        flexsc.sensitivities(scenario, [RATE], ["itae"])
    found = flexsc.sensitivities(scenario, [RATE], ["itae"], step={RATE: 1e-5})
    assert found["itae"][RATE] == pytest.approx(1e6 / 3.0)
    with pytest.raises(ValueError, match=r"no entry for body\.planar\.angle"):
        flexsc.sensitivities(scenario, [ANGLE], ["itae"], step={RATE: 1e-5})
    with pytest.raises(ValueError, match="must be a positive number"):
        flexsc.sensitivities(scenario, [ANGLE], ["itae"], step=-1.0)
    with pytest.raises(ValueError, match="keys must be a list of names, got 'duration'"):
        flexsc.sensitivities(scenario, DURATION, ["itae"])
    with pytest.raises(ValueError, match="has no number to vary"):
        flexsc.sensitivities(scenario, ["body.planar.drive"], ["itae"])
    with pytest.raises(ValueError, match="output_peaks is not a single number"):
        flexsc.sensitivities(scenario, [ANGLE], ["output_peaks"])
    with pytest.raises(KeyError, match="did you mean 'itae'"):
        flexsc.sensitivities(scenario, [ANGLE], ["itea"])
    with pytest.raises(KeyError, match="no metric 'duty'"):
        found["duty"]


def test_pandas_has_the_derivatives() -> None:
    pytest.importorskip("pandas")
    found = flexsc.sensitivities(drifting(), [ANGLE, RATE], ["itae"])
    frame = found.to_pandas()
    assert frame.loc["itae", ANGLE] == found["itae"][ANGLE]
    assert frame.attrs["units"]["itae"][RATE] == "rad s² per (rad/s)"


def test_a_minimum_is_that_of_a_closed_form() -> None:
    # The integral of t |a + w t| over T is least where its derivative by w, the integral of t² with the sign
    # of the angle, is 0: the sign changes at T / 2^(1/3), so w = -a 2^(1/3) / T.
    start = drifting(rate=-0.003)
    best, result = flexsc.optimise(start, [RATE], "itae", xatol=1e-9, fatol=1e-12)
    assert result.success
    assert result.x == pytest.approx([-0.1 * 2.0 ** (1.0 / 3.0) / 100.0], rel=1e-6)
    assert best.get(RATE) == result.x[0]
    assert best.simulate().metrics["itae"] == result.fun


def test_a_minimum_keeps_to_bounds_and_methods() -> None:
    # Divided by the start and multiplied again, this bound is another number.
    start, keys = drifting(rate=-0.00105), [RATE, ANGLE]
    best, result = flexsc.optimise(
        start, keys, "itae", bounds={RATE: (-0.001136, 0.0), ANGLE: (0.1, 0.2)}, maxiter=200
    )
    assert result.x == pytest.approx([-0.001136, 0.1], rel=1e-6)
    assert -0.001136 <= best.get(RATE) <= 0.0
    again, _ = flexsc.optimise(start, [RATE], "itae", bounds=[(-0.01, 0.0)], method="Powell", xtol=1e-9)
    assert again.get(RATE) == pytest.approx(-0.1 * 2.0 ** (1.0 / 3.0) / 100.0, rel=1e-5)
    # A function of all metrics, of which k_p is known: the torque at the start is k_p times the angle.
    torque, _ = flexsc.optimise(
        held(), ["law.pd.k_p"], lambda metrics: (metrics["peak_feedback_torque_nm"] - 0.003) ** 2, fatol=1e-18
    )
    assert torque.get("law.pd.k_p") == pytest.approx(0.03, rel=1e-4)
    few = flexsc.optimise(start, [RATE], "itae", maxiter=3)[1]
    assert (few.success, few.nit) == (False, 3)


def test_values_that_are_not_accepted_are_left_again() -> None:
    # The inertia must be positive: the search tries others too, and stays where it is defined.
    best, result = flexsc.optimise(
        held(), ["body.planar.inertia"], lambda metrics: metrics["itae"], maxiter=60
    )
    assert 0.0 < best.get("body.planar.inertia") < 2.0
    assert math.isfinite(result.fun)


def test_a_search_needs_a_start_bounds_and_scipy(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(ValueError, match="no value at the start"):
        flexsc.optimise(drifting(), [RATE], "settling_time_s")
    with pytest.raises(ValueError, match="bounds of duration, which are not among the keys"):
        flexsc.optimise(drifting(), [RATE], "itae", bounds={DURATION: (0.0, 1.0)})
    with pytest.raises(ValueError, match="smallest and a largest value of each of 1 keys"):
        flexsc.optimise(drifting(), [RATE], "itae", bounds=[(1.0, 0.0)])
    with pytest.raises(ValueError, match="has no number to vary"):
        flexsc.optimise(drifting(), ["body.planar.drive"], "itae")
    with pytest.raises(ValueError, match="the metric must be a number"):
        flexsc.optimise(drifting(), [RATE], "output_peaks")
    missing: Any = None
    monkeypatch.setitem(sys.modules, "scipy.optimize", missing)
    with pytest.raises(ImportError, match=r"flexsc\.optimise needs scipy: pip install scipy"):
        flexsc.optimise(drifting(), [RATE], "itae")
