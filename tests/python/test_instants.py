"""Runs at instants of one's own choice: the log's rows to the bit, and exact in between."""

import pickle
from contextlib import suppress
from typing import Any

import flexsc
import numpy as np
import numpy.typing as npt
import pytest
from conftest import SCENARIOS, shipped
from flexsc import Scenario

ALL = sorted(path.stem for path in SCENARIOS.glob("*.toml"))
# Long ones are cut: what is seen does not depend on what comes after.
LONGEST = 60.0


def bits(values: npt.NDArray[Any]) -> Any:
    if values.dtype == object:
        return [bits(row) for row in values]
    return np.ascontiguousarray(values).view(np.uint64) if values.dtype == np.float64 else values


def same(one: npt.NDArray[Any], other: npt.NDArray[Any]) -> bool:
    if one.dtype == object:
        return all(np.array_equal(a, b) for a, b in zip(bits(one), bits(other), strict=True))
    return np.array_equal(bits(one), bits(other))


@pytest.mark.parametrize("name", ALL)
def test_samples_are_the_rows_of_the_log(name: str) -> None:
    scenario = shipped(name)
    with suppress(flexsc.ScenarioError):
        scenario = scenario.with_("duration", min(scenario.duration, LONGEST))
    run = scenario.simulate(log="full")
    topic = "pointing" if "pointing" in run else "attitude"
    times = run[topic]["time_s"]
    # Where two rows have one time, the later has what is so from then on.
    last = np.append(np.diff(times) > 0.0, True)
    rows = np.flatnonzero(last)[:: max(1, len(times) // 97)]
    # In any order.
    rows = np.random.default_rng(1).permutation(rows)
    seen = run.sample(times[rows])
    compared = 0
    for other in seen:
        if other == "law":
            continue
        for column, values in seen[other].items():
            assert same(values, run[other][column][rows]), (other, column)
            compared += 1
    assert compared > 4


@pytest.mark.parametrize("name", ALL)
def test_samples_do_not_depend_on_those_before(name: str) -> None:
    scenario = shipped(name)
    with suppress(flexsc.ScenarioError):
        scenario = scenario.with_("duration", min(scenario.duration, LONGEST))
    run = scenario.simulate(log="none")
    # Between the snapshots, on them, and on the same time again.
    end = scenario.duration
    times = np.append(
        np.random.default_rng(3).uniform(0.0, end, 12), end * np.array([0.25, 0.5, 0.0, 1.0, 0.5])
    )
    at_once = run.sample(times)
    for start in range(0, len(times), 2):
        seen = run.sample(times[start : start + 2])
        for topic in at_once:
            for column, values in at_once[topic].items():
                assert same(seen[topic][column], values[start : start + 2]), (topic, column)
    # Nor on the samples of a new run.
    fresh = scenario.simulate(log="none").at(times[0])
    for topic, row in run.at(times[0]).items():
        for column, value in row.items():
            assert repr(value) == repr(fresh[topic][column]), column


def test_switchings_are_met_to_the_femtosecond(fixed: Scenario) -> None:
    run = fixed.simulate()
    command = run["command"]
    seen = run.sample(command["time_s"])
    np.testing.assert_array_equal(bits(seen["attitude"]["angle_rad"]), bits(command["angle_rad"]))
    np.testing.assert_array_equal(bits(seen["rate"]["rate_rad_s"]), bits(command["rate_rad_s"]))
    np.testing.assert_array_equal(seen["law"]["state"], command["state"])
    np.testing.assert_array_equal(seen["law"]["torque_nm"], command["torque_nm"])
    # A double is 3600 fs wide there: a tick before the switching the law is in another state.
    late = len(command["time_s"]) - 1
    before = np.nextafter(command["time_s"][late], 0.0)
    assert run.at(before)["law"]["state"] == command["state"][late - 1]


def test_between_events_the_motion_is_the_closed_form() -> None:
    mode = {"frequency": 0.44, "gain": 0.02, "damping": 0.01, "displacement": 1e-4}
    body = {"planar": {"angle": 1e-3, "rate": 2e-5, "modes": [mode]}}
    run = Scenario({"duration": 100.0, "body": body, "law": {"open": {}}}).simulate()
    times = np.random.default_rng(2).uniform(0.0, 100.0, 50)
    seen = run.sample(times)
    w, z = 0.44, 0.01
    damped = w * np.sqrt(1.0 - z * z)
    x = 1e-4 * np.exp(-z * w * times) * (np.cos(damped * times) + z * w / damped * np.sin(damped * times))
    np.testing.assert_allclose(seen["modes"]["modes.displacement_rad"][:, 0], x, atol=1e-17)
    np.testing.assert_allclose(seen["attitude"]["rigid_rad"], 1e-3 + 2e-5 * times, rtol=1e-14)
    np.testing.assert_array_equal(seen.times, times)
    np.testing.assert_array_equal(seen["modes"]["time_s"], times)
    assert len(seen.times) == 50
    assert repr(seen).startswith("<flexsc.Samples at 50 times: ")


def test_one_time_is_a_row_of_plain_numbers(sampled: Scenario) -> None:
    run = sampled.simulate(run=3)
    row = run.at(250.3)
    assert type(row["attitude"]["angle_rad"]) is float
    assert type(row["law"]["state"]) is str
    modes = sampled.to_dict()["body"]["planar"]["modes"]
    assert row["modes"]["modes.displacement_rad"].shape == (len(modes),)
    assert row["attitude"]["angle_rad"] == run.sample([0.0, 250.3])["attitude"]["angle_rad"][1]
    assert row["attitude"]["angle_rad"] != sampled.simulate(run=4).at(250.3)["attitude"]["angle_rad"]
    again = pickle.loads(pickle.dumps(run))
    assert again.at(250.3)["rate"] == row["rate"]


def test_times_are_within_the_run(sampled: Scenario) -> None:
    run = sampled.simulate()
    assert len(run.sample([]).times) == 0
    assert len(run.sample([0.0, sampled.duration])["attitude"]["time_s"]) == 2
    for wrong in (-1e-9, 1000.1, float("nan"), float("inf")):
        with pytest.raises(ValueError, match="times must be from 0 to the duration, 1000 s, got"):
            run.at(wrong)
    with pytest.raises(ValueError, match=r"times must be of shape \(times,\), got \(1, 2\)"):
        run.sample([[1.0, 2.0]])
    # Refused before any work.
    with pytest.raises(ValueError, match="at must keep at most 200000000 values in memory"):
        run.sample(np.zeros(30_000_000))
