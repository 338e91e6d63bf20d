"""Columns elsewhere: NumPy owns them, other libraries read them through Arrow."""

from typing import Any

import flexsc
import numpy as np
import pytest
from conftest import shipped
from flexsc import Result, Scenario, Table, Topic
from flexsc._values import objects

arrow: Any = pytest.importorskip("pyarrow")


@pytest.fixture(scope="module")
def run() -> Result:
    return shipped("relay-adaptive").with_("duration", 2000.0).simulate(log="full")


@pytest.fixture(scope="module")
def table(sampled: Scenario) -> Table:
    return flexsc.campaign(sampled, runs=12)


def test_columns_are_moved_and_not_copied(run: Result) -> None:
    angle = run["attitude"]["angle_rad"]
    # The engine's own memory, which a capsule of the array frees.
    assert not angle.flags.owndata
    assert angle.base is not None
    assert angle.base is not run["attitude"]["rigid_rad"].base
    displacement = run["modes"]["modes.displacement_rad"]
    assert not displacement.flags.owndata
    assert np.shares_memory(displacement, displacement[:, 0])
    assert run["attitude"] is run["attitude"]


def test_topics_are_tables(run: Result) -> None:
    for name in run:
        topic = run[name]
        read = arrow.table(topic)
        assert read.schema.equals(arrow.schema(topic))
        assert read.schema.names == list(topic)
        assert read.num_rows == topic.rows
        about = {key.decode(): value.decode() for key, value in read.schema.metadata.items()}
        assert about == {"scenario": "relay-adaptive", "seed": "157", "run": "0", "topic": name}
        for column, values in topic.items():
            field = read.schema.field(column)
            assert (field.metadata or {}).get(b"unit", b"").decode() == topic.unit(column)
            if values.dtype.kind == "U":
                assert read[column].to_pylist() == values.tolist()
            elif values.dtype == object:
                assert read[column].to_pylist() == [row.tolist() for row in values]
            else:
                rows = np.array(read[column].to_pylist(), dtype=values.dtype)
                np.testing.assert_array_equal(rows, values)
    assert arrow.table(run["modes"]).schema.field("modes.displacement_rad").type == arrow.list_(
        arrow.float64(), 2
    )
    assert arrow.table(run["command"]).schema.field("time_fs").type == arrow.int64()
    assert arrow.table(run.sample([1.0, 2.0])["attitude"]).num_rows == 2


def test_campaigns_are_tables(table: Table) -> None:
    read = arrow.table(table)
    assert read.schema.equals(arrow.schema(table))
    assert read.schema.names == list(table)
    assert read.num_rows == 12
    assert read.schema.field("cycle_period_s").metadata == {b"unit": b"s"}
    assert table.unit("cycle_period_s") == "s"
    assert table.unit("body.planar.angle") == "rad"
    assert read.schema.field("body.planar.angle").metadata == {b"unit": b"rad"}
    with pytest.raises(KeyError, match="no column 'mass'"):
        table.unit("mass")
    lists = read["envelope_window_means_rad"].to_pylist()
    assert lists == [means.tolist() for means in table["envelope_window_means_rad"]]
    for column, values in table.columns.items():
        if values.dtype == np.float64:
            assert read[column].null_count == np.isnan(values).sum(), column
            numbers = [np.nan if cell is None else cell for cell in read[column].to_pylist()]
            np.testing.assert_array_equal(numbers, values)


def test_no_value_is_null(fixed: Scenario) -> None:
    swept = flexsc.sweep(fixed.with_("duration", 300.0), "law.relay.k_t", [0.31, 0.9])
    missing = [
        name
        for name, values in swept.columns.items()
        if values.dtype == np.float64 and np.isnan(values).any()
    ]
    assert missing
    read = arrow.table(swept)
    assert all(read[name].null_count > 0 for name in missing)


def test_rows_of_different_lengths_are_lists() -> None:
    rows = objects([np.array([1.5]), np.array([]), np.array([2.5, np.nan])])
    names = objects([np.array(["a"]), np.array([], dtype=np.str_), np.array(["b", "c"])])
    topic = Topic("pulses", {"modes.rate_rad_s": rows, "names": names}, None, {})
    read = arrow.table(topic)
    assert read["modes.rate_rad_s"].to_pylist() == [[1.5], [], [2.5, None]]
    assert read["names"].to_pylist() == [["a"], [], ["b", "c"]]
    assert read.schema.field("modes.rate_rad_s").metadata == {b"unit": b"rad/s"}


def test_a_topic_is_a_mapping_and_no_array(run: Result) -> None:
    command = run["command"]
    assert len(command) == len(list(command)) == len(dict(command))
    assert repr(command).startswith(f"<flexsc.Topic command: {command.rows} rows of time_s, time_whole_s, ")
    with pytest.raises(KeyError, match="topic 'command' has no column 'speed'; there are time_s"):
        command["speed"]
    with pytest.raises(TypeError, match="a topic is not an array"):
        np.asarray(command)
    # On a body without a moment of inertia a torque is an acceleration.
    assert command.unit("torque_nm") == "rad/s²"
    wheels = shipped("wheel-friction").with_("duration", 5.0).simulate(log="full")["wheels"]
    assert wheels.unit("wheels.torque_nm") == "N m"


@pytest.mark.parametrize("name", ["attitude", "command", "modes"])
def test_polars_reads_them(run: Result, name: str) -> None:
    polars: Any = pytest.importorskip("polars")
    frame = polars.DataFrame(run[name])
    assert frame.columns == list(run[name])
    assert frame["time_s"].to_list() == run[name]["time_s"].tolist()


def test_pandas_reads_them(run: Result, table: Table) -> None:
    pandas: Any = pytest.importorskip("pandas")
    frame = arrow.table(run["command"]).to_pandas()
    assert frame["state"].tolist() == run["command"]["state"].tolist()
    assert len(pandas.DataFrame(dict(run["command"]))) == run["command"].rows
    assert pandas.DataFrame(table.columns)["duty"].tolist() == table["duty"].tolist()
    if hasattr(pandas.DataFrame, "from_arrow"):
        assert pandas.DataFrame.from_arrow(table)["duty"].tolist() == table["duty"].tolist()
    with pytest.raises(TypeError, match="a topic is not an array"):
        pandas.DataFrame(run["command"])


def test_duckdb_reads_them(run: Result, table: Table) -> None:
    duckdb: Any = pytest.importorskip("duckdb")
    connection = duckdb.connect()
    command, rows = run["command"], table
    [(count, latest)] = connection.sql("select count(*), max(time_s) from command").fetchall()
    assert (count, latest) == (command.rows, command["time_s"][-1])
    [(mean,)] = connection.sql("select avg(duty) from rows").fetchall()
    assert mean == pytest.approx(rows["duty"].mean(), rel=1e-14)


def test_xarray_reads_them(run: Result) -> None:
    xarray: Any = pytest.importorskip("xarray")
    pytest.importorskip("pandas")
    data = xarray.Dataset.from_dataframe(arrow.table(run["attitude"]).to_pandas().set_index("time_s"))
    np.testing.assert_array_equal(data["angle_rad"].values, run["attitude"]["angle_rad"])
