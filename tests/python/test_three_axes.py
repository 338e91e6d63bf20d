"""Laws about three axes together: by matrices, from designs by SciPy, and written in Python."""

from __future__ import annotations

import runpy
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import flexsc
import numpy as np
import numpy.typing as npt
import pytest
from conftest import shipped
from flexsc.parts import ThreeAxisEvent
from scipy.linalg import expm, solve_continuous_are, solve_discrete_are

Matrix = npt.NDArray[np.float64]

PERIOD = 0.5
INERTIA = np.array([[100.0, 3.0, -2.0], [3.0, 80.0, 1.0], [-2.0, 1.0, 60.0]])
# Frequency (rad/s), damping ratio, and rotation at the hub and at the sensor.
MODES = [
    (0.9, 0.004, [0.05, 0.02, 0.01], [0.04, 0.01, 0.02]),
    (2.3, 0.01, [0.01, 0.04, -0.03], [0.02, 0.03, -0.02]),
]
BEGINS = np.array([3e-6, -2e-6, 5e-6])
ERRORS = ["roll", "pitch", "yaw", "roll_rate", "pitch_rate", "yaw_rate"]
# Of the plant below: its states are angles, rates, and displacement and rate of each mode.
MEASURED = 6


def body() -> flexsc.Scenario:
    modes = [
        {
            "frequency": frequency,
            "damping": damping,
            "shapes": {"hub": {"rotation": hub}, "bench": {"rotation": bench}},
        }
        for frequency, damping, hub, bench in MODES
    ]
    return flexsc.Scenario(
        {
            "duration": 60.0,
            "log": {"period": PERIOD},
            "law": {"open": {}},
            "sensor": {"sampled": {"period": PERIOD, "rate_noise": 1e-30, "point": "bench"}},
            "body": {
                "spatial": {
                    "inertia": INERTIA.tolist(),
                    "attitude": [1.0, *(0.5 * BEGINS)],
                    "points": [{"name": "hub"}, {"name": "bench"}],
                    "modes": modes,
                }
            },
        },
        "body",
    )


def plant() -> tuple[Matrix, Matrix, Matrix]:
    """The body in discrete time, by NumPy and SciPy alone, with the angles and rates of the sensor."""
    order = 6 + 2 * len(MODES)
    a, b, c = np.zeros((order, order)), np.zeros((order, 3)), np.zeros((6, order))
    a[:3, 3:6] = np.eye(3)
    b[3:6] = np.linalg.inv(INERTIA)
    c[:, :6] = np.eye(6)
    for k, (frequency, damping, hub, bench) in enumerate(MODES):
        at = 6 + 2 * k
        a[at, at + 1] = 1.0
        a[at + 1, at], a[at + 1, at + 1] = -(frequency**2), -2.0 * damping * frequency
        b[at + 1] = hub
        c[:3, at], c[3:, at + 1] = bench, bench
    whole = np.zeros((order + 3, order + 3))
    whole[:order] = np.hstack([a, b]) * PERIOD
    held: Any = expm(whole)
    return held[:order, :order], held[:order, order:], c


def coupled(outputs: int, inputs: int, order: int = 3) -> tuple[Matrix, Matrix, Matrix, Matrix]:
    """A stable compensator that couples all axes, which damps by its D."""
    rng = np.random.default_rng(11)
    a = 0.3 * rng.normal(size=(order, order))
    d = 0.3 * rng.normal(size=(outputs, inputs))
    d[:, :3] += 2.0 * np.eye(outputs, 3)
    d[:, 3:] += 25.0 * np.eye(outputs, inputs - 3)
    return a, 0.2 * rng.normal(size=(order, inputs)), 0.2 * rng.normal(size=(outputs, order)), d


def closed(a: Matrix, b: Matrix, c: Matrix, law: tuple[Matrix, Matrix, Matrix, Matrix]) -> Matrix:
    """The closed loop of a plant and a law, whose input is minus the measurement."""
    ka, kb, kc, kd = law
    return np.block([[a - b @ kd @ c, b @ kc], [-kb @ c, ka]])


def poles(a: Matrix) -> npt.NDArray[np.complex128]:
    found: Any = np.linalg.eigvals(a).astype(np.complex128)
    ordered: npt.NDArray[np.complex128] = found[np.lexsort((found.imag.round(6), found.real.round(6)))]
    return ordered


