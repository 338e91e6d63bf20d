"""Pickles and copies of tables, logs, plans and quantities; names and paths with any characters."""

import copy
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import flexsc
import numpy as np
import pytest
from conftest import Command, shipped


class Damper(flexsc.Law):
    """A law of its own, of this module, so that it can be pickled."""

    period = 1.0

    def decide(self, event: Any) -> flexsc.Hold:
        return flexsc.Hold(-1e-3 * event.angle - 1e-2 * event.rate)


class Burst(flexsc.Law):
    """A law whose torque no body survives."""

    period = 1.0

    def decide(self, event: Any) -> flexsc.Hold:
        return flexsc.Hold(1e200)


def pickled(value: Any) -> Any:
    return pickle.loads(pickle.dumps(value))


def same(table: flexsc.Table, other: flexsc.Table) -> None:
    assert list(table) == list(other)
    for name, column in table.columns.items():
        if column.dtype == object:
            assert all(np.array_equal(*pair) for pair in zip(column, other[name], strict=True))
        else:
            np.testing.assert_array_equal(column, other[name])
            assert column.dtype == other[name].dtype
    assert repr(table.statistics()) == repr(other.statistics())
    assert table.varied == other.varied
    # Objects written in Python are equal to themselves alone.
    assert table.scenario.own_parts or table.scenario == other.scenario


@pytest.mark.parametrize("again", [pickled, copy.copy, copy.deepcopy])
def test_a_table_returns_from_a_worker(
    sampled: flexsc.Scenario, again: Callable[[Any], Any], tmp_path: Path
) -> None:
    table = flexsc.campaign(sampled, runs=6)
    back: flexsc.Table = again(table)
    same(table, back)
    assert table.unit("cycle_period_s") == back.unit("cycle_period_s") == "s"
    assert table._repr_html_() == back._repr_html_()
    same(table, again(back))
    # Of a directory that is gone afterwards.
    with_directory = flexsc.campaign(sampled, runs=6, out=tmp_path / "out")
    back = again(with_directory)
    (tmp_path / "out").rename(tmp_path / "gone")
    same(table, back)
    swept = flexsc.sweep(sampled, "law.relay.k_t", [0.30, 0.31])
    same(swept, again(swept))


def test_a_table_of_own_parts_returns_without_its_figures() -> None:
    scenario = shipped("relay-fixed").with_("duration", 100.0).with_parts(law=Damper())
    table = flexsc.campaign(scenario, runs=2)
    back: flexsc.Table = pickled(table)
    assert next(iter(table.statistics())) in back._repr_html_()
    with pytest.raises(ValueError, match="parts in Python has no figures"):
        back._figures(None, ())
    same(table, pickled(back))


