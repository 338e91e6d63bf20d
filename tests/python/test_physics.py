"""The engine against independent calculations: another integrator, quadrature, the algorithm once more."""

from typing import Any

import numpy as np
import pytest
from flexsc import Scenario
from scipy.integrate import solve_ivp, trapezoid


def margin(sign: float, threshold: float) -> Any:
    """A guard, as the integrator takes it."""

    def of(_: float, y: Any) -> Any:
        return sign * (y[0] + y[2] + y[4] - threshold)

    of.terminal, of.direction = True, 1.0  # type: ignore[attr-defined]
    return of


def integrated_switchings(count: int) -> list[tuple[float, str]]:
    """Switchings of the relay law at k_t = 0.31 on two undamped modes, by a general integrator.

    The law pushes back hard from a boundary of the dead zone until the angle is within it by the hysteresis,
    brakes for k_t times as long as it pushed, then drifts under a weak torque that slows the return.
    """
    eps, gamma, strong, weak, k_t = 5e-4, 1e-4, 4e-5, 1e-6, 0.31
    frequencies, gains = np.array([0.44, 0.755]), np.array([0.0213, 0.0216])
    # Each state's torque, and its guards (sign, threshold, next state): sign * (angle - threshold) >= 0.
    right, left = (1.0, eps, "RACC"), (-1.0, -eps, "LACC")
    states: dict[str, tuple[float, list[tuple[float, float, str]]]] = {
        "W0": (weak, [right, left]),
        "RACC": (-strong, [(-1.0, eps - gamma, "RBRK")]),
        "RBRK": (strong, []),
        "W+": (weak, [left, right]),
        "LACC": (strong, [(1.0, -eps + gamma, "LBRK")]),
        "LBRK": (-strong, []),
        "W-": (-weak, [right, left]),
    }
    # Rigid angle and rate, then displacement and rate of each mode.
    y, now, state, pushed_at = np.array([4.5e-4, 2.2e-5, 2.75e-6, 0.0, 0.0, 0.0]), 0.0, "W0", 0.0
    switchings: list[tuple[Any, ...]] = []
    while len(switchings) < count:
        torque, guards = states[state]

        def motion(_: float, y: Any, torque: float = torque) -> Any:
            flexing = gains * torque - frequencies**2 * y[2::2]
            return np.array([y[1], torque, y[3], flexing[0], y[5], flexing[1]])

        brake = k_t * (now - pushed_at)
        run = solve_ivp(
            motion,
            (now, now + (brake if not guards else 200.0)),
            y,
            method="DOP853",
            rtol=3e-14,
            atol=1e-20,
            max_step=0.5,
            events=[margin(sign, threshold) for sign, threshold, _ in guards] or None,
        )
        if guards:
            [place] = [place for place, times in enumerate(run.t_events) if len(times)]
            now, y, next_state = run.t_events[place][0], run.y_events[place][0], guards[place][2]
        else:
            now, y, next_state = run.t[-1], run.y[:, -1], {"RBRK": "W+", "LBRK": "W-"}[state]
        if next_state in ("RACC", "LACC"):
            pushed_at = now
        state = next_state
        switchings.append((now, state))
    return switchings


def test_switchings_are_those_of_a_general_integrator(fixed: Scenario) -> None:
    expected = integrated_switchings(12)
    command = fixed.with_("duration", 100.0).simulate()["command"]
    assert command["state"][:12].tolist() == [state for _, state in expected]
    np.testing.assert_allclose(command["time_s"][:12], [time for time, _ in expected], rtol=0, atol=1e-9)


def test_a_window_mean_is_the_integral_of_the_envelope(fixed: Scenario) -> None:
    result = fixed.with_({"duration": 500.0, "log.period": 0.01}).simulate(log="full")
    envelope = result["envelope"]
    mean = trapezoid(envelope["envelope_rad"], envelope["time_s"]) / 500.0
    assert result["envelope_mean"]["mean_rad"][0] == pytest.approx(mean, rel=1e-6)


def test_the_envelope_is_that_of_the_motion(fixed: Scenario) -> None:
    result = fixed.with_("duration", 500.0).simulate(log="full")
    modes, frequency = result["modes"], fixed.modes["frequency"]
    expected = np.hypot(modes["modes.displacement_rad"], modes["modes.rate_rad_s"] / frequency)
    np.testing.assert_allclose(result["envelope"]["modes.envelope_rad"], expected, rtol=1e-9, atol=1e-18)


@pytest.mark.parametrize("seed", [157, 1, 2, 3, 4])
def test_the_random_search_does_what_its_description_says(adaptive: Scenario, seed: int) -> None:
    result = adaptive.with_("seed", seed).simulate()
    means, steps = result["envelope_mean"], result["adaptation"]
    gain, sign, settled, falls, gains = 0.31, 0.0, 0, 0, [0.31]
    for window, mean in enumerate(means["mean_rad"]):
        if window == len(steps["draw"]):
            break
        size, end = abs(steps["draw"][window]), means["to_s"][window]
        if window == 0:
            sign = np.sign(steps["draw"][0])
        else:
            before = means["mean_rad"][window - 1]
            settled = settled + 1 if abs((mean - before) / mean) < 0.05 else 0
            if end >= 10000.0 and settled >= 6:
                assert steps["decision"][window] == "freeze"
                assert window == len(steps["draw"]) - 1
                gains.append(gain)
                break
            if mean < before:
                falls += 1
            else:
                # One rise after four falls is ignored.
                sign = sign if falls >= 4 else -sign
                falls = 0
        gain = min(max(gain + sign * size * 0.002, 0.28), 0.40)
        gains.append(gain)
    else:
        assert "freeze" not in steps["decision"]
    assert steps["gain"].tolist() == gains[1:]
    frozen = [gain] * (len(means["gain"]) - len(gains))
    assert means["gain"].tolist() == (gains + frozen)[: len(means["gain"])]
