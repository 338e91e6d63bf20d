"""Beside other threads: the interpreter goes on during a run, and Ctrl-C ends it."""

import _thread
import threading
import time
from collections.abc import Callable, Generator
from contextlib import contextmanager
from pathlib import Path

import flexsc
import pytest
from flexsc import Scenario


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
        flexsc.identify([(1.5, 3.0)], runs=10**6, yes=True)


def test_a_table_of_damped_modes_is_interrupted() -> None:
    with interrupted():
        flexsc.relay_damping([1.0] * 100_000, 0.1, period=1e5)
