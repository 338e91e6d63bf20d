"""Linear models against SciPy and against runs; linear controllers as laws."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import flexsc
import numpy as np
import numpy.typing as npt
import pytest
from conftest import shipped
from flexsc._margins import common_margins
from flexsc.parts import Authority, Event
from scipy.linalg import expm
from scipy.signal import StateSpace, TransferFunction, cont2discrete

PLANAR = """
duration = 30.0
[law.open]
[body.planar]
inertia = 250.0
modes = [{ frequency = 1.3, gain = 0.4, damping = 0.01 }, { frequency = 4.0, gain = 0.2, damping = 0.005 }]
[log]
period = 0.5
"""


class Steps(flexsc.Law):
    """Torques one after the other, another sequence about each axis."""

    def __init__(self, period: float, torques: npt.NDArray[np.float64]) -> None:
        self.period, self.torques = period, torques

    def start(self, authority: Authority) -> None:
        self.axis, self.next = authority.axis, 0

    def decide(self, event: Event) -> flexsc.Hold:
        self.next += 1
        return flexsc.Hold(self.torques[self.next - 1, self.axis])


def predicted(
    model: flexsc.Linear, inputs: npt.NDArray[np.float64], outputs: list[str], start: Any = None
) -> npt.NDArray[np.float64]:
    """The outputs at all samples."""
    chosen = model.select(outputs=outputs)
    x = np.zeros(len(model.a)) if start is None else start
    seen = []
    for u in inputs:
        seen.append(chosen.c @ x)
        x = chosen.a @ x + chosen.b @ u
    return np.array(seen)


def test_the_body_is_that_of_the_equations() -> None:
    model = flexsc.Scenario.parse(PLANAR).linearise()
    a = np.zeros((6, 6))
    a[0, 1] = a[2, 3] = a[4, 5] = 1.0
    for k, (w, zeta) in enumerate([(1.3, 0.01), (4.0, 0.005)]):
        a[3 + 2 * k, 2 + 2 * k], a[3 + 2 * k, 3 + 2 * k] = -(w**2), -2 * zeta * w
    np.testing.assert_allclose(model.a, a, rtol=1e-15)
    np.testing.assert_allclose(model.b, np.array([[0, 1, 0, 0.4, 0, 0.2]]).T / 250.0, rtol=1e-15)
    np.testing.assert_array_equal(model.c[:2], [[1, 0, 1, 0, 1, 0], [0, 1, 0, 1, 0, 1]])
    np.testing.assert_allclose(model.eigenfrequencies(), [0.0, 0.0, 1.3, 4.0], rtol=1e-12)
    assert [(s.name, s.unit) for s in model.inputs] == [("torque", "N m")]
    assert model.states[3] == flexsc.Signal("mode0_rate", "rad/s")
    assert repr(model) == "<flexsc.Linear continuous: 6 states, 1 input, 8 outputs>"


@pytest.mark.parametrize("delay", [0.0, 0.2, 0.5, 1.3])
def test_samples_are_exact(delay: float) -> None:
    model = flexsc.Scenario.parse(PLANAR).linearise()
    sampled = model.sampled(0.5, delay)
    rng = np.random.default_rng(3)
    inputs = rng.normal(size=(12, 1))
    found = predicted(sampled, inputs, ["angle", "rate"])
    # By the superposition of steps, each from when it acts.
    whole = np.zeros((7, 7))
    whole[:6, :6], whole[:6, 6:] = model.a, model.b
    for k in range(12):
        x = np.zeros(6)
        for j in range(k):
            for at, size in [(0.5 * j + delay, inputs[j, 0]), (0.5 * (j + 1) + delay, -inputs[j, 0])]:
                if 0.5 * k > at:
                    x = x + expm(whole * (0.5 * k - at))[:6, 6] * size
        np.testing.assert_allclose(found[k], model.c[:2] @ x, rtol=1e-9, atol=1e-12)


def test_a_run_is_what_the_model_says() -> None:
    scenario = flexsc.Scenario.parse(PLANAR)
    torques = np.random.default_rng(5).normal(size=(70, 3))
    result = scenario.with_parts(law=Steps(0.5, torques)).simulate(log="full")
    model = scenario.linearise(period=0.5)
    expected = predicted(model, torques[:61, :1], ["angle", "rate", "rigid_rate"])
    # The log has the state at every period; switchings are at the same instants.
    at, first = np.unique(result["attitude"]["time_s"], return_index=True)
    np.testing.assert_allclose(at, 0.5 * np.arange(61), atol=1e-12)
    scale = np.abs(expected).max(axis=0)
    for column, values in enumerate(
        [
            result["attitude"]["angle_rad"],
            result["rate"]["rate_rad_s"],
            result["rate"]["rigid_rad_s"],
        ]
    ):
        np.testing.assert_allclose(values[first], expected[:, column], atol=1e-11 * scale[column], rtol=0)


def test_a_spacecraft_turns_as_the_model_says() -> None:
    keys = shipped("earth-observer").to_dict()
    for key in ("target", "sensor", "estimator", "reference"):
        keys.pop(key, None)
    # Wheels that store momentum couple the axes.
    keys["actuator"]["wheels"]["speeds"] = [300.0, 100.0, 250.0, 50.0]
    keys |= {"duration": 20.0, "law": {"open": {}}, "log": {"period": 0.25}}
    # Runs of alike appendages keep the diagonal of their damping, linear models the whole.
    keys["spacecraft"] |= {"points": [{"name": "bus"}], "whole_damping": True}
    scenario = flexsc.Scenario(keys, "craft")
    # So small that the motion is linear, and large beside what steps leave of unresolved modes, 1e-14 rad/s.
    torques = 1e-5 * np.random.default_rng(7).normal(size=(90, 3))
    result = scenario.with_parts(law=Steps(0.25, torques)).simulate(log="full")
    model = scenario.linearise(period=0.25)
    assert len(model.states) == 22
    names = [f"{axis}{what}" for what in ("", "_rate") for axis in ("roll", "pitch", "yaw")]
    expected = predicted(model, torques[:81], names)
    pointing, rates = result["pointing"], result["rates"]
    at, first = np.unique(pointing["time_s"], return_index=True)
    np.testing.assert_allclose(at, 0.25 * np.arange(81), atol=1e-12)
    scale = np.abs(expected).max(axis=0)
    for axis, q in enumerate("xyz"):
        angle = 2.0 * pointing[f"q_{q}"][first]
        np.testing.assert_allclose(angle, expected[:, axis], atol=1e-6 * scale[axis], rtol=0)
        _, those = np.unique(rates["time_s"], return_index=True)
        rate = rates["axes.rate_rad_s"][those, axis]
        np.testing.assert_allclose(rate, expected[:, 3 + axis], atol=1e-6 * scale[3 + axis], rtol=0)
    # Without the momentum it is another body.
    still = scenario.with_("actuator.wheels.speeds", [200.0, -200.0, 200.0, -200.0]).linearise(period=0.25)
    assert np.abs(predicted(still, torques[:81], names) - expected).max(axis=0)[0] > 1e-3 * scale[0]


LAWS: dict[str, dict[str, Any]] = {
    "exact": {"pd": {"k_p": 40.0, "k_d": 250.0, "period": 0.5}},
    "difference": {"pd": {"k_p": 40.0, "k_d": 250.0, "period": 0.5, "differentiation": "difference"}},
    "raw": {"pd": {"k_p": 40.0, "k_d": 500.0, "period": 0.5, "differentiation": "raw"}},
    "attitude": {"attitude": {"bandwidth": 0.4, "damping": 0.7, "period": 0.5}},
    "filters": {
        "attitude": {
            "bandwidth": 0.3,
            "period": 0.5,
            "integral": {"time": 8.0, "limit": 1.0},
            "filters": [{"notch": {"frequency": 1.3, "depth": 0.1}}, {"low_pass": {"frequency": 3.0}}],
        }
    },
    "state_space": {
        "state_space": {
            "period": 0.5,
            "of": "tustin",
            "a": [[-2.0, 0.3], [0.0, -4.0]],
            "b": [[1.0, 0.2], [0.5, 0.0]],
            "c": [[30.0, -10.0]],
            "d": [[40.0, 200.0]],
        }
    },
}


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("sensor", ["continuous", "sampled"])
def test_a_closed_loop_moves_as_the_simulated_one(law: str, sensor: str) -> None:
    angle = 1e-3
    scenario = flexsc.Scenario.parse(PLANAR).with_({"law": LAWS[law], "body.planar.angle": angle})
    if sensor == "sampled":
        scenario = scenario.with_("sensor", {"sampled": {"period": 0.5}})
    result = scenario.simulate(log="full")
    poles = []
    for loop in ("command", "torque", "measurement"):
        opened = scenario.linearise(loop=loop)
        closed = opened.closed()
        poles.append(np.sort(np.abs(np.linalg.eigvals(closed.a))))
        np.testing.assert_allclose(poles[-1], poles[0], atol=1e-8)
        if loop != "command":
            continue
        # From the state of the start on: what was an angle before it is that angle, as for the law.
        start = np.zeros(len(closed.a))
        names = [state.name for state in closed.states]
        start[0] = angle
        if sensor == "sampled":
            start[names.index("last_angle")] = angle
        if law in ("difference", "raw"):
            start[names.index("law_last_angle")] = angle
        motion = [start]
        for _ in range(60):
            motion.append(closed.a @ motion[-1])
        _, first = np.unique(result["attitude"]["time_s"], return_index=True)
        expected = np.array(motion)[:, [0, 2, 4]].sum(axis=1)
        np.testing.assert_allclose(
            result["attitude"]["angle_rad"][first], expected, atol=1e-9 * angle, rtol=0
        )


def test_the_loop_of_a_wheel_has_its_delay() -> None:
    keys = shipped("wheel-fixed-gain").to_dict()
    del keys["law"]["pd"]["extra"], keys["estimator"], keys["drift"]
    keys["law"]["pd"]["period"] = keys["sensor"]["sampled"]["period"] = 0.3
    keys["actuator"]["wheel"]["delay"] = 0.4
    scenario = flexsc.Scenario(keys, "wheel")
    opened = scenario.linearise(loop="command")
    assert opened.period == keys["law"]["pd"]["period"]
    # Two commands are under way, and the law and the sensor know the sample before.
    assert len(opened.states) == len(scenario.linearise().states) + 4
    assert opened.inputs[0].name == "command"
    # Of the torque the loop has the same gain.
    at = np.exp(1j * 0.3)

    def gain(model: flexsc.Linear) -> complex:
        return complex((model.c @ np.linalg.solve(at * np.eye(len(model.a)) - model.a, model.b))[0, 0])

    torque = scenario.linearise(loop="torque")
    np.testing.assert_allclose(gain(torque), gain(opened), rtol=1e-9)


def test_three_axes_close_by_the_whole_inertia() -> None:
    keys = shipped("earth-observer").to_dict()
    for key in ("target", "estimator"):
        keys.pop(key, None)
    keys |= {
        "sensor": "continuous",
        "duration": 10.0,
        "law": {"attitude": {"bandwidth": 0.1, "period": 0.25}},
    }
    keys["spacecraft"]["whole_damping"] = True
    scenario = flexsc.Scenario(keys, "craft")
    closed = scenario.linearise(loop="command").closed()
    slow = np.sort(closed.eigenfrequencies())[:3]
    # Rigid poles of all axes near the bandwidth that the law asks for.
    np.testing.assert_allclose(slow, 0.1, rtol=0.02)
    assert np.abs(np.linalg.eigvals(closed.a)).max() < 1.0
    # And it moves as the run does, which wheels of different speeds turn.
    begins = 1e-6 * np.array([1.0, -0.5, 0.7])
    speeds = [300.0, 100.0, 250.0, 50.0]
    changed = {"actuator.wheels.speeds": speeds, "log.period": 0.25}
    scenario = scenario.with_({"spacecraft.attitude": [1.0, *(0.5 * begins)], **changed})
    pointing = scenario.simulate(log="full")["pointing"]
    _, first = np.unique(pointing["time_s"], return_index=True)
    closed = scenario.linearise(loop="command").closed()
    motion = [np.concatenate([begins, np.zeros(len(closed.a) - 3)])]
    for _ in range(40):
        motion.append(closed.a @ motion[-1])
    seen = scenario.linearise().select(outputs=["roll", "pitch", "yaw"]).c
    expected = np.array(motion)[:, : seen.shape[1]] @ seen.T
    found = 2.0 * np.stack([pointing[f"q_{axis}"][first] for axis in "xyz"], axis=1)
    np.testing.assert_allclose(found, expected, atol=1e-6 * 1e-6)


def test_controllers_come_back_in() -> None:
    scenario = flexsc.Scenario.parse(PLANAR).with_("body.planar.angle", 1e-3)
    pd = scenario.with_("law", LAWS["exact"])
    same = scenario.with_law(([], [], [], [[40.0, 250.0]]), period=0.5)
    torque = [run.simulate(log="full")["torque"]["feedback_nm"] for run in (pd, same)]
    np.testing.assert_allclose(torque[1], torque[0], rtol=1e-12)
    # A lead filter of continuous time, held and by Tustin's rule, is what SciPy makes of it.
    lead = tuple(np.array([[each]]) for each in (-3.0, 1.0, -200.0, 100.0))
    for method, name in [("zoh", "zoh"), ("held", "zoh"), ("tustin", "bilinear")]:
        made: Any = cont2discrete(lead, 0.5, name)
        discrete = made[:4]
        with_held = scenario.with_law(lead, 0.5, method=method)  # type: ignore[arg-type]
        by_scipy = scenario.with_law(StateSpace(*discrete, dt=0.5))
        law: Any = by_scipy.to_dict()["law"]
        assert law["state_space"]["period"] == 0.5
        torque = [run.simulate(log="full")["torque"]["feedback_nm"] for run in (with_held, by_scipy)]
        np.testing.assert_allclose(torque[1], torque[0], rtol=1e-9, atol=1e-12)
    # Transfer functions of both libraries: (100 s + 100) / (s + 3).
    control: Any = pytest.importorskip("control")
    functions = [TransferFunction([100.0, 100.0], [1.0, 3.0]), control.tf([100.0, 100.0], [1.0, 3.0])]
    for function in functions:
        seen = scenario.with_law(function, 0.5).simulate(log="full")["torque"]["feedback_nm"]
        held = scenario.with_law(lead, 0.5).simulate(log="full")["torque"]["feedback_nm"]
        np.testing.assert_allclose(seen, held, rtol=1e-9, atol=1e-12)
    with pytest.raises(ValueError, match="needs a period"):
        scenario.with_law(lead)
    with pytest.raises(ValueError, match="one output"):
        scenario.with_law(([], [], [], np.eye(2)), 0.5)
    with pytest.raises(TypeError, match=r"\(A, B, C, D\)"):
        scenario.with_law(3.0, 0.5)
    with pytest.raises(flexsc.ScenarioError, match=r"law\.state_space"):
        scenario.with_law(([[np.inf]], [[1.0]], [[1.0]], [[1.0]]), 0.5)


def test_three_axes_take_a_controller_each() -> None:
    keys = shipped("earth-observer").to_dict()
    for key in ("target", "estimator"):
        keys.pop(key, None)
    keys |= {"sensor": "continuous", "duration": 5.0}
    scenario = flexsc.Scenario(keys, "craft")
    gains = {"roll": 30.0, "pitch": 40.0, "yaw": 20.0}
    own = scenario.with_law({axis: ([], [], [], [[gain, 9.0 * gain]]) for axis, gain in gains.items()}, 0.25)
    law = own.to_dict()["law"]["per_axis"]
    assert law["pitch"]["state_space"]["d"] == [[40.0, 360.0]]
    assert len(own.linearise(loop="measurement").inputs) == 6


def test_what_is_not_linear_is_refused() -> None:
    relay = shipped("relay-fixed")
    with pytest.raises(ValueError, match=r"law\.relay: is not linear"):
        relay.linearise(loop="command")
    with pytest.raises(ValueError, match="the law's own"):
        relay.linearise(period=0.5, loop="command")
    with pytest.raises(ValueError, match="delay needs a period"):
        relay.linearise(delay=0.5)
    with pytest.raises(ValueError, match="period must be positive"):
        relay.linearise(period=0.0)
    with pytest.raises(flexsc.ScenarioError, match="drives"):
        shipped("sun-tracking").linearise()
    with pytest.raises(KeyError, match="no signal 'angel'"):
        relay.linearise().select(outputs=["angel"])


def test_frequencies_drift() -> None:
    scenario = flexsc.Scenario.parse(PLANAR).with_("drift", {"common": {"ramp": {"time": 20.0, "to": 0.5}}})
    np.testing.assert_allclose(scenario.linearise().eigenfrequencies(), [0.0, 0.0, 1.3, 4.0], rtol=1e-9)
    half_way = scenario.linearise(at=10.0).eigenfrequencies()
    np.testing.assert_allclose(half_way, [0.0, 0.0, 0.975, 3.0], rtol=1e-9)


def test_python_control_takes_and_gives_models() -> None:
    control = pytest.importorskip("control")
    scenario = flexsc.Scenario.parse(PLANAR).with_("body.planar.angle", 1e-3)
    body = scenario.linearise().select(outputs=["angle"]).control()
    assert body.nstates == 6
    assert body.input_labels == ["torque"]
    sampled = scenario.linearise(period=0.5).control()
    assert sampled.dt == 0.5
    np.testing.assert_array_equal(sampled.A, scenario.linearise(period=0.5).a)
    lead = control.ss([[-3.0]], [[1.0]], [[-200.0]], [[100.0]])
    by_matrices = scenario.with_law(([[-3.0]], [[1.0]], [[-200.0]], [[100.0]]), 0.5)
    assert scenario.with_law(lead, 0.5) == by_matrices
    discrete = control.sample_system(lead, 0.5, "tustin")
    runs = [
        run.simulate(log="full")["torque"]["feedback_nm"]
        for run in (scenario.with_law(discrete), scenario.with_law(lead, 0.5, method="tustin"))
    ]
    np.testing.assert_allclose(runs[0], runs[1], rtol=1e-9, atol=1e-12)


def test_an_unstable_loop_is_named_by_its_worst_pole() -> None:
    # On one axis the command warns by the same number.
    for name in ("wheel-unstable-band", "wheel-fast-mode"):
        scenario = shipped(name)
        closed = scenario.linearise(loop="command").closed()
        reported = scenario.simulate(log="none").metrics["spectral_radius"]
        assert closed.spectral_radius() == pytest.approx(reported, rel=1e-9)
    opened = shipped("wheel-unstable-band").linearise(loop="command")
    radius = opened.closed().spectral_radius()
    assert radius > 1.0
    with pytest.raises(ValueError, match=rf"magnitude {radius:.7f} at [0-9.]+ Hz.* in `command`"):
        opened.common_margins()
    # Three axes have no such metric, but the linear model has the number.
    observer = shipped("earth-observer").linearise(loop="command").closed()
    assert 0.9 < observer.spectral_radius() < 1.0
    fast = shipped("earth-observer").with_("law.attitude.bandwidth", 2.0).linearise(loop="command")
    assert fast.closed().spectral_radius() > 1.0
    with pytest.raises(ValueError, match="a period or a loop"):
        shipped("earth-observer").linearise().spectral_radius()


def test_margins_end_at_the_limit_of_stability() -> None:
    # The pole of x + u with u = -k x lies at 1 - k: the loop is stable up to k = 2 exactly.
    one = np.ones((1, 1))
    signals = [SimpleNamespace(name="command")]
    loop: Any = SimpleNamespace(a=one, b=one, c=one, d=0.0 * one, period=1.0, inputs=signals)
    found = common_margins(loop, None)
    assert found.gain_above == pytest.approx(2.0, rel=1e-14)
