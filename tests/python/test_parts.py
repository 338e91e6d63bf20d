"""Parts written in Python: the switchings and beliefs of the engine's, errors, copies, campaigns."""

from __future__ import annotations

import _thread
import os
import pickle
import threading
import time
import traceback
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import flexsc
import numpy as np
import pytest
from conftest import shipped
from flexsc.parts import Draws, Event
from own import AlphaBeta, Descent, Encoder, Mekf, Notes, Pd, Relay, Servo, times, turn

SMALL = """
duration = 200.0
[law.open]
[body.planar]
inertia = 100.0
angle = 2e-3
modes = [{ frequency = 1.3, gain = 0.2, damping = 0.02 }]
[sensor.sampled]
period = 0.25
[[disturbance]]
torque = 1e-4
[uncertain]
"body.planar.rate" = { uniform = [0.0, 1e-5] }
"""


@pytest.mark.parametrize("name", ["relay-fixed", "relay-adaptive"])
def test_the_relay_in_python_switches_at_the_same_instants(name: str) -> None:
    scenario = shipped(name)
    own = scenario.with_parts(law=Relay.of(scenario))
    mine, theirs = own.simulate(), scenario.simulate()
    assert mine.topics == theirs.topics
    for topic in theirs:
        assert mine[topic].keys() == theirs[topic].keys()
        for column, values in theirs[topic].items():
            if topic != "events" and values.dtype != object:
                np.testing.assert_array_equal(mine[topic][column], values, f"{topic}.{column}")
    for metric, value in theirs.metrics.items():
        np.testing.assert_array_equal(mine.metrics[metric], value, metric)
    # And again: a run leaves nothing behind.
    np.testing.assert_array_equal(own.simulate()["command"]["time_s"], theirs["command"]["time_s"])


def mekf() -> Mekf:
    """The filter of earth-observer, for the keys that the scenario has."""
    axes = np.array([0.8, 0.0, 0.6, 0.0])
    columns = [times(times(axes, np.array([0.0, *row])), axes * [1, -1, -1, -1])[1:] for row in np.eye(3)]
    tracker = sum(
        np.outer(axis, axis) * deviation**2
        for axis, deviation in zip(columns, [2.4e-5, 2.4e-5, 1.5e-4], strict=True)
    )
    return Mekf((3e-6, 1e-8), (1e-3, 1e-5), np.array(tracker), 0.2)


def test_an_attitude_filter_in_numpy_believes_the_same() -> None:
    scenario = shipped("earth-observer").with_("duration", 60.0)
    told = []
    for estimator in [None, mekf()]:
        notes = Notes()
        law = Pd(0.25, 40.0, 250.0, notes)
        scenario.with_parts(law=law, estimator=estimator).simulate(log="none")
        told.append(np.array(sorted(notes.rows)))
    built_in, own = told
    assert built_in.shape == own.shape == (3 * 241, 4)
    np.testing.assert_array_equal(built_in[:, :2], own[:, :2])
    # 30 s after the start it leaves for a target 1 rad away.
    assert np.abs(built_in[:, 3]).max() > 5e-3
    np.testing.assert_allclose(own[:, 2:], built_in[:, 2:], rtol=0.0, atol=1e-12)


