"""Campaigns and sweeps: tables of runs, each the same alone and among others."""

import shutil
from pathlib import Path
from typing import Any

import flexsc
import numpy as np
import pytest
from conftest import SCENARIOS, Command, json_lines, shipped
from flexsc import Scenario, ScenarioError, SimulationError, Table


@pytest.fixture(scope="module")
def table(sampled: Scenario) -> Table:
    return flexsc.campaign(sampled, runs=40)


def test_a_table_has_a_row_for_each_run(sampled: Scenario, table: Table) -> None:
    assert table.rows == 40
    assert table["run"].tolist() == list(range(40))
    assert table.varied == sorted(sampled.to_dict()["uncertain"])
    assert all(len(column) == 40 for column in table.columns.values())
    assert all(column.ndim == 1 for column in table.columns.values())
    assert set(table) == set(table.columns)
    assert table["switchings"].dtype == np.float64
    assert table["cycle_kind"].dtype.kind == "U"
    assert table["envelope_window_means_rad"].dtype == object
    assert [means.shape for means in table["envelope_window_means_rad"]] == [(2,)] * 40
    assert set(table["error"]) == {""}
    angle = table["body.planar.angle"]
    assert (np.abs(angle) <= 1.5e-3).all()
    assert len(set(angle)) == 40
    with pytest.raises(KeyError, match="no column 'mass'; there are run, "):
        table["mass"]


def test_a_directory_is_the_same_table(
    sampled: Scenario, table: Table, command: Command, tmp_path: Path
) -> None:
    path, out = SCENARIOS / "relay-sampled.toml", tmp_path / "out"
    seconds = str(sampled.to_dict()["duration"])
    command("simulate", path, "--set", f"duration={seconds}", "--runs", "40", "-o", out)
    read = flexsc.read_campaign(out)
    assert read.varied == table.varied
    assert list(read.columns) == list(table.columns)
    for name, column in table.columns.items():
        if column.dtype == object:
            assert all(np.array_equal(*pair) for pair in zip(read[name], column, strict=True))
        else:
            np.testing.assert_array_equal(read[name], column)
    assert read.statistics()["duty"] == table.statistics()["duty"]
    assert read.scenario.name == "relay-sampled"
    with pytest.raises(ValueError, match="is not a campaign"):
        flexsc.read_campaign(tmp_path)


def test_runs_are_the_commands(table: Table, command: Command) -> None:
    path = SCENARIOS / "relay-sampled.toml"
    told = json_lines(command("simulate", path, "--set", "duration=1000.0", "--runs", "3:6", "--json"))
    # The last line is the answer.
    for line in told[:-1]:
        for key, drawn in line["drawn"].items():
            assert table[key][line["run"]] == drawn
        for name, value in line["metrics"].items():
            mine: Any = table[name][line["run"]]
            np.testing.assert_array_equal(mine, np.nan if value is None else value)


def test_a_run_is_the_same_alone(sampled: Scenario, table: Table, tmp_path: Path, command: Command) -> None:
    part = flexsc.campaign(sampled, runs=range(30, 33), jobs=1)
    assert part["run"].tolist() == [30, 31, 32]
    for name, column in part.columns.items():
        if column.dtype == object:
            for alone, among in zip(column, table[name][30:33], strict=True):
                np.testing.assert_array_equal(alone, among)
        else:
            np.testing.assert_array_equal(column, table[name][30:33])
    drawn = sampled.draw(31)
    assert "uncertain" not in drawn.to_dict()
    result = drawn.simulate(run=31)
    for name, value in result.metrics.items():
        np.testing.assert_array_equal(table[name][31], np.nan if value is None else value)
    path = SCENARIOS / "relay-sampled.toml"
    command("simulate", path, "--set", "duration=1000.0", "--runs", "31:32", "--log", "events", "-o", "out")
    result.to_mcap(tmp_path / "python.mcap")
    [log] = (tmp_path / "out").glob("*.mcap")
    assert (tmp_path / "python.mcap").read_bytes() == log.read_bytes()


def test_the_seed_draws_anew(sampled: Scenario, table: Table) -> None:
    other = flexsc.campaign(sampled, runs=3, seed=8)
    assert other.scenario.seed == 8
    assert other["body.planar.angle"].tolist() != table["body.planar.angle"][:3].tolist()
    assert flexsc.campaign(sampled, 3, seed=7)["switchings"].tolist() == table["switchings"][:3].tolist()


def test_statistics_are_numpys(table: Table) -> None:
    statistics = table.statistics()
    assert "cycle_kind" not in statistics
    for name, of in statistics.items():
        # Of verdicts the statistics count those that are met.
        column = (table[name] == "met").astype(float) if name == "goal" else table[name]
        values = column[np.isfinite(column)]
        assert of["runs"] == len(values)
        assert of["unit"] == flexsc.metrics()[name.partition("[")[0]]["unit"]
        assert list(of["quantiles"]) == [0.05, 0.25, 0.5, 0.75, 0.95]
        if len(values) > 1:
            assert of["mean"] == pytest.approx(values.mean(), rel=1e-12)
            assert of["sd"] == pytest.approx(values.std(ddof=1), rel=1e-9, abs=1e-12 * abs(of["mean"]))
            quantiles = np.quantile(values, list(of["quantiles"]))
            np.testing.assert_allclose(list(of["quantiles"].values()), quantiles, rtol=1e-12)