@pytest.mark.parametrize("gain", [1.0, 0.8])
def test_poles_and_motion_are_those_of_scipy(gain: float) -> None:
    law = coupled(3, 6)
    scenario = body().with_law(law, PERIOD, method="held")
    # In discrete time, as python-control gives it.
    a, b, c, d = law
    discrete = SimpleNamespace(A=a, B=b, C=c, D=d, dt=PERIOD)
    scenario = body().with_law(discrete).with_("law.state_space.gain", gain)
    assert scenario.to_dict()["law"]["state_space"]["inputs"] == ERRORS
    loop = closed(*plant(), (a, b, gain * c, gain * d))
    model = scenario.linearise(loop="command").closed()
    assert len(model.a) == len(loop)
    np.testing.assert_allclose(poles(model.a), poles(loop), rtol=0.0, atol=1e-12)
    assert model.spectral_radius() < 1.0
    # And the run moves so.
    pointing = scenario.simulate(log="full")["pointing"]
    _, first = np.unique(pointing["time_s"], return_index=True)
    motion = [np.concatenate([BEGINS, np.zeros(len(loop) - 3)])]
    for _ in range(120):
        motion.append(loop @ motion[-1])
    expected = np.array(motion)[:, :3]
    found = 2.0 * np.stack([pointing[f"q_{axis}"][first] for axis in "xyz"], axis=1)
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-6 * BEGINS.max())
    assert np.abs(expected[-1]).max() < 0.1 * BEGINS.max()


def test_named_signals_may_come_in_any_order() -> None:
    a, b, c, d = coupled(3, 6)
    order, rows = [4, 2, 0, 5, 1, 3], [2, 0, 1]
    plain = body().with_law((a, b, c, d), PERIOD)
    names = [ERRORS[k] for k in order]
    axes = [("roll", "pitch", "yaw")[k] for k in rows]
    turned = (a, b[:, order], c[rows], d[np.ix_(rows, order)])
    given = body().with_law(turned, PERIOD, inputs=names, outputs=axes)
    labelled = SimpleNamespace(
        **dict(zip("ABCD", turned, strict=True)),
        dt=0,
        input_labels=names,
        output_labels=[f"torque_{axis}" for axis in axes],
    )
    same = body().with_law(labelled, PERIOD)
    assert same == given
    for each in (given, same):
        np.testing.assert_allclose(
            poles(each.linearise(loop="command").closed().a),
            poles(plain.linearise(loop="command").closed().a),
            atol=1e-12,
        )
    # The vector part of the quaternion is half the angle.
    half = body().with_law(
        (a, np.hstack([2.0 * b[:, :3], b[:, 3:]]), c, np.hstack([2.0 * d[:, :3], d[:, 3:]])),
        PERIOD,
        inputs=["quaternion_x", "quaternion_y", "quaternion_z", *ERRORS[3:]],
    )
    np.testing.assert_allclose(
        half.linearise(loop="command").closed().a,
        plain.linearise(loop="command").closed().a,
        atol=1e-12,
    )


def test_what_designs_return_is_taken() -> None:
    a, b, _ = plant()
    # The regulator of angles and rates, for a rigid body.
    a, b = a[:6, :6], b[:6]
    x = solve_discrete_are(a, b, np.eye(6), np.eye(3))
    gain = np.linalg.solve(np.eye(3) + b.T @ x @ b, b.T @ x @ a)
    by_gain = body().with_law(gain, PERIOD)
    # (K, S, E) of control.lqr, and a list of rows.
    assert body().with_law((gain, x, np.zeros(6)), PERIOD) == by_gain
    assert body().with_law(gain.tolist(), PERIOD) == by_gain
    assert by_gain.linearise(loop="command").closed().spectral_radius() < 1.0
    # (K, CL, gamma, rcond) of control.hinfsyn.
    made = SimpleNamespace(**dict(zip("ABCD", coupled(3, 3), strict=True)), dt=0)
    assert body().with_law((made, None, 1.3, None), PERIOD) == body().with_law(coupled(3, 3), PERIOD)
    # One axis has gains of its own.
    one = flexsc.Scenario({"duration": 1.0, "law": {"open": {}}, "body": {"planar": {"inertia": 1.0}}})
    assert one.with_law(np.array([[2.0, 3.0]]), 0.1).to_dict()["law"]["state_space"]["d"] == [[2.0, 3.0]]


