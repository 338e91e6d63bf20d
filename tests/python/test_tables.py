"""Tables, topics and results as other libraries know them: mappings, frames, rows that are run again."""

import copy
import inspect
import pickle
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import flexsc
import numpy as np
import numpy.typing as npt
import pytest
from conftest import shipped
from flexsc import Metrics, Result, Scenario, Table


@pytest.fixture(scope="module")
def run(fixed: Scenario) -> Result:
    return fixed.with_("duration", 50.0).simulate(log="full")


@pytest.fixture(scope="module")
def drawn() -> Table:
    return flexsc.campaign(shipped("relay-sampled").with_("duration", 100.0), runs=6)


@pytest.fixture(scope="module")
def grid(fixed: Scenario) -> Table:
    keys = {"law.relay.k_t": [0.3, 0.31], "body.planar.angle": [1e-4, 3e-4, 2e-4]}
    return flexsc.sweep(fixed.with_("duration", 600.0), keys, replicas=2)


def test_tables_and_results_are_mappings(run: Result, drawn: Table) -> None:
    things: list[Any] = [run, drawn, run["modes"], run.sample([1.0]), flexsc.Simulator(run.scenario).state]
    for thing in things:
        assert isinstance(thing, Mapping)
        assert list(dict(thing)) == list(thing) == list(thing.keys())
        assert len(thing) == len(list(thing)) > 1
        assert all(name in thing for name in thing)
        assert "nowhere" not in thing
        with pytest.raises(TypeError, match=r"is not an array: "):
            np.asarray(thing)
    assert len(drawn) == len(drawn.columns)
    assert drawn.rows == 6
    assert drawn.varied == sorted(drawn.scenario.get("uncertain"))


def test_they_are_equal_by_content(run: Result, drawn: Table) -> None:
    again = run.scenario.simulate(log="full")
    assert run == again
    assert run["modes"] == again["modes"]
    assert run != run.scenario.simulate(run=1, log="full")
    assert drawn == pickle.loads(pickle.dumps(drawn))
    assert drawn != flexsc.campaign(drawn.scenario, runs=5)
    sim = flexsc.Simulator(run.scenario)
    assert sim.state == flexsc.Simulator(run.scenario).state
    before = sim.state
    sim.run_until(3.0)
    assert sim.state != before


def refuses(values: npt.NDArray[Any]) -> bool:
    try:
        values[...] = values
    except ValueError:
        return True
    return False


def test_columns_are_read_only(run: Result, drawn: Table) -> None:
    for of in (run["attitude"], drawn, pickle.loads(pickle.dumps(run))["modes"], copy.deepcopy(drawn)):
        for name, values in of.items():
            assert refuses(values), name
            assert values.dtype != object or all(refuses(row) for row in values), name
            values.copy()[...] = values
    assert refuses(drawn.row(0).simulate().metrics["envelope_window_means_rad"])
    assert refuses(run.sample([1.0, 2.0]).times)


@pytest.mark.parametrize("sample", ["random", "sobol", "latin-hypercube"])
def test_a_row_of_a_campaign_is_run_again(sample: Any) -> None:
    scenario = shipped("relay-sampled").with_("duration", 100.0)
    table = flexsc.campaign(scenario, range(3, 9), sample=sample, replicas=2, seed=5)
    for place in range(table.rows):
        again, run = table.row(place)
        assert run == table["run"][place]
        assert again.get("uncertain") is None
        same_metrics(again.simulate(run).metrics, table, place)
    assert table.row(-1) == table.row(5)
    for place in (6, -7):
        with pytest.raises(IndexError, match="the table has rows 0 to 5"):
            table.row(place)


def test_a_row_of_a_sweep_is_run_again(grid: Table) -> None:
    sampled = shipped("relay-sampled").with_("duration", 100.0)
    seeds = flexsc.sweep(sampled, {"seed": [4, 5], "law.relay.k_t": [0.3, 0.34]}, uncertain=True)
    plain = flexsc.sweep(sampled, "seed", [4, 5])
    for table in (grid, seeds, plain, pickle.loads(pickle.dumps(grid))):
        for place in range(table.rows):
            same_metrics(table.row(place).simulate(log="none").metrics, table, place)


def same_metrics(metrics: Metrics, table: Table, place: int) -> None:
    for name, value in metrics.items():
        np.testing.assert_array_equal(table[name][place], np.nan if value is None else value, err_msg=name)


