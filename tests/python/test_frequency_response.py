"""Poles, frequency responses and their figures against SciPy, python-control and closed forms."""

from __future__ import annotations

from importlib import import_module
from typing import Any

import flexsc
import flexsc.plot
import numpy as np
import pytest
from conftest import shipped
from scipy.linalg import eigvals
from scipy.optimize import minimize_scalar
from scipy.signal import StateSpace, dfreqresp, freqresp

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("agg")
control = pytest.importorskip("control")

BODY = """
duration = 30.0
[law.pd]
k_p = 40.0
k_d = 250.0
period = 0.5
[body.planar]
inertia = 250.0
modes = [{ frequency = 1.3, gain = 0.4, damping = 1e-4 }, { frequency = 4.0, gain = 0.1, damping = 5e-3 }]
"""
MODES = [(1.3, 0.4, 1e-4), (4.0, 0.1, 5e-3)]


def body() -> flexsc.Linear:
    return flexsc.Scenario.parse(BODY).linearise()


def angle(w: Any) -> Any:
    """The angle for a torque of 1 N m, in closed form."""
    modes = sum(k / (w0**2 - w**2 + 2j * zeta * w0 * w) for w0, k, zeta in MODES)
    return (-1.0 / w**2 + modes) / 250.0


@pytest.fixture(autouse=True)
def closed_figures() -> Any:
    yield
    import_module("matplotlib.pyplot").close("all")


def test_a_response_is_that_of_the_equations() -> None:
    model = body()
    w = model.frequency_grid()
    np.testing.assert_allclose(model.select(outputs=["angle"]).response()[:, 0, 0], angle(w), rtol=1e-9)
    assert model.response([0.5, 0.7]).shape == (2, 8, 1)


# SciPy makes polynomials of the matrices.
@pytest.mark.filterwarnings("ignore::scipy.signal.BadCoefficients")
@pytest.mark.parametrize("period", [None, 0.2])
def test_a_response_is_that_of_scipy(period: float | None) -> None:
    model = flexsc.Scenario.parse(BODY).linearise(period=period).select(outputs=["rate"])
    w = np.geomspace(0.01, 14.0, 60)
    if period is None:
        _, expected = freqresp(StateSpace(model.a, model.b, model.c, model.d), w)
    else:
        system = StateSpace(model.a, model.b, model.c, model.d, dt=period)
        _, expected = dfreqresp(system, w * period)
    np.testing.assert_allclose(model.response(w)[:, 0, 0], expected, rtol=1e-6)