def test_what_python_control_designs() -> None:
    control = pytest.importorskip("control")
    scenario = body()
    model = scenario.linearise(period=PERIOD).select(outputs=ERRORS)
    cost = model.c.T @ np.diag([1.0] * 3 + [100.0] * 3) @ model.c
    gain, _, _ = control.dlqr(model.a, model.b, cost, 1e-3 * np.eye(3))
    noise = np.diag([1e-5**2] * 6)
    observer, _, _ = control.dlqe(model.a, model.b, model.c, 1e-6 * np.eye(3), noise)
    compensator = model.compensator(gain, observer)
    own = scenario.with_law(compensator)
    assert own == scenario.with_law(compensator.control())
    # The poles of the loop are those of regulator and observer.
    exact = np.concatenate(
        [np.linalg.eigvals(model.a - model.b @ gain), np.linalg.eigvals(model.a - observer @ model.c)]
    )
    found = np.linalg.eigvals(own.linearise(loop="command").closed().a)
    for pole in exact:
        assert np.abs(found - pole).min() < 1e-7, pole
    named = control.ss(*coupled(3, 6), inputs=["u", *ERRORS[1:]])
    with pytest.raises(flexsc.ScenarioError, match=r"inputs\[0\].*got `u`"):
        scenario.with_law(named, PERIOD)


def test_shapes_and_names_that_do_not_fit() -> None:
    scenario = body()
    a, b, c, d = coupled(3, 6)
    with pytest.raises(ValueError, match=r"inputs for 3.*or 6.*got 10.*Linear\.compensator"):
        scenario.with_law(np.ones((3, 10)), PERIOD)
    with pytest.raises(ValueError, match=r"three about roll, pitch, yaw.*got 2"):
        scenario.with_law(np.ones((2, 6)), PERIOD)
    with pytest.raises(ValueError, match=r"inputs must name 6 inputs of the controller, got 2"):
        scenario.with_law((a, b, c, d), PERIOD, inputs=["roll", "yaw"])
    with pytest.raises(ValueError, match=r"outputs must name 3 outputs of the controller, got 1"):
        scenario.with_law((a, b, c, d), PERIOD, outputs=["roll"])
    with pytest.raises(ValueError, match=r"among roll, pitch, yaw, torque_roll.*got 'force_yaw'"):
        scenario.with_law((a, b, c, d), PERIOD, outputs=["roll", "pitch", "force_yaw"])
    with pytest.raises(ValueError, match="needs command='acceleration', got 'torque'"):
        scenario.with_law((a, b, c, d), PERIOD, outputs=["acceleration_roll", "pitch", "yaw"])
    with pytest.raises(ValueError, match=r"B must have the shape \(3, 6\), of D \(3, 6\), got \(2, 6\)"):
        scenario.with_law((a, b[:2], c, d), PERIOD)
    with pytest.raises(flexsc.ScenarioError, match=r"law\.state_space\.inputs\[1\].*`quaternion_x`.*got `x`"):
        scenario.with_law(d[:, :3], PERIOD, inputs=["roll", "x", "yaw"])
    with pytest.raises(ValueError, match="one controller about three axes together"):
        scenario.with_law(dict.fromkeys(("roll", "pitch", "yaw"), d[:1, :2]), PERIOD, inputs=["roll"])
    model = scenario.linearise(period=PERIOD).select(outputs=ERRORS)
    with pytest.raises(ValueError, match=r"observer must have the shape \(10, 6\), got \(6, 10\)"):
        model.compensator(np.ones((3, 10)), np.ones((6, 10)))
    wheels = {"actuator": {"wheels": {"arrangement": "pyramid", "inertia": 0.01}}}
    damped = scenario.with_(wheels).with_law(1e-3 * np.ones((3, 1)), PERIOD, inputs=["wheel2_speed"])
    with pytest.raises(ValueError, match=r"is no state of the body.*`wheel2_speed`"):
        damped.linearise(loop="command")


