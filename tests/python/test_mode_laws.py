"""Laws in Python that act in a mode of operation or in a stage of the law, and are never dropped."""

from __future__ import annotations

import pickle
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import flexsc
import numpy as np
import pytest
from conftest import shipped
from flexsc.parts import Event, ThreeAxisEvent


class Damper(flexsc.ThreeAxisLaw):
    """Brings the rates to rest, and counts its decisions."""

    period = 0.5
    signals = {"decisions": ""}  # noqa: RUF012

    def __init__(self) -> None:
        self.decisions = 0.0

    def decide(self, event: ThreeAxisEvent) -> flexsc.ThreeAxisHold:
        self.decisions += 1.0
        return flexsc.ThreeAxisHold(accelerations=[-0.05 * rate for rate in event.rates])


class Held(flexsc.Law):
    """A weak PD law, and the times (s) at which it acts."""

    period = 0.5
    signals = {"time": "s"}  # noqa: RUF012
    time = 0.0

    def decide(self, event: Event) -> flexsc.Hold:
        self.time = event.time
        return flexsc.Hold(-0.5 * event.angle - 5.0 * event.rate)


@pytest.fixture(scope="module")
def safe_mode() -> flexsc.Scenario:
    return shipped("safe-mode").with_("duration", 6600.0)


@pytest.mark.parametrize("name", ["cubesat-day", "safe-mode", "site-pass"])
def test_a_law_without_a_mode_is_refused(name: str) -> None:
    scenario = shipped(name)
    modes = ", ".join(f"`{mode['name']}`" for mode in scenario.get("mode"))
    with pytest.raises(flexsc.ScenarioError, match=f"each mode has a law of its own.*the modes are {modes}"):
        scenario.with_parts(law=Damper())


def test_a_law_without_a_stage_is_refused() -> None:
    with pytest.raises(flexsc.ScenarioError, match=r"each with a law of its own.*law={1: \.\.\.}"):
        shipped("detumble-and-point").with_parts(law=Held())


def test_names_without_a_mode_are_refused(safe_mode: flexsc.Scenario) -> None:
    with pytest.raises(flexsc.ScenarioError, match=r"got `pont`; did you mean `point`\?"):
        safe_mode.with_parts(law={"pont": Damper()})
    with pytest.raises(flexsc.ScenarioError, match="from 0 to 1, got `2`"):
        shipped("detumble-and-point").with_parts(law={2: Held()})
    with pytest.raises(flexsc.ScenarioError, match="a stage has a law about each axis"):
        shipped("detumble-and-point").with_parts(law={1: Damper()})
    with pytest.raises(flexsc.ScenarioError, match="has no modes of operation, got `point`"):
        shipped("earth-observer").with_parts(law={"point": Damper()})
    with pytest.raises(TypeError, match=r"law point must be an object of a flexsc\.Law, got float"):
        safe_mode.with_parts(law={"point": 1.0})  # type: ignore[arg-type]


def test_a_law_acts_in_its_mode_alone(safe_mode: flexsc.Scenario) -> None:
    own = safe_mode.with_parts(law={"safe": Damper()})
    assert list(own.own_parts) == ["law safe"]
    run, plain = own.simulate(log="full"), safe_mode.simulate(log="full")
    starts = run["mode"]["time_s"]
    assert run["mode"]["mode"].tolist() == ["detumble", "point", "safe", "point"]
    signals = run["own_law_safe"]
    assert (signals["time_s"] >= starts[2]).all()
    assert (signals["time_s"] <= starts[3]).all()
    # One decision at the start of the mode, and one every half second.
    last = signals["time_s"][-1]
    assert signals["decisions"][-1] == np.floor((last - starts[2]) / 0.5) + 1.0
    # Before it acts, the others fly as in the file; then its torques are others.
    before = run["pointing"]["time_s"] < starts[2]
    for column in ("q_x", "q_y", "q_z"):
        assert (run["pointing"][column][before] == plain["pointing"][column][before]).all()
    assert not np.array_equal(run["pointing"]["q_x"], plain["pointing"]["q_x"])


def test_each_visit_of_a_mode_begins_with_a_copy(safe_mode: flexsc.Scenario) -> None:
    run = safe_mode.with_parts(law={"point": Damper()}).simulate(log="full")
    starts, signals = run["mode"]["time_s"], run["own_law_point"]
    again = signals["time_s"] >= starts[3]
    assert again.any()
    elapsed = signals["time_s"][again] - starts[3]
    assert (signals["decisions"][again] == np.floor(elapsed / 0.5) + 1.0).all()


def test_a_law_acts_in_its_stage_alone() -> None:
    scenario = shipped("orbit-correction").with_("duration", 460.0)
    own = scenario.with_parts(law={2: Held()})
    assert list(own.own_parts) == ["law 2"]
    times = own.simulate(log="full")["own_law2"]["time_s"]
    assert times[0] == 450.0
    assert times[-1] == 460.0


def test_laws_of_modes_travel_and_stay(safe_mode: flexsc.Scenario, tmp_path: Path) -> None:
    own = safe_mode.with_parts(law={"safe": Damper(), "point": Damper()})
    assert list(own.own_parts) == ["law point", "law safe"]
    run = own.simulate(log="full")
    again = pickle.loads(pickle.dumps(own))
    assert list(again.own_parts) == list(own.own_parts)
    np.testing.assert_array_equal(again.simulate().metrics["mode_starts_s"], run.metrics["mode_starts_s"])
    assert dict(again.simulate(log="full")["own_law_safe"].items()).keys() == run["own_law_safe"].keys()
    # Another key, and another part, keep them; a law of the engine replaces one.
    changed = own.with_("duration", 100.0).with_parts(law={"safe": Damper()})
    assert list(changed.own_parts) == list(own.own_parts)
    pd = own.with_("mode[2].law", {"attitude": {"period": 1.0, "bandwidth": 0.03}})
    assert list(pd.own_parts) == ["law point"]
    assert list(own.in_mode("point").own_parts) == ["law"]
    with pytest.raises(ValueError, match="has a part of your own"):
        own.part("mode")
    run.to_mcap(tmp_path / "run.mcap")
    log = flexsc.read_log(tmp_path / "run.mcap")
    assert log.metadata["own_parts"] == "law"
    assert log["own_law_safe"]["decisions"].tolist() == run["own_law_safe"]["decisions"].tolist()


def test_campaigns_fly_laws_of_modes(safe_mode: flexsc.Scenario) -> None:
    own = safe_mode.with_parts(law={"safe": Damper()})
    metrics = ["pointing_error_end_rad"]
    here = flexsc.campaign(own, runs=2, metrics=metrics)
    assert set(here["error"]) == {""}
    assert not np.array_equal(
        here[metrics[0]], flexsc.campaign(safe_mode, runs=2, metrics=metrics)[metrics[0]]
    )
    with ProcessPoolExecutor(1, get_context("spawn")) as pool:
        there = flexsc.campaign(own, runs=2, metrics=metrics, executor=pool)
    np.testing.assert_array_equal(there[metrics[0]], here[metrics[0]])