def test_the_worst_run_is_found(grid: Table) -> None:
    duty = grid["duty"]
    assert grid.worst("duty") == grid.row(int(duty.argmax()))
    assert grid.worst("duty", least=True) == grid.row(int(duty.argmin()))
    with pytest.raises(ValueError, match="'goal' is not a column of numbers"):
        grid.worst("goal")
    with pytest.raises(ValueError, match="no run has a value of 'gain_frozen_at_s'"):
        grid.worst("gain_frozen_at_s")
    with pytest.raises(KeyError, match="did you mean 'duty'"):
        grid.worst("dutty")


def test_names_that_do_not_exist_are_answered_with_those_that_do(run: Result, grid: Table) -> None:
    there: list[tuple[Any, str, str]] = [
        (run, "comand", r"no topic 'comand'; did you mean 'command'\? there are command, law"),
        (
            run["command"],
            "sate",
            r"topic 'command' has no column 'sate'; did you mean 'state'\? there are time_s",
        ),
        (run.metrics, "dutty", r"no metric 'dutty'; did you mean 'duty'\? there are switchings"),
        (run.at(1.0), "atitude", r"no topic 'atitude'; did you mean 'attitude'"),
        (
            run.at(1.0)["attitude"],
            "angle",
            r"topic 'attitude' has no column 'angle'; did you mean 'angle_rad'",
        ),
        (grid, "dutty", r"no column 'dutty'; did you mean 'duty'\? there are run"),
        (grid.statistics(), "dutty", r"no numeric metric 'dutty'; did you mean 'duty'"),
        (flexsc.Simulator(run.scenario).state, "angel", r"no quantity 'angel'; did you mean 'angle'"),
    ]
    for of, name, words in there:
        with pytest.raises(KeyError, match=words):
            of[name]
    assert run.metrics.get("dutty") is None
    assert copy.deepcopy(run.metrics) == pickle.loads(pickle.dumps(run.metrics)) == run.metrics


def test_keys_are_completed(run: Result, grid: Table) -> None:
    state = flexsc.Simulator(run.scenario).state
    things: list[Any] = [run, run["command"], run.metrics, grid, state, run.sample([1.0])]
    for thing in things:
        assert thing._ipython_key_completions_() == list(thing)


def test_ipython_completes_keys(run: Result, grid: Table) -> None:
    completer: Any = pytest.importorskip("IPython.core.completer")
    found = completer.IPCompleter(namespace={"run": run, "table": grid, "command": run["command"]})
    with completer.provisionalcompleter():
        for text, name in (('run["comm', "command"), ('table["du', "duty"), ('command["sta', "state")):
            assert name in {completion.text.strip("\"'") for completion in found.completions(text, len(text))}


def test_every_column_has_its_unit() -> None:
    run = shipped("earth-observer").with_("duration", 20.0).simulate(log="full")
    units = flexsc.Simulator(run.scenario).state.units
    assert run["vibrations"].unit("modes.displacement") == units["modes"] == "m sqrt(kg)"
    assert run["vibrations"].unit("modes.rate") == units["mode_rates"] == "m sqrt(kg)/s"
    # A column of numbers without a unit is a ratio, an index, a component of a unit vector or one of a list.
    ratios = r"q_[wxyz]|nees|nis|gain|nadir|sun|singularity"

    for topic in (topic for name, topic in run.items() if name not in ("scene", "tf", "params")):
        for name, values in topic.items():
            if values.dtype == np.float64:
                assert topic.unit(name) or re.fullmatch(ratios, name.rpartition(".")[2]), (topic.name, name)
    pyarrow: Any = pytest.importorskip("pyarrow")
    schema = pyarrow.table(run["vibrations"]).schema
    assert schema.field("modes.displacement").metadata == {b"unit": b"m sqrt(kg)"}
    rigid = shipped("relay-fixed").with_("duration", 50.0).simulate(log="full")
    assert rigid["command"].unit("torque_nm") == "rad/s²"


def test_keys_of_a_scenario_have_their_units(fixed: Scenario) -> None:
    short = fixed.with_("duration", 20.0)
    for key, unit in {
        "body.planar.modes[1].frequency": "rad/s",
        "body.planar.rate": "rad/s",
        "duration": "s",
        "law.relay.k_t": "",
        "seed": "",
    }.items():
        value = short.get(key)
        assert flexsc.sweep(short, key, [value], metrics=["duty"]).unit(key) == unit, key