def test_lqg_turns_the_earth_observer() -> None:
    program = runpy.run_path(str(Path(__file__).parents[1] / "golden" / "observer_lqg.py"))
    observer = shipped("earth-observer")
    law = program["compensator"](observer.linearise())
    own = observer.with_law((*law,), 0.25, command="acceleration")
    own = own.with_("law.state_space.of", "samples")
    file = shipped("earth-observer-lqg")
    for name, matrix in zip("abcd", law, strict=True):
        found = np.array(file.to_dict()["law"]["state_space"][name])
        # Small entries depend on the kernels of BLAS for the processor, by up to 3e-4 of themselves.
        assert np.abs(found - matrix).max() < 1e-6 * np.abs(matrix).max(), name
    # The mode at 2.07 rad/s is damped, and the loop is stable.
    loop = file.linearise(loop="command").closed()
    assert loop.spectral_radius() < 1.0
    assert loop.period == 0.5
    found = poles(loop.a)
    s = np.log(found[np.abs(found) > 1e-9]) / 0.5
    near = s[np.argmin(np.abs(s - 2.069j))]
    assert 0.04 < -near.real / abs(near) < 0.08
    body = np.linalg.eigvals(observer.linearise().a)
    near = body[np.argmin(np.abs(body - 2.069j))]
    assert -near.real / abs(near) < 0.01
    runs = [each.simulate(log="full") for each in (own, file)]
    for run in runs:
        assert run.metrics["goal"] == "met"
    np.testing.assert_allclose(runs[0]["pointing"]["roll_rad"], runs[1]["pointing"]["roll_rad"], atol=1e-6)
    states = runs[1]["law_states"]
    assert list(states) == ["time_s", *(f"x{k}" for k in range(8))]
    # A campaign of it: other noise, the same goal.
    table = flexsc.campaign(file.with_("duration", 200.0), runs=3)
    assert len(set(table["elastic_energy_peak_j"])) == 3


def test_h_infinity_loop_shaping() -> None:
    """Robust stabilisation of normalised coprime factors (McFarlane and Glover)."""
    # Torque to angles of a rigid body, shaped to a bandwidth of 0.1 rad/s about each axis.
    wn = 0.1
    a, b, c = np.zeros((6, 6)), np.zeros((6, 3)), np.zeros((3, 6))
    a[:3, 3:], b[3:], c[:, :3] = np.eye(3), wn**2 * np.eye(3), np.eye(3)
    x = solve_continuous_are(a, b, c.T @ c, np.eye(3))
    z = solve_continuous_are(a.T, c.T, b @ b.T, np.eye(3))
    gamma = 1.1 * np.sqrt(1.0 + np.abs(np.linalg.eigvals(x @ z)).max())
    f = -b.T @ x
    left = (1.0 - gamma**2) * np.eye(6) + x @ z
    into = gamma**2 * np.linalg.solve(left.T, z @ c.T)
    controller = a + b @ f + into @ c, into, b.T @ x, np.zeros((3, 3))
    # Closed with positive feedback of y, the norm of [K; 1] (1 - G K)^-1 [G 1] is at most gamma.
    for frequency in np.geomspace(1e-3, 10.0, 200):
        s = 1j * frequency * np.eye(6)
        g = c @ np.linalg.solve(s - a, b)
        k = controller[2] @ np.linalg.solve(s - controller[0], controller[1])
        inverse = np.linalg.inv(np.eye(3) - g @ k)
        whole = np.vstack([k, np.eye(3)]) @ inverse @ np.hstack([g, np.eye(3)])
        assert np.linalg.norm(whole, 2) < gamma * (1.0 + 1e-6)
    # The law's input is -y, and its output an acceleration.
    law = (controller[0], -controller[1], wn**2 * controller[2], controller[3])
    scenario = shipped("earth-observer").with_law(law, 0.25, command="acceleration")
    assert scenario.to_dict()["law"]["state_space"]["inputs"] == ["roll", "pitch", "yaw"]
    assert scenario.linearise(loop="command").closed().spectral_radius() < 1.0
    assert scenario.simulate(log="none").metrics["goal"] == "met"


class SlidingMode(flexsc.ThreeAxisLaw):
    """s = error of the rate + slope sign(q0) q, driven to 0 at a constant rate, within a layer without it."""

    period = 0.25
    signals = {"s": ("rad/s", 3), "inside": ""}  # noqa: RUF012

    def __init__(self, slope: float, reach: float, layer: float) -> None:
        self.slope, self.reach, self.layer = slope, reach, layer

    def start(self, authorities: Any) -> None:
        assert [authority.axis for authority in authorities] == [0, 1, 2]
        self.s, self.inside = np.zeros(3), 0.0

    def decide(self, event: ThreeAxisEvent) -> flexsc.ThreeAxisHold:
        w, *axis = event.quaternion
        error = np.subtract(event.rates, event.goal_rates)
        self.s = error + self.slope * np.copysign(1.0, w) * np.array(axis)
        self.inside = float(np.abs(self.s).max() < self.layer)
        push = -self.reach * np.clip(self.s / self.layer, -1.0, 1.0)
        return flexsc.ThreeAxisHold(accelerations=push + event.goal_accelerations)


