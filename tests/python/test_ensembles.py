"""Motion at chosen times within the run, and of all runs of a campaign."""

from __future__ import annotations

import pickle
from typing import ClassVar

import flexsc
import numpy as np
import pytest
from conftest import shipped


@pytest.mark.parametrize(
    ("name", "seconds"),
    [("relay-sampled", 600.0), ("relay-fixed", 200.0), ("earth-observer", 40.0), ("attitude-hold", 30.0)],
)
def test_the_motion_is_that_of_sample_and_changes_nothing(name: str, seconds: float) -> None:
    scenario = shipped(name).with_("duration", seconds)
    times = np.array([0.0, seconds, 0.3 * seconds, 0.3 * seconds, 0.71234 * seconds])
    run, plain = scenario.simulate(log="full", at=times), scenario.simulate(log="full")
    assert run.samples is not None
    assert plain.samples is None
    assert run.samples == plain.sample(times)
    assert run.metrics == plain.metrics
    assert dict(run) == dict(plain)
    assert run.answer.verdict == plain.answer.verdict


def test_an_ensemble_has_a_row_for_each_run_and_time() -> None:
    scenario = shipped("earth-observer").with_("duration", 20.0)
    scenario = scenario.with_("uncertain", {"law.attitude.bandwidth": {"uniform": [0.05, 0.15]}})
    times = np.linspace(0.0, 20.0, 5)
    table = flexsc.campaign(scenario, 4, at=times, topics=["pointing", "vibrations"])
    plain = flexsc.campaign(scenario, 4)
    np.testing.assert_array_equal(table["pointing_error_end_rad"], plain["pointing_error_end_rad"])
    samples = table.samples
    assert samples is not None
    assert samples.topics == ["pointing", "vibrations"]
    assert plain.samples is None
    for run in range(4):
        drawn = scenario.draw(run).simulate(run).sample(times)
        for topic in samples:
            for column in drawn[topic]:
                if column != "time_s":
                    np.testing.assert_array_equal(samples[topic][column][run], drawn[topic][column])
    assert samples["vibrations"]["modes.displacement"].shape == (4, 5, 8)
    assert samples["vibrations"].unit("modes.displacement") == "m sqrt(kg)"
    threads = flexsc.campaign(scenario, 4, jobs=2, at=times, topics=["pointing"])
    assert threads.samples is not None
    assert threads.samples["pointing"] == samples["pointing"]
    few = table[[2, 0]].samples
    assert few is not None
    for each in (few, pickle.loads(pickle.dumps(samples))):
        with pytest.raises(ValueError, match="read-only"):
            each.runs[0] = 7
    one = flexsc.campaign(scenario, 2, at=times, topics="pointing").samples
    assert one is not None
    assert one.topics == ["pointing"]


def test_an_ensemble_goes_to_other_libraries() -> None:
    scenario = shipped("relay-sampled").with_("duration", 60.0)
    samples = flexsc.campaign(scenario, 3, at=[0.0, 30.0, 60.0, 45.0]).samples
    assert samples is not None
    angle = samples["attitude"]["angle_rad"]
    pyarrow = pytest.importorskip("pyarrow")
    rows = pyarrow.table(samples["attitude"])
    assert rows.column("angle_rad").to_pylist() == angle.ravel().tolist()
    assert rows.schema.field("angle_rad").metadata[b"unit"] == b"rad"
    xarray = pytest.importorskip("xarray")
    found = samples.to_xarray()["attitude"]["angle_rad"]
    assert isinstance(found, xarray.DataArray)
    assert found.dims == ("run", "time_s")
    np.testing.assert_array_equal(found.values, angle)
    assert found.sel(run=2, time_s=45.0).item() == angle[2, 3]
    assert found.attrs["units"] == "rad"
    assert samples["modes"].to_xarray()["modes.displacement_rad"].dims == ("run", "time_s", "modes")
    pytest.importorskip("pandas")
    frame = samples["attitude"].to_pandas()
    assert len(frame) == 12
    np.testing.assert_array_equal(
        frame.pivot(index="run", columns="time_s", values="angle_rad")[45.0], angle[:, 3]
    )


