"""Beside other threads: the interpreter goes on during a run, and Ctrl-C ends it."""

import _thread
import threading
import time
from collections.abc import Callable, Generator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import flexsc
import pytest
from flexsc import Scenario
from own import Relay


@pytest.mark.parametrize(
    "work",
    [
        lambda scenario: scenario.simulate(log="none"),
        lambda scenario: flexsc.campaign(scenario.with_("duration", 2e6), 8),
    ],
    ids=["simulate", "campaign"],
)
def test_other_threads_go_on(fixed: Scenario, work: Callable[[Scenario], object]) -> None:
    long = fixed.with_("duration", 1e7)
    thread = threading.Thread(target=work, args=[long])
    began, ticks = time.monotonic(), 0
    thread.start()
    while thread.is_alive():
        time.sleep(0.001)
        ticks += 1
    took = time.monotonic() - began
    assert took > 0.1, "the run was too short to tell"
    # Without the lock given up there would be one or two.
    assert ticks > 20


def test_runs_in_threads_are_the_same(sampled: Scenario) -> None:
    expected = [sampled.simulate(run).metrics["switchings"] for run in range(8)]
    got = [0] * 8

    def work(run: int) -> None:
        got[run] = sampled.simulate(run).metrics["switchings"]

    threads = [threading.Thread(target=work, args=[run]) for run in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert got == expected


def while_it_advances(advance: Callable[[], object], read: Callable[[], object]) -> int:
    """Reads while another thread advances, and returns how often the read waited for it."""
    thread = threading.Thread(target=advance)
    waited = 0
    thread.start()
    while thread.is_alive():
        began = time.monotonic()
        read()
        waited += time.monotonic() - began > 0.02
    thread.join()
    return waited


def test_a_run_is_read_while_it_advances(fixed: Scenario) -> None:
    scenario = fixed.with_("duration", 1e7)
    sim = flexsc.Simulator(scenario)
    seen: set[float] = set()
    other = flexsc.Simulator(scenario)
    copies = flexsc.Simulators(scenario, 2)

    def advance() -> None:
        for _ in range(4):
            sim.step(None, 5e5)

    def read() -> None:
        snapshot = sim.snapshot()
        assert snapshot.time == other._of(snapshot._native.copy(), scenario, 0).time
        assert sim.state["angle"].shape == sim.measured["angle"].shape == sim.believed["angle"].shape
        assert "at" in repr(sim)
        assert (sim.axes, sim.done, sim.command_unit, sim.command_limit.shape) == (1, False, "rad/s²", (1,))
        assert sim.clone().time <= sim.time
        seen.update(copies.restore(sim)["angle"].tolist())
        seen.add(sim.time)

    assert while_it_advances(advance, read) > 0, "the steps were too short to tell"
    assert seen >= {2e6}
    assert {time for time in seen if time >= 1.0} <= {5e5, 1e6, 1.5e6, 2e6}


def test_copies_are_read_while_they_advance(fixed: Scenario) -> None:
    sims = flexsc.Simulators(fixed.with_("duration", 1e7), 8, jobs=2)
    seen: set[float] = set()

    def advance() -> None:
        for _ in range(4):
            sims.step(None, 1e5)

    def read() -> None:
        seen.update(sims.time.tolist())
        assert sims.state["angle"].shape == sims.measured["angle"].shape == (8,)
        assert len(sims) == len(sims.runs) == len(sims.snapshot()) == 8
        assert not (sims.done | sims.failed).any()
        assert (sims.axes, sims.command_unit, sims.command_limit.shape) == (1, "rad/s²", (1,))
        assert sims[3].time in {0.0, 1e5, 2e5, 3e5, 4e5}

    assert while_it_advances(advance, read) > 0, "the steps were too short to tell"
    assert seen <= {0.0, 1e5, 2e5, 3e5, 4e5}
    assert sims.time.tolist() == [4e5] * 8


def test_a_law_that_reads_its_own_copies_does_not_wait_for_them(fixed: Scenario) -> None:
    sims: list[flexsc.Simulators] = []

    class Curious(flexsc.Law):
        period = 1.0

        def decide(self, event: flexsc.parts.Event) -> flexsc.Hold:
            if sims and event.time > 5.0:
                assert sims[0].state
            return flexsc.Hold(0.0)

    sims.append(flexsc.Simulators(fixed.with_parts(law=Curious()), 2, jobs=1))
    with pytest.raises(flexsc.SimulationError, match="another thread is advancing the runs"):
        sims[0].step(None, 10.0)


@contextmanager
def interrupted() -> Generator[None, None, None]:
    """What is done within is interrupted soon, as by Ctrl-C, and ends at once."""
    timer = threading.Timer(0.3, _thread.interrupt_main)
    began = time.monotonic()
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        yield
    timer.join()
    assert time.monotonic() - began < 5.0


def test_a_run_is_interrupted(fixed: Scenario, tmp_path: Path) -> None:
    endless = fixed.with_("duration", 1e10)
    with interrupted():
        endless.simulate(log="none")
    result = flexsc.Result(endless, 0, "events", {}, {})
    with interrupted():
        result.to_mcap(tmp_path / "x.mcap")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(("duration", "runs"), [(1e10, 1000), (1000.0, 10**8)])
def test_a_campaign_is_interrupted(fixed: Scenario, duration: float, runs: int) -> None:
    scenario = fixed.with_("duration", duration)
    with interrupted():
        flexsc.campaign(scenario, runs, yes=True)


def test_an_identification_is_interrupted() -> None:
    with interrupted():
        flexsc.papers.identify([(1.5, 3.0)], runs=10**6, yes=True)


def test_a_table_of_damped_modes_is_interrupted() -> None:
    with interrupted():
        flexsc.papers.relay_damping([1.0] * 100_000, 0.1, period=1e5)


@pytest.mark.parametrize(("jobs", "threads"), [(None, 1), (0, 0), (1, 1), (3, 3)])
def test_a_task_has_the_threads_that_are_asked_for(
    fixed: Scenario, tmp_path: Path, jobs: int | None, threads: int
) -> None:
    """Of the engine 0 threads are one per core: without `jobs` the executor is what takes the cores."""

    class Noting(ThreadPoolExecutor):
        def submit(self, fn: Any, /, *arguments: Any, **keys: Any) -> Any:
            given.append([one for one in arguments if type(one) is int])
            return super().submit(fn, *arguments, **keys)

    given: list[list[int]] = []
    short = fixed.with_("duration", 800.0)
    study = short.with_("uncertain", {"law.relay.k_t": {"uniform": [0.3, 0.32]}})
    parts = short.with_parts(law=Relay(5e-4, 1e-4, 4e-5, 1e-6, 0.31))
    with Noting(1) as pool:
        flexsc.campaign(study, 4, jobs, executor=pool)
        flexsc.campaign(study, 4, jobs, out=tmp_path, executor=pool)
        flexsc.campaign(parts, 4, jobs, executor=pool)
    assert len(given) >= 3
    assert all(numbers == [threads] for numbers in given)