def test_a_log_returns_from_a_worker(fixed: flexsc.Scenario, tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    fixed.with_("duration", 100.0).simulate(log="full").to_mcap(path)
    log = flexsc.read_log(path)
    back: flexsc.Log = pickled(log)
    path.unlink()
    for log_again in (back, copy.copy(log), copy.deepcopy(log)):
        assert log_again.topics == log.topics
        assert log_again.metadata == log.metadata
        assert log_again.scenario == log.scenario
        for topic in ("attitude", "command"):
            for column, values in log[topic].items():
                np.testing.assert_array_equal(log_again[topic][column], values)


def test_the_summary_of_a_log_has_the_time_of_the_start(fixed: flexsc.Scenario, tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    fixed.with_("duration", 100.0).simulate().to_mcap(path)
    log = flexsc.read_log(path)
    assert (log["summary"]["time_s"].tolist(), log["metrics"]["time_s"].tolist()) == ([0.0], [100.0])


def test_plans_and_quantities_are_pickled() -> None:
    plan = shipped("rotation-sine").plan()
    back = pickled(plan)
    assert dict(back) == dict(plan)
    np.testing.assert_array_equal(back.torque([0.0, 3.0]), plan.torque([0.0, 3.0]))
    state = flexsc.Simulator(shipped("four-clamped-modes")).state
    for again in (pickled(state), copy.deepcopy(state)):
        assert dict(again.units) == dict(state.units)
        for name, values in state.items():
            np.testing.assert_array_equal(again[name], values)
        units: Any = again.units
        with pytest.raises(TypeError):
            units["rate"] = "deg/s"


ODD = [
    "a b",
    "weiß",
    "卫星",
    "it's",
    'say "so"',
    "$(touch x)",
    "%n {0}",
    "a;b&c",
    "#1",
    "[x]*?",
    "~",
    "a'b\"c d",
]


@pytest.mark.parametrize("name", ODD)
def test_names_and_paths_may_have_any_characters(name: str, command: Command, tmp_path: Path) -> None:
    scenario = shipped("relay-fixed").with_({"duration": 50.0, "name": name})
    assert (scenario.name, pickled(scenario)) == (name, scenario)
    directory = tmp_path / name
    directory.mkdir()
    file = directory / f"{name}.toml"
    file.write_text(scenario.to_toml(), encoding="utf-8")
    assert flexsc.Scenario.load(file) == scenario
    command("simulate", file, "-o", directory)
    log = directory / f"{name}.mcap"
    own = directory / f"{name}-own.mcap"
    scenario.simulate().to_mcap(own)
    assert own.read_bytes() == log.read_bytes()
    assert flexsc.read_log(log).scenario == scenario
    command("plot", log, "--format", "svg", "-o", directory)
    assert list(directory.glob("*.svg"))
    table = flexsc.campaign(scenario, runs=2, out=directory / f"{name} runs")
    same(table, flexsc.read_campaign(directory / f"{name} runs"))
    assert name in repr(table)
    assert not (tmp_path / "x").exists()


@pytest.mark.parametrize(
    "name", ["..", ".hidden", "-o", "con", "NUL.x", "lpt1", "a/b", "a\nb", "a\u202eb", "a\ufeff"]
)
def test_names_that_are_traps_for_files_are_refused(name: str) -> None:
    with pytest.raises(flexsc.ScenarioError, match="`name` is used for file names: "):
        shipped("relay-fixed").with_("name", name)


def test_a_torque_that_no_body_survives_ends_the_run() -> None:
    scenario = shipped("relay-fixed").with_("duration", 100.0).with_parts(law=Burst())
    with pytest.raises(flexsc.SimulationError, match="the state is no longer finite"):
        scenario.simulate(log="none")


@pytest.mark.parametrize(
    "part",
    [
        flexsc.Reading(angle=1e-3, rate=2e-6),
        flexsc.Reading(attitude=[0.6, 0.0, 0.8, 0.0]),
        flexsc.Reading(vector=[0.0, 0.0, 1.0], inertial=[1.0, 0.0, 0.0], is_direction=True),
        flexsc.Hold(-4e-5, at_most=4e-4, until=flexsc.parts.Instant(20, 7), state="RACC"),
        flexsc.ThreeAxisHold([0.01, 0.0, -0.02], until=flexsc.parts.Instant(20, 7), state="FIRE"),
        flexsc.ThreeAxisHold(moments=[1.0, 0.0, 2.0], after=0.5),
        flexsc.ThreeAxisHold(accelerations=[1e-4, 0.0, 0.0]),
        flexsc.Effort([0.01, 0.0, 0.02], after=0.05),
        flexsc.Effort([0.01]),
    ],
    ids=lambda part: type(part).__name__,
)
def test_what_parts_return_is_pickled_and_copied(part: object) -> None:
    names = [name for name in dir(part) if not name.startswith("_")]
    assert len(names) >= 2
    for again in (pickled(part), copy.copy(part), copy.deepcopy(part)):
        for name in names:
            mine, other = getattr(part, name), getattr(again, name)
            assert (mine == other, type(mine)) == (True, type(other)), name


def test_states_of_runs_say_why_they_are_not_pickled() -> None:
    sim = flexsc.Simulator(shipped("relay-fixed"))
    for state in (sim, sim.snapshot(), flexsc.Simulators.of(sim, 2)):
        with pytest.raises(TypeError, match=rf"cannot pickle {type(state).__name__}, a state of"):
            pickle.dumps(state)
    assert pickled(sim.result()).run == 0