def test_a_sliding_mode_on_quaternions() -> None:
    scenario = flexsc.Scenario(
        {
            "duration": 300.0,
            "log": {"period": 0.25},
            "law": {"open": {}},
            "body": {
                "spatial": {
                    "inertia": INERTIA.tolist(),
                    "attitude": [0.5, 0.5, -0.5, 0.5],
                    "rate": [0.01, -0.02, 0.005],
                }
            },
        }
    ).with_parts(law=SlidingMode(0.1, 2e-3, 1e-3))
    run = scenario.simulate(log="full")
    own = run["own_law"]
    assert list(own) == ["time_s", "s0", "s1", "s2", "inside"]
    s = np.stack([own[f"s{k}"] for k in range(3)], axis=1)
    # It reaches the surface in less than |s|/reach, and stays there: the angle then decays at half the slope.
    reached = int(np.argmax(own["inside"] > 0.0))
    assert 5.0 < own["time_s"][reached] < 1.2 * np.abs(s[0]).max() / 2e-3
    assert (own["inside"][reached:] == 1.0).all()
    pointing = run["pointing"]
    angles = np.stack([pointing[f"{axis}_rad"] for axis in ("roll", "pitch", "yaw")], axis=1)
    total = np.linalg.norm(angles, axis=1)
    first, last = (int(np.argmax(pointing["time_s"] >= time)) for time in (150.0, 250.0))
    assert np.log(total[first] / total[last]) / 100.0 == pytest.approx(0.05, rel=0.05)
    assert total[-1] < 1e-4
    # About the Earth observer it tracks the slew.
    observer = shipped("earth-observer").with_parts(law=SlidingMode(0.2, 3e-4, 1e-3))
    assert observer.simulate(log="none").metrics["goal"] == "met"


def test_what_a_law_about_three_axes_reads_and_returns() -> None:
    class Once(flexsc.ThreeAxisLaw):
        def __init__(self, returns: Any, period: float | None = 0.5) -> None:
            self.returns, self.period = returns, period

        def decide(self, event: ThreeAxisEvent) -> Any:
            if event.time > 0.0:
                return self.returns
            assert event.cause == "start"
            angle = np.linalg.norm(BEGINS)
            np.testing.assert_allclose(event.angles, BEGINS, atol=1e-15)
            np.testing.assert_allclose(event.quaternion, [np.cos(angle / 2), *(0.5 * BEGINS)], atol=1e-15)
            assert event.goal_rates == event.goal_angles == (0.0, 0.0, 0.0)
            np.testing.assert_allclose(event.rates, 0.0, atol=1e-28)
            assert event.wheel_speeds == [100.0, -50.0, 70.0, -20.0]
            assert "ThreeAxisEvent start at 0" in repr(event)
            return np.zeros(3)

    wheels = {"arrangement": "pyramid", "inertia": 0.01, "speeds": [100.0, -50.0, 70.0, -20.0]}
    scenario = body().with_("actuator", {"wheels": wheels})
    for returns, why in [
        ([1.0, 2.0], r"decide must return torques of shape \(3,\).*got shape \(2,\)"),
        (np.zeros((3, 1)), r"got shape \(3, 1\)"),
        (3.0, r"ThreeAxisHold, got float"),
        ([0.0, np.nan, 0.0], r"law: torques must be finite numbers of shape \(3,\), got \[0.0, NaN, 0.0\]"),
    ]:
        with pytest.raises(ValueError, match=why):
            scenario.with_parts(law=Once(returns)).simulate()
    with pytest.raises(ValueError, match="no period and its hold gives no time"):
        scenario.with_parts(law=Once(np.zeros(3), period=None)).simulate()
    with pytest.raises(ValueError, match="exactly one of torques, accelerations and moments"):
        flexsc.ThreeAxisHold()
    one = flexsc.Scenario({"duration": 1.0, "law": {"open": {}}, "body": {"planar": {"inertia": 1.0}}})
    with pytest.raises(flexsc.ScenarioError, match=r"three axes.*use a flexsc\.Law"):
        one.with_parts(law=Once(np.zeros(3)))
    assert scenario.with_parts(law=Once([0.0, 0.0, 0.0])).simulate(log="none").metrics["goal"]
