"""The spatial body in Python: its columns, and its modes against another integrator."""

import flexsc
import numpy as np
import pytest
from conftest import shipped
from scipy.integrate import solve_ivp


def test_a_run_has_columns_of_three_axes() -> None:
    scenario = shipped("iss-manoeuvre-off").with_("duration", 60.0)
    run = scenario.simulate(log="full")
    rows = len(run["pointing"]["time_s"])
    assert rows == 601
    assert run["rates"]["axes.measured_rad_s"].shape == (rows, 3)
    assert run["vibrations"]["modes.energy_j"].shape == (rows, 12)
    energy = run["energy"]["elastic_j"]
    np.testing.assert_allclose(run["vibrations"]["modes.energy_j"].sum(axis=1), energy, rtol=1e-12)
    quaternion = np.array([run["pointing"][name] for name in ("q_w", "q_x", "q_y", "q_z")])
    np.testing.assert_allclose(np.linalg.norm(quaternion, axis=0), 1.0, atol=1e-15)
    assert run["jets"]["fuel_kg"][-1] == run.metrics["fuel_kg"]
    assert np.count_nonzero(run["jets"]["yaw_on_s"]) > 10
    assert "12 modes" in repr(scenario)


def test_modes_and_what_is_not_for_spatial_bodies() -> None:
    scenario = shipped("iss-manoeuvre-off")
    modes = scenario.modes
    assert modes["influence"].shape == (12, 3)
    assert modes["influence"][3, 2] == pytest.approx(2.89, rel=0.01)
    assert (modes["influence"] > -1e-3).all()
    assert scenario.outputs == {}
    papers = flexsc.papers
    for refused in (papers.rigid_cycles, lambda s: s.plan(), lambda s: papers.gain_region(s, [0.1])):
        with pytest.raises(ValueError, match="three axes"):
            refused(scenario)


def test_a_ring_down_is_that_of_another_integrator() -> None:
    scenario = shipped("iss-ringdown-off").with_({"duration": 30.0, "log.period": 3.0})
    seen = scenario.simulate(log="full")["vibrations"]["modes.displacement"]
    body = scenario.to_dict()["body"]["spatial"]
    for index in (3, 4):
        mode = body["modes"][index]
        w, zeta = mode["frequency"], mode["damping"]
        exact = solve_ivp(
            lambda _, y, w=w, zeta=zeta: [y[1], -w * w * y[0] - 2 * zeta * w * y[1]],
            (0.0, 30.0),
            [0.0, mode["rate"]],
            method="DOP853",
            t_eval=np.arange(0.0, 30.1, 3.0),
            rtol=1e-12,
            atol=1e-14,
        )
        np.testing.assert_allclose(seen[:, index], exact.y[0], atol=1e-10)


def test_a_damped_run_tells_what_its_observers_know() -> None:
    run = shipped("iss-ringdown").with_({"duration": 60.0, "log.period": 60.0}).simulate(log="full")
    tracking = run["tracking"]
    rows = len(tracking["time_s"])
    assert rows == 301
    assert tracking["channels.acted_on_rad_s"].shape == (rows, 3)
    assert tracking["trackers.axis"].shape == (rows, 6)
    found, truth = tracking["trackers.frequency_rad_s"], tracking["trackers.true_frequency_rad_s"]
    errors = np.asarray(run.metrics["frequency_estimate_errors"])
    np.testing.assert_allclose(found[-1] / truth[-1] - 1.0, errors, atol=1e-12)
    elastic = tracking["channels.true_elastic_rad_s"]
    assert np.abs(elastic[-50:]).max() < 0.15 * np.abs(elastic[:50]).max()
    assert run.metrics["damping_cycles"] > 20
