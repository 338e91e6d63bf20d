"""Loops with an attitude filter: against runs, SciPy, and the margins of python-control."""

from __future__ import annotations

from importlib import import_module
from typing import Any

import flexsc
import numpy as np
import numpy.typing as npt
import pytest
from conftest import shipped
from scipy.linalg import solve_discrete_are

SMALL = 1e-6
ALONE = """
duration = 30.0
[spacecraft]
mass = 100.0
inertia = [[40.0, 0, 0], [0, 50.0, 0], [0, 0, 60.0]]
points = [{ name = "bus" }]
[actuator]
ideal = {}
[law.attitude]
period = 0.5
bandwidth = 0.3
damping = 0.8
[[sensor]]
gyro = { period = 0.5, angle_random_walk = 2e-5, rate_random_walk = 3e-7 }
[[sensor]]
star_tracker = { period = 0.5, noise = [2e-5, 5e-5, 1e-4] }
[estimator.attitude]
"""


def poles(matrix: npt.NDArray[np.float64]) -> npt.NDArray[np.complex128]:
    return np.sort_complex(np.linalg.eigvals(matrix).astype(np.complex128))


def filter_gain(period: float, walks: tuple[float, float], noise: float) -> tuple[Any, Any]:
    """Transition and steady gain of angle and bias of one axis, by SciPy."""
    f = np.array([[1.0, -period], [0.0, 1.0]])
    white, walk = walks[0] ** 2, walks[1] ** 2
    q = np.array(
        [
            [white * period + walk * period**3 / 3.0, -walk * period**2 / 2.0],
            [-walk * period**2 / 2.0, walk * period],
        ]
    )
    h, r = np.array([[1.0, 0.0]]), np.array([[noise**2]])
    p = solve_discrete_are(f.T, h.T, q, r)
    return f, p @ h.T / (h @ p @ h.T + r)


@pytest.mark.parametrize("every", [1, 4])
def test_the_poles_are_those_of_law_and_filter(every: int) -> None:
    scenario = flexsc.Scenario.parse(ALONE).with_("sensor[1].star_tracker.period", 0.5 * every)
    closed = scenario.linearise(loop="command").closed()
    assert closed.period == 0.5 * every
    found = poles(closed.a)
    for noise, inertia in [(2e-5, 40.0), (5e-5, 50.0), (1e-4, 60.0)]:
        # The filter errs by what the tracker has not yet corrected, whatever the law does.
        f, gain = filter_gain(0.5 * every, (2e-5, 3e-7), noise)
        expected = list(poles(f @ (np.eye(2) - gain @ np.array([[1.0, 0.0]]))))
        # The law sees the angle, and the mean rate of the period before, which is a state.
        a = np.array([[1.0, 0.5], [0.0, 1.0]])
        b = np.array([[0.125], [0.5]]) / inertia
        k_p, k_d = inertia * 0.3**2, inertia * 2.0 * 0.8 * 0.3 / 0.5
        law = np.zeros((3, 3))
        law[:2, :2] = a - b @ [[k_p + k_d, 0.0]]
        law[:2, 2] = (b * k_d)[:, 0]
        law[2, 0] = 1.0
        expected += list(poles(law) ** every)
        for pole in expected:
            assert np.abs(found - pole).min() < 1e-7, (noise, pole)


LATENCY, TRACKER = "sensor[1].star_tracker.latency", "sensor[1].star_tracker.period"
EXPOSURE, GYRO_LATENCY = "sensor[1].star_tracker.exposure", "sensor[0].gyro.latency"


