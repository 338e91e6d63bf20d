"""Runs in steps: the same as whole runs, snapshots, clones, many together, and what is refused."""

import copy
import pickle
from typing import Any

import flexsc
import numpy as np
import pytest
from conftest import shipped
from flexsc import Simulator, Simulators

UNCERTAIN = {
    "name": "uncertain",
    "seed": 11,
    "duration": 30.0,
    "body": {
        "spatial": {
            "inertia": [[100.0, 2.0, 0.0], [2.0, 80.0, 1.0], [0.0, 1.0, 60.0]],
            "rate": [0.01, -0.02, 0.015],
            "points": [{"name": "hub"}],
            "modes": [
                {"frequency": 1.3, "damping": 0.02, "shapes": {"hub": {"rotation": [0.02, 0.01, 0.03]}}}
            ],
        }
    },
    "sensor": {"sampled": {"period": 0.25, "noise": 1e-4, "rate_noise": 1e-5}},
    "law": {"pd": {"k_p": 4.0, "k_d": 30.0, "period": 0.25}},
    "actuator": {"wheels": {"arrangement": "pyramid", "inertia": 0.05, "torque": 0.5, "momentum": 10.0}},
    "uncertain": {
        "body.spatial.modes[0].frequency": {"uniform": [1.1, 1.5]},
        "body.spatial.rate[0]": {"uniform": [0.005, 0.015]},
    },
}


def everything(sim: Simulator | Simulators) -> dict[str, np.ndarray[Any, Any]]:
    groups = {"state": sim.state, "measured": sim.measured, "believed": sim.believed}
    return {f"{group}.{name}": values for group, of in groups.items() for name, values in of.items()}


def same(one: dict[str, Any], other: dict[str, Any]) -> None:
    assert one.keys() == other.keys()
    for name, values in one.items():
        np.testing.assert_array_equal(values, other[name], name)


@pytest.fixture(scope="module")
def uncertain() -> flexsc.Scenario:
    return flexsc.Scenario(UNCERTAIN)


@pytest.mark.parametrize("dt", [0.1, 0.25, 1.7])
def test_steps_come_to_what_the_run_comes_to(uncertain: flexsc.Scenario, dt: float) -> None:
    whole = Simulator(uncertain, 3)
    assert whole.run_until(uncertain.duration)
    assert whole.done
    steps = Simulator(uncertain, 3)
    while not steps.done:
        steps.step(None, dt)
    assert steps.time == uncertain.duration
    same(everything(steps), everything(whole))
    # And what the log of the run holds at its end.
    run = uncertain.with_("log.period", 30.0).simulate(3, log="full")
    np.testing.assert_array_equal(steps.state["rate"], run["rates"]["axes.rate_rad_s"][-1])
    np.testing.assert_array_equal(steps.measured["rate"], run["rates"]["axes.measured_rad_s"][-1])
    np.testing.assert_array_equal(steps.believed["rate"], run["rates"]["axes.believed_rad_s"][-1])
    np.testing.assert_array_equal(steps.state["modes"], run["vibrations"]["modes.displacement"][-1])
    np.testing.assert_array_equal(steps.state["wheel_speeds"], run["wheels"]["wheels.speed_rad_s"][-1])
    quaternion = [run["pointing"][f"q_{part}"][-1] for part in "wxyz"]
    np.testing.assert_array_equal(steps.state["attitude"], quaternion)


def test_one_angle_is_stepped_too(sampled: flexsc.Scenario) -> None:
    sim = Simulator(sampled, 2)
    while not sim.done:
        sim.step(None, 3.3)
    run = sampled.with_("log.period", 1000.0).simulate(2, log="full")
    for name, column in [("angle", "angle_rad"), ("rigid_angle", "rigid_rad")]:
        assert sim.state[name].shape == ()
        assert sim.state[name] == run["attitude"][column][-1]
    assert sim.measured["angle"] == run["attitude"]["measured_rad"][-1]
    np.testing.assert_array_equal(sim.state["modes"], run["modes"]["modes.displacement_rad"][-1])
    np.testing.assert_array_equal(sim.state["mode_rates"], run["modes"]["modes.rate_rad_s"][-1])