def test_an_attitude_filter_in_numpy_is_logged() -> None:
    scenario = shipped("earth-observer").with_({"duration": 20.0, "estimator.attitude.assess": [0.0, 1e9]})
    runs = [one.simulate(log="full") for one in (scenario, scenario.with_parts(estimator=mekf()))]
    theirs, mine = (run["attitude_filter"] for run in runs)
    np.testing.assert_array_equal(mine["time_s"], theirs["time_s"])
    for column in ("axes.angle_error_rad", "axes.angle_sd_rad", "axes.bias_rad_s", "axes.bias_sd_rad_s"):
        np.testing.assert_allclose(mine[column], theirs[column], rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(mine["nees"], theirs["nees"], rtol=1e-6)
    np.testing.assert_allclose(mine["nis"], theirs["nis"], rtol=1e-6)
    np.testing.assert_array_equal(mine["measured"], theirs["measured"])
    # The metrics judge it as they judge the engine's own.
    for metric in (
        "nees_mean",
        "nis_mean",
        "nis_inside_95",
        "attitude_estimate_error_rms_rad",
        "bias_estimate_error_rms_rad_s",
    ):
        assert runs[1].metrics[metric] == pytest.approx(runs[0].metrics[metric], rel=1e-6)


def test_an_estimator_that_tells_no_attitude_has_no_metrics_of_one() -> None:
    three = "duration = 5.0\n[law.open]\n[body.spatial]\ninertia = [[100, 0, 0], [0, 80, 0], [0, 0, 60]]\n"
    assert "nees_mean" not in all_own(three).simulate(log="none").metrics


def test_campaigns_of_own_parts_on_processes() -> None:
    scenario = all_own()
    here = flexsc.campaign(scenario, runs=6)
    for workers in (ProcessPoolExecutor(2, get_context("spawn")), ThreadPoolExecutor(2)):
        with workers:
            seen: list[tuple[int, int]] = []
            there = flexsc.campaign(
                scenario, runs=6, executor=workers, progress=lambda *done, to=seen: to.append(done)
            )
        assert list(there) == list(here)
        for name in here:
            assert list(map(str, there[name])) == list(map(str, here[name])), name
        assert str(there.statistics()) == str(here.statistics())
        assert seen[-1] == (6, 6)

    class Local(flexsc.Law):
        def decide(self, event: flexsc.parts.Event) -> flexsc.Hold:
            return flexsc.Hold(0.0)

    with ProcessPoolExecutor(1) as pool, pytest.raises(ValueError, match="cannot be sent to the workers"):
        flexsc.campaign(scenario.with_parts(law=Local()), runs=2, executor=pool)
    compiled = flexsc.CompiledLaw(12345, period=0.25)
    with ProcessPoolExecutor(1) as pool, pytest.raises(ValueError, match="an address of this process"):
        flexsc.campaign(scenario.with_parts(law=compiled), runs=2, executor=pool)


@pytest.mark.filterwarnings("ignore")
def test_campaigns_of_own_parts_on_dask() -> None:
    distributed = pytest.importorskip("distributed")
    from flexsc.dask import campaign

    scenario = all_own()
    here = flexsc.campaign(scenario, runs=12)
    seen: list[tuple[int, int]] = []
    # Workers are processes: the objects travel to them.
    cluster = distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, protocol="tcp://"
    )
    with cluster, distributed.Client(cluster) as client:
        assert os.getpid() not in client.run(os.getpid).values()
        there = campaign(client, scenario, 12, task_s=1e-3, progress=lambda *done: seen.append(done))
        with pytest.raises(ValueError, match="an address of this process"):
            campaign(client, scenario.with_parts(law=flexsc.CompiledLaw(12345, period=0.25)), 2)
    assert list(there) == list(here)
    assert there.rows == 12
    for name in here:
        assert list(map(str, there[name])) == list(map(str, here[name])), name
    assert str(there.statistics()) == str(here.statistics())
    assert seen[-1] == (12, 12)


def all_own(text: str = SMALL) -> flexsc.Scenario:
    return flexsc.Scenario.parse(text, "own").with_parts(
        law=Pd(0.25, 4.0, 30.0, Notes()),
        sensor=Encoder(0.25, 1e-6, 1e-7),
        estimator=AlphaBeta(0.4, 0.1),
        actuator=Servo(0.05, 1e-6, 0.05),
    )


def test_own_parts_close_the_loop_together() -> None:
    result = all_own().simulate(log="full")
    end = result["attitude"]["rigid_rad"][-40:]
    # A law without an integral part stays torque/k_p from the target: 2.5e-5 rad.
    np.testing.assert_allclose(end, 2.5e-5, atol=2e-6)
    steps = result["torque"]["applied_nm"] / 1e-6
    np.testing.assert_allclose(steps, np.round(steps), atol=1e-6)


def test_own_parts_hold_three_axes() -> None:
    three = (
        "duration = 200.0\n[law.open]\n[body.spatial]\ninertia = [[100, 0, 0], [0, 80, 0], [0, 0, 60]]\n"
        'rate = [1e-5, -1e-5, 2e-5]\npoints = [{ name = "hub" }]\n'
        "modes = [{ frequency = 1.3, damping = 0.02, shapes.hub = { rotation = [0.02, 0.01, 0.03] } }]\n"
    )
    pointing = all_own(three).simulate(log="full")["pointing"]
    for axis in ("roll", "pitch", "yaw"):
        assert abs(pointing[f"{axis}_error_rad"][-1]) < 2e-5


def test_an_adaptation_in_python_tunes() -> None:
    scenario = shipped("relay-adaptive").with_parts(adaptation=Descent(0.002))
    result = scenario.simulate()
    gains = result["adaptation"]["gain"]
    assert len(gains) == 40
    np.testing.assert_allclose(np.abs(np.diff(gains)), 0.002, atol=1e-9)
    assert result.metrics["gain_final"] == gains[-1]
    # A law in Python is tuned as well.
    relay = Relay.of(shipped("relay-adaptive"))
    np.testing.assert_array_equal(scenario.with_parts(law=relay).simulate()["adaptation"]["gain"], gains)


