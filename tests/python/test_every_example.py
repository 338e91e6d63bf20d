"""Every shipped scenario through every exit of a run: frames of other libraries, pickles and copies."""

import copy
import pickle
from typing import Any

import flexsc
import numpy as np
import pytest
from flexsc import Result, Scenario

# Longest runs (s): rows of every topic, in little time.
LONGEST = 20.0


def short(name: str) -> Scenario:
    """A scenario whose run takes little time; one that cannot be cut is left as it is."""
    scenario = Scenario.example(name)
    try:
        return scenario.with_("duration", min(scenario.duration, LONGEST))
    except flexsc.ScenarioError:
        return scenario


@pytest.fixture(scope="module", params=sorted(flexsc.examples()))
def run(request: pytest.FixtureRequest) -> Result:
    scenario = short(request.param)
    if flexsc.estimate(scenario)["seconds"] > 20.0:
        pytest.skip("its run takes long, and its duration is fixed")
    return scenario.simulate(log="full")


def test_results_are_equal_to_themselves_and_to_their_copies(run: Result) -> None:
    again = pickle.loads(pickle.dumps(run))
    for other in (run, again, copy.deepcopy(run)):
        assert run == other
        assert (run != other) is False
        assert (run.metrics == other.metrics, run.metrics != other.metrics) == (True, False)
    assert run.at(1.0) == run.at(1.0)
    assert run.sample([0.0, 1.0]) == run.sample([0.0, 1.0])
    assert run == run.scenario.simulate(log="full")


def test_columns_have_a_row_for_each_time(run: Result) -> None:
    for topic in run.values():
        for name, values in topic.items():
            assert len(values) == topic.rows, (topic.name, name)
            if values.dtype == object:
                shapes = {np.shape(row) for row in values}
                assert len(shapes) > 1, (topic.name, name, "rows of one shape are one array")


def nested(values: Any) -> Any:
    """The cells of a column as lists, None for no value."""
    if isinstance(values, np.ndarray) and values.dtype == object:
        return [nested(row) for row in values]
    if isinstance(values, np.ndarray) and values.ndim > 1:
        return [nested(row) for row in values]
    return [None if value != value else value for value in values.tolist()]


def test_arrow_has_every_cell(run: Result) -> None:
    arrow: Any = pytest.importorskip("pyarrow")
    for topic in [*run.values(), *run.sample([0.0, 1.0]).values()]:
        table = arrow.table(topic)
        assert table.num_rows == topic.rows
        for name, values in topic.items():
            assert table[name].to_pylist() == nested(values), (topic.name, name)


@pytest.mark.parametrize("library", ["pandas", "polars", "xarray"])
def test_frames_have_every_row(run: Result, library: str) -> None:
    pytest.importorskip(library)
    for topics in (run, run.sample([0.0, 1.0])):
        frames = getattr(topics, f"to_{library}")()
        for name, topic in topics.items():
            if library == "xarray":
                found = frames[name].dataset
                assert all(found[column].shape[0] == topic.rows for column in topic)
                assert all(found[column].ndim == values.ndim for column, values in topic.items())
            else:
                assert len(frames[name]) == topic.rows, name


def test_tables_are_equal_to_their_copies_and_have_frames(run: Result) -> None:
    table = flexsc.campaign(run.scenario, 2)
    assert table == pickle.loads(pickle.dumps(table))
    for library, convert in (
        ("pandas", table.to_pandas),
        ("polars", table.to_polars),
        ("xarray", table.to_xarray),
    ):
        try:
            pytest.importorskip(library)
        except pytest.skip.Exception:
            continue
        convert()
