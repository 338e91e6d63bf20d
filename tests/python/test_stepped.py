"""A stepped run has everything that a run has: metrics, columns, samples, logs and figures."""

import pickle
from pathlib import Path
from typing import Any

import flexsc
import flexsc.plot
import numpy as np
import pytest
from conftest import Command, shipped
from flexsc import Simulator, Simulators, _result

# One of each kind of motion, law, filter and actuator, and how much of it is flown (s).
FLOWN = {
    "relay-adaptive": 1500.0,
    "relay-wheel": 300.0,
    "wheel-ekf": 30.0,
    "rotation-thrusters": 20.0,
    "four-clamped-modes-faults": 40.0,
    "earth-observer": 40.0,
    "canted-jets": 40.0,
    "wheel-friction": 60.0,
}


def flown(name: str) -> flexsc.Scenario:
    return shipped(name).with_("duration", FLOWN[name])


def same_metrics(one: flexsc.Metrics, other: flexsc.Metrics) -> None:
    assert one.keys() == other.keys()
    for name, value in one.items():
        if isinstance(value, float | np.ndarray):
            # A sum over the last piece of a motion may round elsewhere where the run is cut.
            np.testing.assert_allclose(value, other[name], rtol=1e-14, err_msg=name)
        else:
            assert value == other[name], name


@pytest.mark.parametrize("name", FLOWN)
def test_without_commands_the_log_has_the_bytes_of_the_run(name: str, tmp_path: Path) -> None:
    scenario = flown(name)
    sim, whole = Simulator(scenario, 3), scenario.simulate(3, "full")
    while not sim.done:
        sim.step(None, FLOWN[name] / 7.3)
    same_metrics(sim.metrics, whole.metrics)
    details: tuple[_result.Logged, ...] = ("events", "full", "scene")
    for detail in details:
        whole.to_mcap(tmp_path / "whole.mcap", detail)
        size = sim.to_mcap(tmp_path / "steps.mcap", detail)
        assert (tmp_path / "steps.mcap").stat().st_size == size
        assert (tmp_path / "steps.mcap").read_bytes() == (tmp_path / "whole.mcap").read_bytes()
    result = sim.result("full")
    assert result.topics == whole.topics
    for topic in whole:
        for column, values in whole[topic].items():
            if values.dtype != object:
                np.testing.assert_array_equal(result[topic][column], values)


def test_the_log_is_that_of_the_command(tmp_path: Path, command: Command) -> None:
    scenario = flown("earth-observer").with_("seed", 5)
    (tmp_path / "earth.toml").write_text(scenario.to_toml())
    command("simulate", "earth.toml", "--log", "full", "--out", "out")
    sim = Simulator(flexsc.Scenario.load(tmp_path / "earth.toml"))
    sim.run_until(scenario.duration)
    sim.to_mcap(tmp_path / "steps.mcap", "full")
    assert (tmp_path / "steps.mcap").read_bytes() == next((tmp_path / "out").glob("*.mcap")).read_bytes()


@pytest.mark.parametrize("name", FLOWN)
def test_metrics_so_far_are_those_of_a_run_that_ends_now(name: str) -> None:
    scenario = flown(name)
    until = FLOWN[name] / 2.0
    sim = Simulator(scenario)
    sim.run_until(until)
    shorter = scenario.with_("duration", until).simulate().metrics
    same_metrics(sim.metrics, shorter)


def commanded(scenario: flexsc.Scenario) -> Simulator:
    sim = Simulator(scenario)
    limit = np.where(np.isfinite(sim.command_limit), sim.command_limit, 1e-3)
    for k in range(8):
        sim.step(0.3 * limit * np.cos(k + np.arange(sim.axes)), 0.77)
        sim.step(None, 0.5)
    return sim


def test_a_commanded_run_is_sampled_at_any_instant() -> None:
    scenario = shipped("relay-fixed")
    sim, seen = Simulator(scenario), []
    for k in range(6):
        sim.step(1e-5 * np.cos(k), 0.77)
        seen.append((sim.time, float(sim.state["angle"]), float(sim.state["rate"])))
    samples = sim.result("none").sample([time for time, _, _ in seen])
    np.testing.assert_array_equal(samples["attitude"]["angle_rad"], [angle for _, angle, _ in seen])
    np.testing.assert_array_equal(samples["rate"]["rate_rad_s"], [rate for _, _, rate in seen])
    # One at a time, from the last: commands are given again after a snapshot.
    run = sim.result("none")
    for time, angle, rate in [*seen[::-1], *seen]:
        assert run.at(time)["attitude"]["angle_rad"] == angle
        assert run.at(time)["rate"]["rate_rad_s"] == rate
    assert scenario.simulate(log="none").at(4.62)["rate"]["rate_rad_s"] != seen[-1][2]