def test_an_adaptation_in_python_has_an_objective() -> None:
    class Faster(flexsc.Adaptation):
        tunes = "bandwidth"
        objective = "pointing_error_rms"
        window = 100.0

        def start(self, value: float, draws: Draws) -> None:
            self.value = value
            self.measured: list[float] = []

        def learn(self, time: float, measured: float) -> float:
            self.value += 0.01
            self.measured.append(measured)
            return self.value

    study = shipped("adaptive-bandwidth").with_("duration", 1000.0)
    result = study.with_parts(adaptation=Faster()).simulate()
    rows = result["objective"]
    np.testing.assert_allclose(rows["gain"], 0.02 + 0.01 * np.arange(10))
    assert rows["value"][-1] < 0.6 * rows["value"][0]
    assert result.metrics["objective_final"] == rows["value"][-1]
    with pytest.raises(ValueError, match="objective must be one of 'envelope_mean', "):
        study.with_parts(adaptation=type("Odd", (Faster,), {"objective": "speed"})())


class Wrong(flexsc.Law):
    period = 1.0

    def decide(self, event: Event) -> flexsc.Hold:
        if event.time > 5.0:
            raise ZeroDivisionError("at six")
        return flexsc.Hold(0.0)


def test_an_exception_ends_the_run_as_it_was_raised(tmp_path: Path) -> None:
    scenario = flexsc.Scenario.parse(SMALL, "own").with_parts(law=Wrong())
    with pytest.raises(ZeroDivisionError, match="at six") as raised:
        scenario.simulate()
    assert traceback.extract_tb(raised.value.__traceback__)[-1].name == "decide"
    with pytest.raises(ZeroDivisionError):
        flexsc.Result(scenario, 0, "events", {}, {}).to_mcap(tmp_path / "run.mcap")
    assert not (tmp_path / "run.mcap").exists()
    why = "own: 3 of 3 runs failed; run 0: the law at t = 6.000000000000000 s: ZeroDivisionError: at six"
    with pytest.raises(flexsc.SimulationError, match=why):
        flexsc.campaign(scenario, runs=3, jobs=2)


def test_what_a_part_answers_is_checked() -> None:
    class Silent(flexsc.Law):
        def decide(self, event: Event) -> flexsc.Hold:
            return None  # type: ignore[return-value]

    scenario = flexsc.Scenario.parse(SMALL, "own")
    with pytest.raises(TypeError, match=r"decide must return a flexsc\.Hold or a torque, got NoneType"):
        scenario.with_parts(law=Silent()).simulate()
    with pytest.raises(ValueError, match="torque must be a finite number"):
        flexsc.Hold(float("nan"))
    with pytest.raises(ValueError, match="one of torque, acceleration, change and moment"):
        flexsc.Hold()
    with pytest.raises(ValueError, match="state must be one of"):
        flexsc.Hold(1.0, state="push")
    with pytest.raises(TypeError, match=r"object of a flexsc\.Law, got the class Relay; write Relay\(\)"):
        scenario.with_parts(law=Relay)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match=r"law must be an object of a flexsc\.Law, got Servo"):
        scenario.with_parts(law=Servo(1.0, 1.0, 1.0))  # type: ignore[arg-type]
    with pytest.raises(flexsc.ScenarioError, match=r"sensor\[1\].*is not there"):
        scenario.with_parts(sensor={1: Encoder(1.0, 1.0, 1.0)})
    with pytest.raises(flexsc.ScenarioError, match="k_t"):
        scenario.with_parts(law=Wrong(), adaptation=Descent(0.1))


def test_a_period_may_be_a_text() -> None:
    def of(period: object) -> flexsc.Scenario:
        law = Pd(period, 4.0, 30.0, Notes())  # type: ignore[arg-type]
        return flexsc.Scenario.parse(SMALL, "own").with_parts(law=law)

    assert told(of(0.25)) == told(of("250 ms")) == told(of("0.25"))
    for period, why in {
        "0 s": "period must be longer than 0 s",
        "2 deg": "period has the unit `deg`, expected a unit such as `s`",
    }.items():
        with pytest.raises(ValueError, match=why):
            of(period)
    with pytest.raises(TypeError, match=r"period must be a time \(s\), such as 0.1 or \"0.1 s\", got shape"):
        of([1.0])


def test_an_answer_names_own_parts() -> None:
    scenario = shipped("relay-fixed").with_("duration", 600.0)
    switching = scenario.with_parts(law=Relay.of(scenario)).simulate()
    assert "own parts     law\n" in str(switching.answer)
    continuous = flexsc.Scenario.parse(SMALL, "own").with_parts(law=Pd(0.25, 4.0, 30.0, Notes()))
    both = str(flexsc.compare(scenario, continuous))
    assert "B  law; a continuous law: it does not say that it switches" in both
    assert "B  not in this run" in both