def test_commands_take_the_place_of_the_law() -> None:
    # 2 kg m² under 0.5 N m, then -1 N m.
    body = {"planar": {"inertia": 2.0}}
    sim = Simulator(flexsc.Scenario({"duration": 10.0, "law": {"open": {}}, "body": body}))
    assert (sim.axes, sim.command_unit, sim.state.units["torque"]) == (1, "N m", "N m")
    sim.step(0.5, 4.0)
    assert sim.state["rate"] == 1.0
    assert sim.state["angle"] == 2.0
    assert sim.state["torque"] == 0.5
    sim.step(None, 1.0)
    assert sim.state["rate"] == 1.25, "a command lasts"
    sim.step([-1.0], 2.0)
    assert sim.state["rate"] == 0.25
    before = sim.state
    sim.step(0.0, 100.0)
    assert sim.done
    assert sim.time == 10.0
    assert before["rate"] == 0.25
    assert before["angle"] != sim.state["angle"], "what was read stays"
    sim.step(1.0, 1.0)
    assert sim.time == 10.0, "a run that is over stays where it is"


def test_wheels_execute_commands_within_their_limits(uncertain: flexsc.Scenario) -> None:
    sim = Simulator(uncertain)
    most = sim.command_limit
    assert most.shape == (3,)
    assert np.isfinite(most).all()
    sim.step([100.0, 0.0, 0.0], 0.5)
    assert sim.state["torque"][0] == pytest.approx(most[0])
    assert np.abs(sim.state["torque"][1:]).max() < 1e-12


def test_a_law_from_outside_is_that_of_the_scenario() -> None:
    # Held for a second, as the law of the scenario is.
    sim = Simulator(shipped("four-clamped-modes").with_("spacecraft.whole_damping", True))
    while sim.time < 10.0:
        q, rate = sim.state["attitude"], sim.state["rate"]
        sim.step(np.clip(-30.0 * q[1:] / (1.0 + q[0]) - 60.0 * rate, -1.0, 1.0), 1.0)
    q = sim.state["attitude"]
    # tests/golden/outside_oracle.py: Runge-Kutta of order 8 on the body's own equations.
    np.testing.assert_allclose(q[1:] / (1.0 + q[0]), [0.1684178601, 0.01825439783, -0.1075669416], rtol=1e-9)
    exact = [-0.08445766623, -0.01487397736, 0.06782833490]
    np.testing.assert_allclose(sim.state["rate"], exact, rtol=2e-9)


def test_runs_go_on_to_events(adaptive: flexsc.Scenario, uncertain: flexsc.Scenario) -> None:
    run = adaptive.with_("duration", 2500.0).simulate()
    sim = Simulator(adaptive.with_("duration", 2500.0))
    times = []
    while sim.run_until("switching"):
        times.append(sim.time)
    np.testing.assert_array_equal(times, run["command"]["time_s"])
    assert sim.done
    sim = Simulator(adaptive)
    assert sim.run_until("window")
    assert sim.time == 500.0
    sim = Simulator(uncertain)
    assert sim.run_until("sample")
    assert sim.time == 0.25
    assert sim.run_until("decision")
    assert sim.time == 0.5
    assert not sim.run_until("sample", limit=0.6)
    assert sim.time == 0.6
    assert not sim.run_until(100.0)
    assert sim.done


def test_what_is_measured_at_an_instant_can_be_acted_on_at_once(uncertain: flexsc.Scenario) -> None:
    first = Simulator(uncertain)
    assert not np.array_equal(first.measured["rate"], first.state["rate"]), "noise at the start"
    first.step(None, 0.25)
    before = first.measured["rate"]
    second = first.clone()
    first.step([0.1, 0.0, 0.0], 0.25)
    second.step([0.2, 0.0, 0.0], 0.25)
    assert not np.array_equal(first.measured["rate"], before)
    gain = second.state["rigid_rate"] - first.state["rigid_rate"]
    # A quarter of a second under 0.1 N m more.
    assert gain[0] == pytest.approx(0.1 * 0.25 / 100.0, rel=0.01)