def test_a_sweep_takes_any_values(fixed: Scenario) -> None:
    short = fixed.with_("duration", 1000.0)
    values = [0.34, 0.31, 0.36]
    table = flexsc.sweep(short, "law.relay.k_t", values)
    assert table.varied == ["law.relay.k_t"]
    assert table["law.relay.k_t"].tolist() == values
    for value, mean in zip(values, table["envelope_mean_rad"], strict=True):
        alone = short.with_("law.relay.k_t", value).simulate(log="none")
        assert alone.metrics["envelope_mean_rad"] == mean
    assert flexsc.sweep(short, "seed", np.arange(3))["seed"].dtype == np.int64


def test_a_sweep_takes_several_keys(fixed: Scenario) -> None:
    gains, angles = [0.31, 0.34], [0.0, 2e-4, 4e-4]
    short = fixed.with_("duration", 600.0)
    table = flexsc.sweep(short, {"law.relay.k_t": gains, "body.planar.angle": angles})
    assert table.varied == ["law.relay.k_t", "body.planar.angle"]
    assert table["law.relay.k_t"].reshape(2, 3)[:, 0].tolist() == gains
    assert table["body.planar.angle"].reshape(2, 3)[1].tolist() == angles
    alone = short.with_({"law.relay.k_t": 0.34, "body.planar.angle": 2e-4}).simulate(log="none")
    assert table["envelope_mean_rad"].reshape(2, 3)[1, 1] == alone.metrics["envelope_mean_rad"]
    wrong: Any
    for wrong in ({}, {"law.relay.k_t": []}):
        with pytest.raises(ValueError, match=r"needs a key|must be of shape"):
            flexsc.sweep(short, wrong)
    arguments: Any
    for arguments in (("law.relay.k_t",), ({"law.relay.k_t": gains}, angles)):
        with pytest.raises(ValueError, match="with a single key, and with no mapping"):
            flexsc.sweep(short, *arguments)


def test_a_value_that_is_not_accepted_is_a_row(fixed: Scenario) -> None:
    table = flexsc.sweep(fixed.with_("duration", 100.0), "law.relay.k_t", [0.31, 1.5, np.nan, 0.32])
    assert [bool(error) for error in table["error"]] == [False, True, True, False]
    assert "must be a number between 0 and 1, got 1.5" in table["error"][1]
    assert np.isnan(table["switchings"]).tolist() == [False, True, True, False]
    assert table["cycle_kind"].tolist()[1:3] == ["", ""]
    assert [len(means) for means in table["cycle_multipliers"]][1:3] == [0, 0]
    assert table.statistics()["switchings"]["runs"] == 2


def test_runs_that_all_fail_are_an_error(fixed: Scenario, tmp_path: Path) -> None:
    hopeless = fixed.with_({"body.planar.rate": 1e308, "body.planar.angle": 1e308})
    why = r"relay-fixed: 2 of 2 runs failed; run 3: .*no longer finite"
    for out in (None, tmp_path / "out"):
        with pytest.raises(SimulationError, match=why):
            flexsc.campaign(hopeless, range(3, 5), out=out)
    with pytest.raises(SimulationError, match=r"relay-fixed: 2 of 2 runs failed; run 0: .*no longer finite"):
        flexsc.sweep(hopeless, "law.relay.k_t", [0.31, 0.32])
    # The directory has the rows.
    table = flexsc.read_campaign(tmp_path / "out")
    assert table["run"].tolist() == [3, 4]
    assert np.isnan(table["switchings"]).all()
    assert "no longer finite" in table["error"][0]
    assert table.statistics()["switchings"]["runs"] == 0


def test_no_jobs_are_all_cores_everywhere(sampled: Scenario) -> None:
    short, keys = sampled.with_("duration", 100.0), ["law.relay.k_t"]
    runs = [flexsc.campaign(short, 5, jobs=jobs) for jobs in (None, 0, 2)]
    assert all(table["duty"].tolist() == runs[0]["duty"].tolist() for table in runs)
    swept = [flexsc.sweep(short, keys[0], [0.3, 0.33], jobs=jobs)["duty"].tolist() for jobs in (None, 0, 2)]
    assert swept == [swept[0]] * 3
    found = [flexsc.evaluate(short, keys, [[0.3], [0.33]], "duty", jobs=n).tolist() for n in (None, 0, 2)]
    assert found == [found[0]] * 3
    copies = [flexsc.Simulators(short, 3, jobs=jobs).step(None, 50.0)["angle"] for jobs in (None, 0, 2)]
    assert all(angle.tolist() == copies[0].tolist() for angle in copies)
    rollouts = flexsc.Simulators.of(flexsc.Simulator(short), 2, jobs=0)
    assert len(rollouts) == 2