def test_they_become_frames_of_pandas(run: Result, grid: Table, drawn: Table) -> None:
    pandas: Any = pytest.importorskip("pandas")
    with pytest.raises(TypeError, match=r"a table is not an array: use to_pandas\(\)"):
        pandas.DataFrame(grid)
    frame = grid.to_pandas()
    assert frame["duty"].tolist() == grid["duty"].tolist()
    assert frame.attrs["units"]["body.planar.angle"] == "rad"
    modes = run["modes"].to_pandas()
    parts = ["modes.displacement_rad[0]", "modes.displacement_rad[1]"]
    np.testing.assert_array_equal(modes[parts], run["modes"]["modes.displacement_rad"])
    assert modes.attrs["units"][parts[1]] == "rad"
    assert modes.attrs["topic"] == "modes"
    frames = run.to_pandas()
    assert list(frames) == list(run)
    assert frames["command"]["state"].tolist() == run["command"]["state"].tolist()
    assert [len(cell) for cell in drawn.to_pandas()["envelope_window_means_rad"]] == [0] * 6


def test_they_become_frames_of_polars(run: Result, grid: Table) -> None:
    pytest.importorskip("polars")
    frame = grid.to_polars()
    assert frame["duty"].to_list() == grid["duty"].tolist()
    assert frame["gain_frozen_at_s"].null_count() == grid.rows
    frames = run.to_polars()
    assert frames["modes"]["modes.rate_rad_s"].to_list() == run["modes"]["modes.rate_rad_s"].tolist()


def test_they_become_data_sets_of_xarray(run: Result, grid: Table, drawn: Table) -> None:
    xarray: Any = pytest.importorskip("xarray")
    modes = run["modes"].to_xarray()
    assert modes["modes.displacement_rad"].dims == ("time_s", "modes")
    assert modes["modes.displacement_rad"].dtype == np.float64
    assert modes["modes.displacement_rad"].attrs == {"units": "rad"}
    np.testing.assert_array_equal(modes["time_s"], run["modes"]["time_s"])
    data = grid.to_xarray()
    assert dict(data["duty"].sizes) == {"law.relay.k_t": 2, "body.planar.angle": 3, "replica": 2}
    np.testing.assert_array_equal(data["duty"].values.reshape(-1), grid["duty"])
    assert data["body.planar.angle"].values.tolist() == [1e-4, 3e-4, 2e-4]
    assert data["body.planar.angle"].attrs == {"units": "rad"}
    rows = drawn.to_xarray()
    assert rows["duty"].dims == ("run",)
    assert rows["body.planar.angle"].dims == ("run",)
    if hasattr(xarray, "DataTree"):
        tree = run.to_xarray()
        assert set(tree) == set(run)
        assert tree["modes"]["modes.rate_rad_s"].dims == ("time_s", "modes")


def test_a_missing_library_is_named(run: Result, monkeypatch: pytest.MonkeyPatch) -> None:
    import sys

    for name in ("pandas", "polars", "xarray"):
        monkeypatch.setitem(sys.modules, name, None)
        with pytest.raises(ImportError, match=rf"Topic.to_{name} needs {name}: pip install {name}"):
            getattr(run["modes"], f"to_{name}")()


def test_runs_and_tables_are_drawn(run: Result, grid: Table, tmp_path: Path) -> None:
    matplotlib: Any = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    from matplotlib import pyplot

    run.to_mcap(tmp_path / "run.mcap")
    log = flexsc.read_log(tmp_path / "run.mcap")
    assert texts(run.plot()) == texts(log.plot()) == texts(flexsc.plot.figure(run, "angle"))
    assert texts(run.plot("torque")) == texts(flexsc.plot.figure(run, "torque"))
    first = flexsc.plot.figures(grid)[0]
    assert texts(grid.plot()) == texts(flexsc.plot.figure(grid, first))
    mine = pyplot.figure()
    assert run.plot("angle", on=mine) is mine
    with pytest.raises(ValueError, match="there is no figure 'nothing'"):
        run.plot("nothing")
    pyplot.close("all")


def texts(figure: Any) -> list[str]:
    return [figure.get_suptitle(), *(axes.get_ylabel() for axes in figure.axes)]