def test_a_run_that_failed_has_no_motion() -> None:
    class Failing(flexsc.DisturbanceModel):
        period = 1.0

        def start(self, axes: int, draws: flexsc.parts.Draws) -> None:
            self.run = draws.run

        def act(self, truth: flexsc.parts.Truth) -> flexsc.Load:
            if self.run == 1:
                raise RuntimeError("broken")
            return flexsc.Load([0.0, 0.0, 0.0])

    scenario = shipped("earth-observer").with_("duration", 2.0).with_parts(disturbance=Failing())
    samples = flexsc.campaign(scenario, 3, at=[1.0, 2.0], topics=["rates"]).samples
    assert samples is not None
    rates = samples["rates"]["axes.rate_rad_s"]
    assert np.isnan(rates[1]).all()
    assert np.isfinite(rates[[0, 2]]).all()


def test_what_cannot_be_sampled_is_refused() -> None:
    scenario = shipped("relay-fixed").with_("duration", 10.0)
    with pytest.raises(ValueError, match=r"times must be from 0 to the duration, 10 s, got 11"):
        scenario.simulate(at=[11.0])
    with pytest.raises(ValueError, match=r"times must be of shape \(times,\), got \(\)"):
        flexsc.campaign(scenario, 2, at=3.0)
    with pytest.raises(ValueError, match="at keeps the motion in memory"):
        flexsc.campaign(scenario, 2, at=[3.0], progress=True)
    with pytest.raises(ValueError, match="topics needs `at`"):
        flexsc.campaign(scenario, 2, topics=["rate"])
    with pytest.raises(ValueError, match="at needs runs of the same duration"):
        flexsc.campaign(scenario.with_("uncertain", {"duration": {"uniform": [5.0, 15.0]}}), 2, at=[3.0])
    with pytest.raises(KeyError, match="no topic 'rat'; did you mean 'rate'"):
        flexsc.campaign(scenario, 2, at=[3.0], topics=["rat"])


def test_what_does_not_fit_in_memory_is_refused_before_the_runs() -> None:
    scenario = shipped("relay-fixed").with_("duration", 10.0)
    times = np.linspace(0.0, 10.0, 1000)
    with pytest.raises(
        ValueError, match=r"at most 200000000 values in memory, got \d{10,} \(runs: 1000000, times: 1000,"
    ):
        flexsc.campaign(scenario, 1_000_000, at=times, yes=True)
    with pytest.raises(ValueError, match=r"\(runs: 1, times: 3000000, .*\): give fewer times"):
        shipped("earth-observer").with_("duration", 10.0).simulate(at=np.zeros(3_000_000))


def test_an_unknown_topic_is_refused_before_the_runs() -> None:
    class Counting(flexsc.DisturbanceModel):
        period = 1.0
        times: ClassVar[list[float]] = []

        def act(self, truth: flexsc.parts.Truth) -> flexsc.Load:
            self.times.append(truth.time)
            return flexsc.Load([0.0, 0.0, 0.0])

    scenario = shipped("earth-observer").with_("duration", 5.0).with_parts(disturbance=Counting())
    with pytest.raises(KeyError, match="no topic 'pointin'; did you mean 'pointing'"):
        flexsc.campaign(scenario, 2, at=[3.0], topics=["rates", "pointin"])
    assert set(Counting.times) <= {0.0}


class Counting(flexsc.Guidance):
    """A target at rest, whose signal is the time (s)."""

    signals = {"seen": "s", "word": str}  # noqa: RUF012
    seen, word = 0.0, "aim"

    def aim(self, sky: flexsc.parts.Sky) -> flexsc.Aim:
        self.seen = sky.time
        return flexsc.Aim((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


def test_a_part_of_one_mode_has_no_values_in_others() -> None:
    scenario = shipped("safe-mode").with_("duration", 3000.0).with_parts(guidance={"point": Counting()})
    times = [3000.0, 100.0, 2000.0, 100.0, 0.0]
    samples = scenario.simulate(at=times).samples
    assert samples is not None
    topic = samples["own_guidance_point"]
    assert topic["time_s"].tolist() == times
    assert topic["word"].tolist() == ["aim", "", "aim", "", ""]
    assert np.isnan(topic["seen"]).tolist() == [False, True, False, True, True]
    assert abs(topic["seen"][[0, 2]] - [3000.0, 2000.0]).max() < 2.0
    assert dict(scenario.simulate().sample(times)) == dict(samples)
    ensemble = flexsc.campaign(scenario, 2, at=times, topics=["own_guidance_point"]).samples
    assert ensemble is not None
    seen = ensemble["own_guidance_point"]["seen"]
    assert seen.shape == (2, 5)
    assert np.isnan(seen).tolist() == [[False, True, False, True, True]] * 2