def test_what_makes_no_campaign(fixed: Scenario) -> None:
    for runs in (0, -1, range(3, 3), range(0, 9, 2)):
        with pytest.raises(ValueError, match="runs must be"):
            flexsc.campaign(fixed, runs)
    with pytest.raises(ValueError, match="the number of a run must be from 0"):
        flexsc.campaign(fixed, range(-2, 1))
    for jobs in (-1, 1025):
        with pytest.raises(ValueError, match="jobs must be from 0 to 1024"):
            flexsc.campaign(fixed, 1, jobs=jobs)
    with pytest.raises(ScenarioError, match="`seed`"):
        flexsc.campaign(fixed, 1, seed=-1)
    for values in (np.zeros(0), 0.31):
        with pytest.raises(ValueError, match="must be of shape"):
            flexsc.sweep(fixed, "law.relay.k_t", values)  # type: ignore[arg-type]
    with pytest.raises(ScenarioError, match="found an array, expected a number"):
        flexsc.sweep(fixed, "law.relay.k_t", [[0.31]])
    with pytest.raises(ScenarioError, match="unknown key `kt`"):
        flexsc.sweep(fixed, "law.relay.kt", [0.31])
    with pytest.raises(ScenarioError, match="must be a number between 0 and 1"):
        flexsc.sweep(fixed, "law.relay.k_t", [np.nan])


def test_a_directory_that_is_gone_is_an_error(tmp_path: Path) -> None:
    table = flexsc.campaign(shipped("relay-sampled").with_("duration", 100.0), runs=3, out=tmp_path / "out")
    assert len(table["run"]) == 3
    shutil.rmtree(tmp_path / "out")
    with pytest.raises(FileNotFoundError, match="no longer exists"):
        table["duty"]


def test_points_of_a_sweep_have_the_noise_of_one_run(sampled: Scenario) -> None:
    short, key = sampled.with_("duration", 2000.0).without("uncertain"), "law.relay.k_t"
    metric = "duty"
    table = flexsc.sweep(short, key, [0.3, 0.33, 0.3], metrics=[metric])
    alone = [short.with_(key, value).simulate(0, "none").metrics[metric] for value in (0.3, 0.33, 0.3)]
    assert table[metric].tolist() == alone
    population = [[0.3], [0.33], [0.3]]
    assert table[metric].tolist() == flexsc.evaluate(short, [key], population, metric).tolist()
    assert [table.row(place).run for place in range(3)] == [0, 0, 0]
    # A part, another order and logs do not change it.
    assert flexsc.sweep(short, key, [0.3, 0.33, 0.3], runs=range(1, 3))[metric].tolist() == alone[1:]
    assert flexsc.sweep(short, key, [0.33, 0.3])[metric].tolist() == [alone[1], alone[0]]
    # Replica i has the noise of run i at every point.
    twice = flexsc.sweep(short, key, [0.3, 0.33], replicas=2)
    again = [short.with_(key, value).simulate(1, "none").metrics[metric] for value in (0.3, 0.33)]
    assert twice[metric].tolist() == [alone[0], again[0], alone[1], again[1]]
    new = flexsc.sweep(short, key, [0.3, 0.33, 0.3], noise="new")
    runs = [short.with_(key, 0.3).simulate(run, "none").metrics[metric] for run in (0, 2)]
    assert new[metric][[0, 2]].tolist() == runs
    assert runs[0] != runs[1]
    wrong: Any = "old"
    with pytest.raises(ValueError, match="noise must be 'same' or 'new', got 'old'"):
        flexsc.sweep(short, key, [0.3], noise=wrong)


def test_a_sweep_draws_only_if_it_is_asked_to(sampled: Scenario) -> None:
    drawn = {"uncertain": {"law.relay.k_t": {"uniform": [0.3, 0.32]}}}
    study = Scenario({**sampled.with_("duration", 100.0).to_dict(), **drawn}, "study")
    values = [1e-6, 2e-6, 3e-6]
    table = flexsc.sweep(study, "law.relay.weak", values)
    assert table.varied == ["law.relay.weak"]
    table = flexsc.sweep(study, "law.relay.weak", values, uncertain=True)
    assert table.varied == ["law.relay.weak", "law.relay.k_t"]
    assert len(set(table["law.relay.k_t"].tolist())) == 3


def test_arguments_of_other_types_are_named(tmp_path: Path, fixed: Scenario) -> None:
    for call in (
        lambda: flexsc.campaign(100),  # type: ignore[arg-type]
        lambda: flexsc.campaign("m.toml"),  # type: ignore[arg-type]
        lambda: flexsc.sweep("m.toml", "duration", [1.0]),  # type: ignore[arg-type]
        lambda: flexsc.papers.rigid_cycles("x"),  # type: ignore[arg-type]
        lambda: flexsc.structure.write_scenario("x", tmp_path / "x.toml"),  # type: ignore[arg-type]
    ):
        with pytest.raises(TypeError, match=r"scenario must be a flexsc\.Scenario, got"):
            call()
    with pytest.raises(TypeError, match=r"runs must be an integer or a range, got 1000\.0"):
        flexsc.campaign(fixed, runs=1e3)  # type: ignore[arg-type]
