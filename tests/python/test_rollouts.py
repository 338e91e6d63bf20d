"""Roll-outs: copies of a run from its present state, and their return to saved states."""

import pickle
from typing import Any

import flexsc
import numpy as np
import pytest
from conftest import shipped
from flexsc import Simulator, Simulators
from scipy.linalg import expm
from test_stepping import UNCERTAIN, everything, same


@pytest.fixture(scope="module")
def uncertain() -> flexsc.Scenario:
    return flexsc.Scenario(UNCERTAIN)


def at(values: dict[str, Any], place: Any) -> dict[str, Any]:
    return {name: each[place] for name, each in values.items()}


@pytest.mark.parametrize("command", [None, [0.1, -0.2, 0.05]])
@pytest.mark.parametrize("source", ["simulator", "snapshot"])
def test_a_rollout_goes_on_as_its_source(
    uncertain: flexsc.Scenario, source: str, command: list[float] | None
) -> None:
    # In the middle of a run, between two samples of noisy sensors, by the law or under a command.
    sim = Simulator(uncertain.draw(7), 7)
    sim.step(None, 3.1)
    sim.step(command, 1.0)
    snapshot = sim.snapshot()
    rollouts = Simulators.of(snapshot if source == "snapshot" else sim, 20)
    assert (rollouts.time == 4.1).all()
    assert rollouts.runs.tolist() == [7] * 20
    torques = np.random.default_rng(3).uniform(-0.3, 0.3, (5, 20, 3))
    rollouts.step(None, 0.6)
    for each in torques:
        rollouts.step(each, 0.37)
    together = everything(rollouts)
    for place in (0, 8, 19):
        sim.restore(snapshot)
        sim.step(None, 0.6)
        for each in torques:
            sim.step(each[place], 0.37)
        same(everything(sim), at(together, place))
        # A copy is a simulator of the same scenario, to which the source can go on.
        sim.restore(rollouts[place].snapshot())
        same(everything(sim), at(together, place))
    assert len(np.unique(together["state.rate"][:, 0])) == 20


def test_the_source_stays_and_its_noise_is_shared(uncertain: flexsc.Scenario) -> None:
    sim = Simulator(uncertain, 2)
    sim.step(None, 2.0)
    before = everything(sim)
    rollouts = Simulators.of(sim, 3)
    rollouts.step(None, 10.0)
    same(everything(sim), before)
    after = everything(rollouts)
    same(at(after, 0), at(after, 2))
    whole = Simulator(uncertain, 2)
    whole.run_until(12.0)
    same(everything(whole), at(after, 1))
    # Unlike that of another run.
    other = Simulator(uncertain, 3)
    other.run_until(12.0)
    assert not np.array_equal(other.measured["rate"], after["measured.rate"][0])


def test_a_rollout_is_the_exact_motion() -> None:
    """Under a held torque the motion is that of SciPy's exponential of the linear model."""
    mode = {"frequency": 0.9, "damping": 0.01, "gain": 0.3}
    body = {"planar": {"inertia": 2.0, "angle": 0.4, "modes": [mode]}}
    sim = Simulator(flexsc.Scenario({"duration": 100.0, "law": {"open": {}}, "body": body}))
    sim.step(0.7, 3.0)
    torques = np.linspace(-1.0, 1.0, 5)
    state = Simulators.of(sim, 5).step(torques, 2.5)
    a = np.zeros((5, 5))
    # The angle, its rate, the mode, its rate, and the torque.
    a[0, 1] = a[2, 3] = 1.0
    a[1, 4], a[3] = 0.5, [0.0, 0.0, -(0.9**2), -0.018, 0.3 * 0.5]
    for place, torque in enumerate(torques):
        x = expm(3.0 * a) @ [0.4, 0.0, 0.0, 0.0, 0.7]
        x[4] = torque
        x = expm(2.5 * a) @ x
        np.testing.assert_allclose(state["rigid_angle"][place], x[0], rtol=1e-12)
        np.testing.assert_allclose(state["modes"][place], x[2:3], rtol=1e-10)
        np.testing.assert_allclose(state["angle"][place], x[0] + x[2], rtol=1e-12)


def test_several_sources_have_copies_each(uncertain: flexsc.Scenario) -> None:
    sims = [Simulator(uncertain, run) for run in (4, 9)]
    sims[1].step([0.2, 0.0, 0.0], 5.0)
    rollouts = Simulators.of([sims[0], sims[1].snapshot()], 3, jobs=2)
    assert rollouts.runs.tolist() == [4, 4, 4, 9, 9, 9]
    np.testing.assert_array_equal(rollouts.time, [0.0] * 3 + [5.0] * 3)
    after = everything(rollouts)
    same(at(after, 2), everything(sims[0]))
    same(at(after, 3), everything(sims[1]))


@pytest.mark.parametrize("one", [False, True])
def test_copies_return_to_snapshots(uncertain: flexsc.Scenario, one: bool) -> None:
    sims = Simulators._of_one(uncertain, 5) if one else Simulators(uncertain, range(5, 11))
    count = len(sims)
    commands = np.random.default_rng(1).uniform(-0.3, 0.3, (3, count, 3))
    sims.step(commands[0], 2.3)
    saved, before = sims.snapshot(), everything(sims)
    assert [snapshot.run for snapshot in saved] == list(range(5, 5 + count))
    sims.step(commands[1], 1.1)
    went = everything(sims)
    mask = np.arange(count) % 2 == 0
    # Those in the mask come back, and the others are where they were.
    sims.restore(saved, mask)
    after = everything(sims)
    same(at(after, mask), at(before, mask))
    same(at(after, ~mask), at(went, ~mask))
    sims.step(commands[1], 1.1, mask)
    same(everything(sims), went)
    # All take the state of one, its run and its keys, until they are reset.
    sims.restore(saved[-1])
    after = everything(sims)
    for place in range(count):
        same(at(after, place), at(before, -1))
    assert sims.runs.tolist() == [4 + count] * count
    assert sims[0].scenario == uncertain.draw(4 + count)
    sims.reset(runs=np.arange(5, 5 + count))
    same(everything(sims), everything(Simulators(uncertain, range(5, 5 + count))))
    assert sims[0].scenario == uncertain.draw(5)
    # The states of other copies of the same runs are accepted too, and of the undrawn scenario.
    sims.restore(Simulators(uncertain, range(20, 20 + count)).snapshot())
    assert sims.runs[0] == 20
    sims.restore(Simulator(uncertain, 3))
    assert sims[0].scenario == uncertain