def told(scenario: flexsc.Scenario) -> list[float]:
    """The torques of a run."""
    return list(scenario.simulate(log="full")["torque"]["feedback_nm"])


def test_runs_begin_with_copies() -> None:
    class Counting(flexsc.Law):
        period = 1.0
        count = 0

        def decide(self, event: Event) -> flexsc.Hold:
            self.count += 1
            return flexsc.Hold(1e-6 * self.count)

    law = Counting()
    scenario = flexsc.Scenario.parse(SMALL, "own").with_parts(law=law)
    first = told(scenario)
    law.count = 1000
    np.testing.assert_array_equal(told(scenario), first)
    assert law.count == 1000
    assert scenario.own_parts["law"] is not law


def test_scenarios_with_parts_are_scenarios(tmp_path: Path) -> None:
    scenario = all_own()
    assert sorted(scenario.own_parts) == ["actuator", "estimator", "law", "sensor 0"]
    changed = scenario.with_("duration", 100.0)
    assert changed.duration == 100.0
    assert changed.own_parts["law"] is scenario.own_parts["law"]
    assert scenario.with_("duration", 200.0) == scenario != changed
    built_in = scenario.with_("law", {"pd": {"k_p": 4.0, "k_d": 30.0, "period": 0.25}})
    assert "law" not in built_in.own_parts
    again = pickle.loads(pickle.dumps(scenario))
    np.testing.assert_array_equal(told(again), told(scenario))
    # The log says that it does not repeat alone.
    scenario.simulate().to_mcap(tmp_path / "run.mcap")
    log = flexsc.read_log(tmp_path / "run.mcap")
    assert log.metadata["own_parts"] == "law, sensor, estimator, actuator"
    assert len(log["law"]["time_s"]) > 0
    with pytest.raises(flexsc.ScenarioError, match="defined by a program"):
        log.scenario  # noqa: B018


def test_campaigns_run_them_in_this_process(tmp_path: Path) -> None:
    scenario = all_own()
    one, two = (flexsc.campaign(scenario, runs=6, jobs=jobs) for jobs in (1, 2))
    for name in one:
        assert list(map(str, one[name])) == list(map(str, two[name])), name
    assert set(one["error"]) == {""}
    assert len(set(one["body.planar.rate"])) == 6
    run = scenario.draw(3).simulate(run=3, log="none")
    assert run.metrics["itae"] == one["itae"][3] != one["itae"][2]
    with pytest.raises(ValueError, match="in this process alone"):
        flexsc.campaign(scenario, runs=2, out=tmp_path / "rows")


def test_a_sensor_stands_beside_others() -> None:
    scenario = shipped("earth-observer").with_("duration", 5.0)

    class Blind(flexsc.Sensor):
        period = 1.0

        def read(self, truth: flexsc.parts.Truth) -> None:
            return None

    with pytest.raises(flexsc.ScenarioError, match="star_tracker"):
        # The filter has nothing else that corrects it.
        scenario.with_parts(sensor={1: Blind()})
    notes = Notes()

    class Noting(Mekf):
        def take(self, taken: flexsc.parts.Taken) -> list[tuple[float, float]]:
            notes.rows.append((taken.time, *(reading is not None for reading in taken.readings)))
            return [(0.0, 0.0)] * 3

        def carry(self, taken: flexsc.parts.Taken) -> None:
            return None

    scenario.with_parts(sensor={1: Blind()}, estimator=Noting((1, 1), (1, 1), np.eye(3), 0.0)).simulate()
    assert all(row[1] and not row[2] for row in notes.rows)
    assert len(notes.rows) == 51


def test_ctrl_c_ends_a_run() -> None:
    class Slow(flexsc.Law):
        period = 1e-3

        def decide(self, event: Event) -> flexsc.Hold:
            time.sleep(1e-3)
            return flexsc.Hold(0.0)

    scenario = flexsc.Scenario.parse(SMALL, "own").with_parts(law=Slow())
    began = time.monotonic()
    threading.Timer(0.3, _thread.interrupt_main).start()
    with pytest.raises(KeyboardInterrupt):
        scenario.simulate()
    assert time.monotonic() - began < 2.0


def test_turns_are_rotations() -> None:
    # What the filter of these tests is made of.
    quarter = turn(np.array([0.0, 0.0, np.pi / 2]))
    seen = times(times(quarter, np.array([0.0, 1.0, 0.0, 0.0])), quarter * [1, -1, -1, -1])
    np.testing.assert_allclose(seen, [0.0, 0.0, 1.0, 0.0], atol=1e-15)