def test_snapshots_are_returned_to(uncertain: flexsc.Scenario) -> None:
    sim = Simulator(uncertain, 5)
    sim.step(None, 3.1)
    snapshot = sim.snapshot()
    told = []
    for _ in range(2):
        sim.step([0.1, -0.2, 0.0], 4.0)
        sim.step(None, 1.3)
        told.append(everything(sim))
        sim.restore(snapshot)
        assert sim.time == snapshot.time == 3.1
    same(*told)
    # It goes on by its law again.
    sim.step(None, 1.0)
    whole = Simulator(uncertain, 5)
    whole.run_until(sim.time)
    same(everything(sim), everything(whole))
    with pytest.raises(ValueError, match="another scenario"):
        Simulator(uncertain.with_("duration", 31.0)).restore(snapshot)


def test_clones_go_their_own_ways(uncertain: flexsc.Scenario) -> None:
    sim = Simulator(uncertain, 1)
    sim.step(None, 2.0)
    clones = [sim.clone(), copy.copy(sim), copy.deepcopy(sim)]
    for clone in clones:
        clone.step([0.3, 0.3, 0.3], 5.0)
    assert sim.time == 2.0
    sim.step(None, 5.0)
    whole = Simulator(uncertain, 1)
    whole.run_until(7.0)
    same(everything(sim), everything(whole))
    same(everything(clones[0]), everything(clones[1]))
    same(everything(clones[0]), everything(clones[2]))
    assert not np.array_equal(sim.state["rate"], clones[0].state["rate"])
    with pytest.raises(TypeError):
        pickle.dumps(sim.snapshot())


@pytest.mark.parametrize("jobs", [0, 1, 2, 8])
def test_many_are_what_each_is_alone(uncertain: flexsc.Scenario, jobs: int) -> None:
    runs = [4, 0, 7, *range(20, 60)]
    sims = Simulators(uncertain, runs, jobs)
    commands = np.random.default_rng(2).uniform(-0.3, 0.3, (6, len(runs), 3))
    for index in range(6):
        state = sims.step(None if index == 0 else commands[index], 0.37)
        assert state["rate"].shape == (len(runs), 3)
        assert state["attitude"].shape == (len(runs), 4)
    together = everything(sims)
    for place, run in enumerate(runs):
        alone = Simulator(uncertain.draw(run), run)
        for index in range(6):
            alone.step(None if index == 0 else commands[index, place], 0.37)
        same(everything(alone), {name: values[place] for name, values in together.items()})
    assert len(np.unique(together["state.rate"][:, 0])) == len(runs), "each has its own keys and noise"
    same(everything(sims[2]), {name: values[2] for name, values in together.items()})
    np.testing.assert_array_equal(sims.runs, runs)
    np.testing.assert_array_equal(sims.time, np.full(len(runs), 2.22))


def test_copies_begin_anew(uncertain: flexsc.Scenario) -> None:
    sims = Simulators(uncertain, 6)
    start = everything(sims)
    sims.step(np.ones((6, 3)), 1.0)
    went = everything(sims)
    mask = np.array([True, False, False, True, False, False])
    sims.reset(mask)
    after = everything(sims)
    same({name: values[mask] for name, values in after.items()}, {n: v[mask] for n, v in start.items()})
    same({name: values[~mask] for name, values in after.items()}, {n: v[~mask] for n, v in went.items()})
    np.testing.assert_array_equal(sims.time, np.where(mask, 0.0, 1.0))
    sims.reset(runs=np.arange(10, 16))
    other = Simulators(uncertain, range(10, 16))
    same(everything(sims), everything(other))
    sims.step(None, 100.0)
    assert sims.done.all()
    assert (sims.time == uncertain.duration).all()
    assert not np.array_equal(Simulators(uncertain, 2, seed=3).measured["rate"], start["measured.rate"][:2])