@pytest.mark.parametrize(
    ("name", "changes"),
    [
        ("flexible-boom", {}),
        ("flexible-boom", {LATENCY: 0.8}),
        ("flexible-boom", {LATENCY: 0.33, "sensor[0].gyro.period": 0.1}),
        ("flexible-boom", {LATENCY: 0.07, "sensor[0].gyro.period": 0.1, TRACKER: 0.3}),
        ("flexible-boom", {LATENCY: 0.0}),
        ("flexible-boom", {LATENCY: 0.0, TRACKER: 0.25}),
        (
            "flexible-boom",
            {LATENCY: 0.0, TRACKER: 0.2, "law.attitude.period": 0.5, "sensor[0].gyro.period": 0.2},
        ),
        ("flexible-boom", {"estimator.attitude.form": {"complementary": {"bandwidth": 0.3}}}),
        ("flexible-boom", {"law.attitude.integral": {"time": 15.0, "limit": 1.0}}),
        ("earth-observer", {"sensor[0].gyro.point": "bench"}),
        ("flexible-boom", {LATENCY: 0.8, EXPOSURE: 0.5}),
        ("flexible-boom", {LATENCY: 0.33, EXPOSURE: 0.26, "sensor[0].gyro.period": 0.1}),
        ("flexible-boom", {GYRO_LATENCY: 0.5}),
        ("flexible-boom", {LATENCY: 0.1, EXPOSURE: 0.2, TRACKER: 0.2, GYRO_LATENCY: 0.25}),
    ],
)
def test_a_closed_loop_moves_as_the_simulated_one(name: str, changes: dict[str, Any]) -> None:
    keys = shipped(name).to_dict()
    del keys["target"], keys["reference"]
    # Hardly any noise, but a filter that believes in it.
    gyro, tracker = keys["sensor"][0]["gyro"], keys["sensor"][1]["star_tracker"]
    walks = gyro["angle_random_walk"] * 30.0, gyro["rate_random_walk"] * 300.0
    believed = tracker["noise"]
    begins = SMALL * np.array([1.0, -0.5, 0.7])
    # What is seen at the start is told at once: only without a latency does the loop begin as it goes on.
    drawn = changes.get(LATENCY) == 0.0
    keys["estimator"]["attitude"] = {
        "form": "steady",
        "angle_random_walk": walks[0],
        "rate_random_walk": walks[1],
        "attitude_noise": believed,
        "initial": {"angle": SMALL, "bias": 0.1 * SMALL},
        "prior": "drawn" if drawn else "true",
    }
    gyro |= {"angle_random_walk": 1e-20, "rate_random_walk": 0.0}
    tracker["noise"] = [0.0, 0.0, 0.0]
    keys["spacecraft"]["attitude"] = [1.0, *(0.5 * begins)]
    scenario = flexsc.Scenario(keys | {"duration": 40.0}, name).with_(changes)
    closed = scenario.linearise(loop="command").closed()
    assert closed.period is not None
    run = scenario.with_("log.period", closed.period).simulate(log="full")

    state_names = [state.name for state in closed.states]
    state = np.zeros(len(state_names))
    told = run["attitude_filter"]
    off = told["axes.angle_error_rad"][0], told["axes.bias_error_rad_s"][0]
    assert not drawn or np.abs(off[0]).min() > 1e-3 * SMALL
    sensors = scenario.to_dict()["sensor"]
    every, gyro_period = sensors[1]["star_tracker"]["period"], sensors[0]["gyro"]["period"]
    for axis, of in enumerate(("roll", "pitch", "yaw")):
        angle, bias = off[0][axis], off[1][axis]
        if drawn:
            # The log has what the first measurement left.
            gain = filter_gain(every, walks, believed[axis])[1][:, 0]
            angle /= 1.0 - gain[0]
            bias += gain[1] * angle
        values = {
            f"rigid_{of}": begins[axis],
            # The model has a gyro reading at the start, over the period before it, and a run none.
            f"expected_{of}": begins[axis] + angle + bias * gyro_period,
            f"expected_{of}_bias": bias,
            f"gyro_{of}_angle": begins[axis],
        }
        # What the tracker has seen before the start waits for a late gyro.
        late = sensors[0]["gyro"].get("latency", 0.0)
        for k in range(sum(name.startswith("exposure") and name.endswith(of) for name in state_names)):
            if late + gyro_period * np.ceil(-(k + 1) * every / gyro_period - 1e-9) > -1e-9 and late > 0.0:
                values[f"exposure{k}_{of}"] = begins[axis]
        for which, value in values.items():
            state[state_names.index(which)] = value
    seen = scenario.linearise().select(outputs=["roll", "pitch", "yaw"]).c

    def moved(state: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        motion = [state]
        assert closed.period is not None
        for _ in range(int(40.0 / closed.period + 1e-9)):
            motion.append(closed.a @ motion[-1])
        return np.array(motion)[:, : seen.shape[1]] @ seen.T

    hub = moved(state)
    pointing = run["pointing"]
    times = closed.period * np.arange(len(hub))
    at = np.array([np.abs(pointing["time_s"] - time).argmin() for time in times])
    np.testing.assert_allclose(pointing["time_s"][at], times, atol=1e-9)
    found = 2.0 * np.stack([pointing[f"q_{axis}"][at] for axis in "xyz"], axis=1)
    # The model has an exposure about the start, and a run none: what it had seen before makes up for it.
    exposed = [place for place, name in enumerate(state_names) if name.startswith("exposed_")]
    if exposed:
        parts = np.stack([moved(np.eye(len(state))[place]).ravel() for place in exposed], axis=1)
        before = np.linalg.lstsq(parts, (found - hub).ravel(), rcond=None)[0]
        hub += (parts @ before).reshape(hub.shape)
    np.testing.assert_allclose(found, hub, atol=2e-6 * SMALL, rtol=0)


def response(model: flexsc.Linear, frequency: float) -> npt.NDArray[np.complex128]:
    assert model.period is not None
    z = np.exp(1j * frequency * model.period)
    return np.asarray(model.c @ np.linalg.solve(z * np.eye(len(model.a)) - model.a, model.b) + model.d)


@pytest.mark.parametrize("late", [1, 2])
def test_a_delay_of_whole_periods_is_a_shift(late: int) -> None:
    scenario = flexsc.Scenario.parse(ALONE)
    prompt = scenario.linearise(loop="torque")
    delayed = scenario.linearise(loop="torque", delay=0.5 * late)
    assert [s.name for s in delayed.inputs] == ["torque_roll", "torque_pitch", "torque_yaw"]
    for frequency in (0.02, 0.3, 2.0):
        shift = np.exp(-0.5j * late * frequency)
        np.testing.assert_allclose(
            response(delayed, frequency), shift * response(prompt, frequency), atol=1e-9
        )
    # And of parts of a period something in between.
    half = scenario.linearise(loop="torque", delay=0.25)
    phases = [np.angle(response(loop, 0.3)[0, 0]) for loop in (prompt, half, delayed)]
    assert phases[0] > phases[1] > phases[2]


def test_margins_are_those_of_nyquist() -> None:
    control = import_module("control")
    scenario = flexsc.Scenario.parse(ALONE)
    opened = scenario.linearise(loop="command")
    for axis in ("roll", "pitch", "yaw"):
        found = opened.common_margins([f"command_{axis}"])
        one = opened.select([f"command_{axis}"], [f"command_{axis}"])
        # Of its frequency response: a transfer function of 30 states is mostly rounding.
        frequencies = np.geomspace(1e-3, np.pi / 0.5, 4001)
        seen = np.array([response(one, frequency)[0, 0] for frequency in frequencies])
        angle = np.rad2deg(np.unwrap(np.angle(seen)))
        above, phase, _, _ = control.margin(np.abs(seen), angle, frequencies)
        np.testing.assert_allclose(found.gain_above, above, rtol=1e-4)
        np.testing.assert_allclose(found.phase, np.deg2rad(phase), rtol=1e-4)
    # Axes that know nothing of each other: all together have the worst.
    each = [opened.common_margins([f"command_{axis}"]) for axis in ("roll", "pitch", "yaw")]
    assert opened.common_margins().phase == pytest.approx(min(margins.phase for margins in each), rel=1e-9)
    assert 0.0 <= opened.common_margins().gain_below < 1.0


@pytest.mark.parametrize("name", ["earth-observer", "flexible-boom"])
def test_margins_of_loops_of_several_periods(name: str) -> None:
    keys = shipped(name).to_dict()
    keys["estimator"]["attitude"].pop("elastic", None)
    scenario = flexsc.Scenario(keys, name)
    opened = scenario.linearise(loop="command")
    assert opened.period == 0.5
    assert len(opened.inputs) == 6
    margins = opened.common_margins()
    # The law commands so much more with another inertia in its model.
    rigid = scenario.linearise()
    inertia = np.round(np.linalg.inv(rigid.b[3:6]), 9)

    def radius(factor: float) -> float:
        other = scenario.with_("law.attitude.inertia", (factor * inertia).tolist())
        return float(np.abs(poles(other.linearise(loop="command").closed().a)).max())

    assert radius(0.999 * margins.gain_above) < 1.0 < radius(1.001 * margins.gain_above)
    assert margins.phase > np.deg2rad(20.0)
    one = opened.common_margins(["command_pitch"])
    assert one.gain_above >= margins.gain_above * (1.0 - 1e-9)


def test_what_no_loop_has_is_refused() -> None:
    scenario = flexsc.Scenario.parse(ALONE)
    with pytest.raises(ValueError, match="cut its loop open at the command or the torque"):
        scenario.linearise(loop="measurement")
    with pytest.raises(ValueError, match="repeats with gyro and attitude sensor only after"):
        scenario.with_("sensor[0].gyro.period", 0.501).linearise(loop="command")
    two = [*scenario.to_dict()["sensor"], {"star_tracker": {"period": 1.0, "noise": [1e-5] * 3}}]
    several = scenario.with_("sensor", two)
    with pytest.raises(flexsc.ScenarioError, match="linear tools take a filter with a gyro and one"):
        several.linearise(loop="command")
    opened = scenario.linearise(loop="command")
    with pytest.raises(KeyError, match="no command 'roll'; there are command_roll, command_pitch"):
        opened.common_margins(["roll"])
    with pytest.raises(ValueError, match="as many outputs as inputs, has margins"):
        scenario.linearise().common_margins()