class Off(flexsc.Law):
    """A law that does nothing."""

    period = 1.0

    def decide(self, event: flexsc.parts.Event) -> float:
        return 0.0


def test_progress_is_a_line_or_a_function(
    fixed: Scenario, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    short = fixed.with_("duration", 50.0)
    flexsc.campaign(short, 4, progress=True)
    assert capsys.readouterr().err.endswith("4 of 4 runs, 0 s" + " " * 44 + "\n")
    seen: list[tuple[int, int]] = []
    flexsc.sweep(short, "law.relay.k_t", [0.3, 0.31], progress=lambda done, total: seen.append((done, total)))
    assert seen[-1] == (2, 2)
    flexsc.campaign(short, 2, progress=False)
    # By default on a terminal, for work that is long.
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    flexsc.campaign(short, 2)
    assert capsys.readouterr().err == ""
    monkeypatch.setattr("flexsc._progress._LONG_S", 0.0)
    flexsc.campaign(short, 2)
    assert capsys.readouterr().err.startswith("\r2 of 2 runs")
    flexsc.campaign(short, 2, progress=False)
    # Parts that no directory can hold run without a line.
    assert flexsc.campaign(short.with_parts(law=Off()), 2).rows == 2
    assert capsys.readouterr().err == ""


def test_a_sweep_goes_to_a_directory_or_an_executor(fixed: Scenario, tmp_path: Path) -> None:
    from concurrent.futures import ThreadPoolExecutor

    from own import Relay

    short, gains = fixed.with_("duration", 50.0), np.linspace(0.3, 0.34, 5)
    here = flexsc.sweep(short, "law.relay.k_t", gains)
    assert here == flexsc.sweep(short, "law.relay.k_t", gains, out=tmp_path / "out")
    assert here == flexsc.read_campaign(tmp_path / "out")
    with ThreadPoolExecutor(2) as pool:
        assert here == flexsc.sweep(short, "law.relay.k_t", gains, executor=pool)
        own = short.with_parts(law=Relay(5e-4, 1e-4, 4e-5, 1e-6, 0.31))
        alone = flexsc.sweep(own, "body.planar.angle", [1e-4, 2e-4], metrics=["duty"])
        assert alone == flexsc.sweep(own, "body.planar.angle", [1e-4, 2e-4], metrics=["duty"], executor=pool)


def test_dask_names_its_options() -> None:
    pytest.importorskip("distributed")
    import flexsc.dask

    theirs = dict(inspect.signature(flexsc.dask.campaign).parameters)
    ours = dict(inspect.signature(flexsc.campaign).parameters)
    assert theirs.keys() == {"client", *ours} - {"executor", "at", "topics"}
    assert all(theirs[name] == ours[name] for name in theirs.keys() & ours)


def test_rows_of_a_table_are_a_table() -> None:
    scenario = shipped("relay-sampled").with_("duration", 100.0)
    table = flexsc.campaign(scenario, 8, at=[50.0], topics=["attitude"])
    is_high = table["body.planar.angle"] >= np.sort(table["body.planar.angle"])[4]
    high = table[is_high]
    assert high.rows == 4
    assert high["run"].tolist() == table["run"][is_high].tolist()
    assert high.statistics()["duty"]["runs"] == high.rows
    assert high.statistics()["duty"]["mean"] == pytest.approx(high["duty"].mean())
    assert high.row(1).simulate().metrics["duty"] == high["duty"][1]
    assert high.samples is not None
    assert high.samples["attitude"]["angle_rad"].shape == (4, 1)
    assert table[[3, 1]]["run"].tolist() == [3, 1]
    assert table.sorted("duty")["duty"].tolist() == sorted(table["duty"])
    # All words are equal.
    assert table.sorted("error", descending=True)["run"].tolist() == table["run"].tolist()
    with pytest.raises(TypeError, match="a table takes the name of a column, a slice, a mask or positions"):
        table[["duty", "goal"]]  # type: ignore[list-item]
    with pytest.raises(TypeError, match="a table takes the name of a column"):
        table[0]  # type: ignore[call-overload]
    assert table[[]].rows == 0
    assert pickle.loads(pickle.dumps(high)) == high
    # A sweep takes the keys of a table that vary, and not its metrics.
    again = flexsc.sweep(scenario, points=flexsc.sweep(scenario, "duration", [50.0, 60.0]))
    assert again["duration"].tolist() == [50.0, 60.0]