def test_keys_of_a_source_are_not_drawn_again(uncertain: flexsc.Scenario) -> None:
    drawn = uncertain.draw(7)
    rollouts = Simulators.of(Simulator(drawn, 7), 2)
    frequency = drawn.get("body.spatial.modes[0].frequency")
    assert rollouts[1].scenario == drawn
    assert frequency != uncertain.get("body.spatial.modes[0].frequency")
    # A reset starts the run of the source.
    rollouts.step(np.ones((2, 3)), 1.0)
    rollouts.reset()
    assert rollouts.scenario.get("body.spatial.modes[0].frequency") == frequency
    same(at(everything(rollouts), 0), everything(Simulator(drawn, 7)))
    rollouts.restore(Simulator(drawn, 7))
    assert rollouts[0].scenario == drawn
    # Nor are those of a source that has their nominal values.
    rollouts = Simulators.of(Simulator(uncertain, 7), 2)
    assert rollouts[1].scenario == uncertain
    rollouts.reset()
    same(at(everything(rollouts), 0), everything(Simulator(uncertain, 7)))


def test_commands_are_kept_on_demand(uncertain: flexsc.Scenario) -> None:
    sim = Simulator(uncertain, 1)
    sim.step([0.1, 0.0, -0.1], 2.0)
    rollouts = Simulators.of(sim, 2, keep_commands=True)
    rollouts.step(np.full((2, 3), -0.05), 1.0)
    sim.step([-0.05] * 3, 1.0)
    assert rollouts[1].metrics == sim.metrics
    rollouts = Simulators.of(sim, 2)
    with pytest.raises(ValueError, match="were not kept"):
        rollouts[1].result()
    # A run under its law has none to keep.
    assert Simulators.of(Simulator(uncertain, 1), 2)[1].metrics == Simulator(uncertain, 1).metrics


def test_other_scenarios_and_numbers_are_refused(uncertain: flexsc.Scenario) -> None:
    sim = Simulator(uncertain, 2)
    rollouts = Simulators.of(sim, 3)
    before = everything(rollouts)
    longer = Simulator(uncertain.with_("duration", 31.0), 2)
    other = r"<flexsc.Snapshot of uncertain, run 2, at 0 s> is of another scenario; accepted are states of "
    with pytest.raises(ValueError, match=other + r"<flexsc.Scenario uncertain: 30 s, .*`draw\(2\)` sets"):
        rollouts.restore(longer.snapshot())
    with pytest.raises(ValueError, match="another scenario"):
        rollouts.restore([sim, sim, longer])
    with pytest.raises(ValueError, match="another scenario"):
        Simulators.of([sim, Simulator(shipped("relay-fixed"))])
    # Drawn for another run than that of the snapshot.
    with pytest.raises(ValueError, match="another scenario"):
        Simulators(uncertain, 2).restore(Simulator(uncertain.draw(1), 2))
    with pytest.raises(ValueError, match="snapshots must be 1 or 3, one for each copy, got 2"):
        rollouts.restore([sim, sim])
    with pytest.raises(ValueError, match="snapshots must be 1 or 3, one for each copy, got 0"):
        rollouts.restore([])
    with pytest.raises(ValueError, match="a mask must be 3 of bool"):
        rollouts.restore(sim, np.ones(2, dtype=bool))
    with pytest.raises(TypeError, match="a state is that of a Simulator or a Snapshot, got Scenario"):
        Simulators.of(uncertain)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="one source or more"):
        Simulators.of([])
    for copies in (0, 20_000_000, 2.0):
        with pytest.raises(ValueError, match="copies of each of 1 sources must be 1 to 10000000, got"):
            Simulators.of(sim, copies)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="jobs must be from 0 to 1024, got -1"):
        Simulators.of(sim, 2, -1)
    same(everything(rollouts), before)
    for bad in (rollouts, rollouts.snapshot()):
        with pytest.raises(TypeError, match="cannot pickle"):
            pickle.dumps(bad)
    # Outside the mask nothing is looked at.
    rollouts.restore([longer, sim, longer], np.array([False, True, False]))


def test_a_failed_source_is_named() -> None:
    body = {"planar": {"inertia": 1.0}}
    sim = Simulator(flexsc.Scenario({"duration": 10.0, "law": {"open": {}}, "body": body}), 4)
    good = sim.snapshot()
    with pytest.raises(flexsc.SimulationError):
        sim.step(1.5e100, 9.0)
    rollouts = Simulators.of(good, 2)
    for copies in (rollouts, Simulators._of_one(sim.scenario, 4)):
        with pytest.raises(flexsc.SimulationError, match=r"copy 0, run 4: .*no longer finite"):
            copies.restore(sim)
        assert copies.failed.all()
        with pytest.raises(flexsc.SimulationError, match=r"run 4: .*no longer finite"):
            copies.snapshot()
        copies.restore(good)
        assert not copies.failed.any()
        assert copies.step(None, 1.0)["angle"].tolist() == [0.0] * len(copies)