def longest(source: flexsc.Result | flexsc.Log, figure: str) -> Any:
    """The line with the most points."""
    lines = flexsc.plot.figure(source, figure).axes[0].lines
    return max((np.asarray(line.get_xydata()) for line in lines), key=len)


def test_the_log_of_a_commanded_run_repeats_it(tmp_path: Path) -> None:
    for name, figure in (("relay-fixed", "angle"), ("four-clamped-modes", "pointing")):
        sim = commanded(shipped(name).with_("duration", 20.0))
        sim.to_mcap(tmp_path / "events.mcap")
        sim.to_mcap(tmp_path / "full.mcap", "full")
        events, full = (flexsc.read_log(tmp_path / f"{kind}.mcap") for kind in ("events", "full"))
        assert events.metadata["end"] == "interrupted"
        # Figures of a log of events repeat the run, under its commands.
        drawn = [longest(log, figure) for log in (events, full)]
        # A repeated run has rows at its cycles, a full log at its own period.
        last = drawn[0][-1]
        (same,) = drawn[1][np.isclose(drawn[1][:, 0], last[0])]
        assert last == pytest.approx(same, rel=1e-6)
        plain = shipped(name).with_("duration", sim.time).simulate()
        alone = longest(plain, figure)
        assert drawn[0][-1] != pytest.approx(alone[-1], rel=1e-3)


def test_a_log_of_commands_is_another_run(tmp_path: Path, command: Command) -> None:
    scenario = shipped("relay-fixed").with_("duration", 20.0)
    (tmp_path / "relay-fixed.toml").write_text(scenario.to_toml())
    commanded(scenario).to_mcap(tmp_path / "relay-fixed.mcap")
    before = (tmp_path / "relay-fixed.mcap").read_bytes()
    refused = command("simulate", "relay-fixed.toml", exits=2)
    assert b"holds a run that was stepped under commands" in refused.stderr
    assert (tmp_path / "relay-fixed.mcap").read_bytes() == before
    command("simulate", "relay-fixed.toml", "--force")
    command("simulate", "relay-fixed.toml")


def test_results_of_steps_are_pickled_and_go_with_snapshots() -> None:
    sim = commanded(shipped("four-clamped-modes"))
    before, metrics = sim.snapshot(), sim.metrics
    copy, result = sim.clone(), sim.result("full")
    sim.step([0.5, 0.5, 0.5], 3.0)
    assert sim.metrics["pointing_error_end_rad"] != metrics["pointing_error_end_rad"]
    sim.restore(before)
    same_metrics(sim.metrics, metrics)
    same_metrics(copy.metrics, metrics)
    again: flexsc.Result = pickle.loads(pickle.dumps(result))
    one, other = result.sample([1.0, 4.0]), again.sample([1.0, 4.0])
    for topic in one:
        assert all(np.array_equal(values, other[topic][column]) for column, values in one[topic].items())
    with pytest.raises(ValueError, match=r"from 0 to the time of the run, 10\.16 s, got 11"):
        result.at(11.0)
    assert "to 10.16 s" in repr(result)


def test_copies_that_keep_their_commands_have_results() -> None:
    scenario = shipped("four-clamped-modes-faults").with_("duration", 10.0)
    sims = Simulators(scenario, 4, jobs=2, keep_commands=True)
    single = Simulator(scenario.draw(2), 2)
    rng = np.random.default_rng(1)
    for _ in range(10):
        commands = rng.uniform(-0.5, 0.5, (4, 3))
        sims.step(commands, 1.0)
        single.step(commands[2], 1.0)
    same_metrics(sims[2].metrics, single.metrics)
    # A copy that begins again has no commands yet.
    sims.reset(np.array([True, False, False, False]))
    assert sims[0].time == 0.0
    assert sims[0].result().scenario == scenario.draw(0)
    lost = Simulators(scenario, 2)
    assert lost[1].metrics.keys() == single.metrics.keys()
    lost.step(np.zeros((2, 3)), 1.0)
    with pytest.raises(ValueError, match="the commands to run 1 were not kept"):
        _ = lost[1].metrics