@pytest.mark.parametrize("loop", [None, "command"])
def test_a_response_of_three_axes_is_that_of_control(loop: Any) -> None:
    model = shipped("earth-observer").linearise(loop=loop)
    w = np.geomspace(0.01, 6.0, 40)
    at = 1j * w if loop is None else np.exp(1j * w * 0.5)
    system = model.control()
    np.testing.assert_allclose(model.response(w), np.array([system(z) for z in at]), rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("delay", [None, 0.1])
def test_the_grid_meets_the_peaks(delay: float | None) -> None:
    model = body() if delay is None else body().sampled(0.2, delay)
    grid = model.frequency_grid()
    assert (np.diff(grid) > 0.0).all()
    assert np.diff(np.log(grid)).max() < 0.012
    assert grid[-1] == pytest.approx(40.0 if delay is None else np.pi / 0.2)
    found = np.abs(model.response())[:, [o.name for o in model.outputs].index("angle"), 0]
    for w0, _, zeta in MODES:
        near = np.abs(grid / w0 - 1.0) < 20 * zeta
        assert near.sum() > 300
        if delay is None:
            width = zeta * w0
            true = minimize_scalar(
                lambda w: -abs(angle(w)), bounds=(w0 - width, w0 + width), options={"xatol": 1e-12}
            )
            assert found[near].max() == pytest.approx(-true.fun, rel=1e-6)
        else:
            # The poles z and their residues, from matrices that SciPy factors.
            dense = w0 * (1.0 + zeta * np.linspace(-1.0, 1.0, 20001))
            finer = np.abs(model.select(outputs=["angle"]).response(dense)).max()
            assert found[near].max() == pytest.approx(finer, rel=1e-6)
    if delay is None:
        # The largest response of a mode alone: k / (2 zeta w0^2 sqrt(1 - zeta^2)).
        mode = np.abs(model.select(outputs=["mode0_displacement"]).response()).max()
        expected = 0.4 / 250.0 / (2e-4 * 1.3**2 * np.sqrt(1.0 - 1e-8))
        assert mode == pytest.approx(expected, rel=1e-6)


def test_undamped_and_rigid_bodies_have_a_grid() -> None:
    rigid = flexsc.Scenario({"duration": 1.0, "body": {"planar": {"inertia": 2.0}}, "law": {"open": {}}})
    grid = rigid.linearise().frequency_grid()
    assert (grid[0], grid[-1]) == (pytest.approx(0.1), pytest.approx(10.0))
    assert rigid.linearise(period=0.1).frequency_grid()[-1] == pytest.approx(np.pi / 0.1)
    undamped = shipped("relay-fixed").linearise()
    values = undamped.response()
    assert np.isfinite(values).all()
    assert np.abs(values[:, 0, 0]).max() > 1e4 * np.abs(undamped.response([0.3])[0, 0, 0])
    # There is no value at a pole.
    assert np.isnan(undamped.response([0.0, 0.3])[0]).all()
    assert np.isfinite(undamped.response([0.0, 0.3])[1]).all()
    with pytest.raises(ValueError, match="finite numbers of shape"):
        undamped.response([[1.0]])
    with pytest.raises(ValueError, match="finite numbers of shape"):
        undamped.response([np.nan])


@pytest.mark.parametrize("period", [None, 0.2])
def test_poles_have_frequencies_and_damping_ratios(period: float | None) -> None:
    poles = flexsc.Scenario.parse(BODY).linearise(period=period).poles()
    np.testing.assert_allclose(poles["frequency"], [0, 0, 1.3, 1.3, 4.0, 4.0], rtol=1e-9)
    assert np.isnan(poles["damping"][:2]).all()
    np.testing.assert_allclose(poles["damping"][2:], [1e-4, 1e-4, 5e-3, 5e-3], rtol=1e-6)
    s = np.array([-z * w + way * 1j * w * np.sqrt(1 - z**2) for w, _, z in MODES for way in (-1, 1)])
    expected = s if period is None else np.exp(s * period)
    np.testing.assert_allclose(poles["pole"][2:], expected, rtol=1e-9)


def test_poles_of_a_closed_loop_are_those_of_control() -> None:
    closed = shipped("earth-observer").linearise(loop="command").closed()
    found, expected = closed.poles(), control.poles(closed.control())
    np.testing.assert_allclose(np.sort(np.abs(found["pole"])), np.sort(np.abs(expected)), atol=1e-9)
    frequency, damping, pole = control.damp(closed.control(), doprint=False)
    for k in range(10):
        at = np.argmin(np.abs(pole - found["pole"][-1 - k]))
        assert found["frequency"][-1 - k] == pytest.approx(frequency[at], rel=1e-6)
        assert found["damping"][-1 - k] == pytest.approx(damping[at], rel=1e-6)
    # What is forgotten within a period has no frequency.
    deadbeat = body().sampled(0.2, 0.2).poles()
    assert (deadbeat["pole"][-1], deadbeat["frequency"][-1], deadbeat["damping"][-1]) == (0.0, np.inf, 1.0)


@pytest.mark.parametrize("period", [None, 0.1])
def test_bode_has_magnitude_and_phase(period: float | None) -> None:
    model = flexsc.Scenario.parse(BODY).linearise(period=period).select(outputs=["angle", "rate"])
    above, below = flexsc.plot.bode(model)
    expected = control.frequency_response(model.control(), above.lines[0].get_xdata())
    for k in range(2):
        w, magnitude = above.lines[k].get_data()
        np.testing.assert_allclose(
            10.0 ** (np.asarray(magnitude) / 20.0), expected.magnitude[k, 0], rtol=1e-9
        )
        phase = np.radians(np.asarray(below.lines[k].get_ydata()))
        np.testing.assert_allclose(np.exp(1j * (phase - expected.phase[k, 0])), 1.0, atol=1e-6)
        # The phase turns at each zero and pole, and not by leaps.
        assert np.abs(np.diff(phase)).max() < 1.0
        assert -2 * np.pi < phase[0] <= 0.02
        pencil = np.block([[model.a, model.b], [model.c[k : k + 1], model.d[k : k + 1]]])
        zeros: Any = eigvals(pencil, np.diag([1.0] * 6 + [0.0]))
        zeros = zeros[np.isfinite(zeros)]
        sharp = zeros if period is None else np.log(zeros[np.abs(zeros) > 1e-9]) / period
        for zero in sharp[(sharp.imag > 0.1) & (sharp.imag < 10.0) & (np.abs(sharp.real) < 0.1)]:
            assert (np.abs(np.asarray(w) - zero.imag) < np.abs(zero.real)).sum() >= 10
    legend: Any = above.get_legend()
    assert [text.get_text() for text in legend.get_texts()] == ["angle", "rate"]
    own = model.select(outputs=["rate"]).bode((above, below), frequencies=[0.1, 1.0])
    assert own == (above, below)
    assert len(above.lines) == (3 if period is None else 5)


def test_nichols_has_contours_of_the_closed_loop() -> None:
    opened = flexsc.Scenario.parse(BODY).linearise(loop="command")
    ax = opened.nichols()
    phase, magnitude = (np.asarray(values) for values in ax.lines[0].get_data())
    loop = 10.0 ** (magnitude / 20.0) * np.exp(1j * np.radians(phase))
    # The same points as those of the response, from the same grid on.
    w = opened.frequency_grid()
    start = opened.response(w[:1])[0, 0, 0]
    assert loop[0] == pytest.approx(start, rel=1e-9)
    levels = set()
    for line in ax.lines[1:-1]:
        phase, magnitude = (np.asarray(values) for values in line.get_data())
        each = 10.0 ** (magnitude / 20.0) * np.exp(1j * np.radians(phase))
        closed = 20.0 * np.log10(np.abs(each / (1.0 + each)))
        assert np.ptp(closed) < 1e-6
        levels.add(round(float(closed[0]), 6))
    assert levels == {0.0, 3.0, 6.0, 12.0}
    assert -180.0 in np.asarray(ax.lines[-1].get_xdata())


def test_opened_loops_of_three_axes_have_a_line_for_each_command() -> None:
    opened = shipped("earth-observer").linearise(loop="command")
    ax = flexsc.plot.nichols(opened, frequencies=[0.01, 0.1, 1.0])
    assert [line.get_label() for line in ax.lines[:6]] == [signal.name for signal in opened.inputs]
    with pytest.raises(ValueError, match="28 outputs and 3 inputs, 84 lines"):
        flexsc.plot.bode(shipped("earth-observer").linearise())
    names = [
        line.get_label()
        for line in shipped("earth-observer").linearise().select(outputs=["roll"]).bode()[0].lines
    ]
    assert names == ["roll / torque_roll", "roll / torque_pitch", "roll / torque_yaw"]


@pytest.mark.parametrize("period", [None, 0.2])
def test_poles_are_drawn_with_the_limit_of_stability(period: float | None) -> None:
    model = flexsc.Scenario.parse(BODY).linearise(period=period)
    ax = flexsc.plot.poles(model)
    limit, crosses = ax.lines
    found = np.asarray(crosses.get_xdata()) + 1j * np.asarray(crosses.get_ydata())
    np.testing.assert_allclose(
        np.sort_complex(found), np.sort_complex(np.linalg.eigvals(model.a).astype(np.complex128)), atol=1e-9
    )
    there = np.asarray(limit.get_xdata()) + 1j * np.asarray(limit.get_ydata())
    on = there.real if period is None else np.abs(there) - 1.0
    np.testing.assert_allclose(on, 0.0, atol=1e-12)