def test_some_of_them_go_on(uncertain: flexsc.Scenario) -> None:
    sims, mask = Simulators(uncertain, 3), np.array([True, False, True])
    sims.step(None, 1.0, mask)
    np.testing.assert_array_equal(sims.time, [1.0, 0.0, 1.0])


def test_copies_that_cannot_go_on_are_named() -> None:
    values = {
        "duration": 10.0,
        "law": {"open": {}},
        "body": {"planar": {"inertia": 1.0, "rate": 0.0}},
        "uncertain": {"body.planar.rate": {"uniform": [0.0, 1.0]}},
    }
    sims = Simulators(flexsc.Scenario(values), 8)
    commands = np.zeros((8, 1))
    # Rates beyond 1e100 rad/s end a run.
    commands[[2, 5]] = 9e99
    sims.step(commands, 1.0)
    with pytest.raises(flexsc.SimulationError, match="2 of 8 copies cannot go on") as raised:
        sims.step(commands * 1.5, 9.0)
    assert "copy 2, run 2: the state is no longer finite" in str(raised.value)
    np.testing.assert_array_equal(np.flatnonzero(sims.failed), [2, 5])
    assert np.isnan(sims.state["rate"][[2, 5]]).all()
    assert np.isfinite(np.delete(sims.state["rate"], [2, 5])).all()
    sims.reset(sims.failed)
    assert not sims.failed.any()
    assert sims.time[2] == 0.0


def test_bad_arguments_are_told(uncertain: flexsc.Scenario) -> None:
    sim, sims = Simulator(uncertain), Simulators(uncertain, 4)
    for bad in (0.0, -1.0, float("nan"), float("inf")):
        with pytest.raises(ValueError, match="dt must be a time"):
            sim.step(None, bad)
        with pytest.raises(ValueError, match="dt must be a time"):
            sims.step(None, bad)
    for command in (1.0, [1.0, 2.0], np.zeros((3, 1))):
        with pytest.raises(ValueError, match=r"must have shape \(3,\)"):
            sim.step(command, 0.1)
    with pytest.raises(ValueError, match=r"must have shape \(4, 3\), got \(3,\)"):
        sims.step([0.0, 0.0, 0.0], 0.1)
    with pytest.raises(ValueError, match=r"finite numbers of N m, not so at \[1\]"):
        sim.step([0.0, np.nan, 0.0], 0.1)
    with pytest.raises(ValueError, match="must be numbers"):
        sim.step(["a", "b", "c"], 0.1)
    with pytest.raises(ValueError, match="an event is 'sample'"):
        sim.run_until("noon")  # type: ignore[arg-type]
    sim.step(None, 1.0)
    with pytest.raises(ValueError, match=r"cannot go on to 0\.5 s"):
        sim.run_until(0.5)
    with pytest.raises(KeyError, match=r"no quantity 'rates'; did you mean 'rate'\? there are"):
        sim.state["rates"]
    with pytest.raises(ValueError, match="read-only"):
        sim.state["rate"][0] = 1.0
    with pytest.raises(ValueError, match="a mask must be 4 of bool"):
        sims.reset(np.array([True]))
    with pytest.raises(ValueError, match="runs must be 4 whole numbers"):
        sims.reset(runs=[1.5, 2, 3, 4])
    with pytest.raises(ValueError, match="one or more"):
        Simulators(uncertain, 0)
    with pytest.raises(ValueError, match="jobs must be from 0 to 1024, got 1025"):
        Simulators(uncertain, 1, jobs=1025)
    assert sim.time == 1.0
    assert (sims.time == 0.0).all(), "nothing moved"


def test_the_number_of_copies_is_bounded() -> None:
    with pytest.raises(ValueError, match="runs must be at most 10000000"):
        flexsc.Simulators(shipped("relay-fixed"), 10**12)
