"""Sweeps with points, samples, values of any type and logs: their rows are those of the command."""

from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

import flexsc
import numpy as np
import pytest
from conftest import SCENARIOS, Command, json_lines
from flexsc import Scenario, ScenarioError, Table

GAIN, ANGLE = "law.relay.k_t", "body.planar.angle"
RANGES = {GAIN: (0.28, 0.40), ANGLE: (0.0, 1e-3)}


def same(table: Table, rows: Sequence[dict[str, Any]]) -> None:
    """The rows of a table are those that the command printed."""
    assert table.rows == len(rows)
    for place, row in enumerate(rows):
        assert table["run"][place] == row["run"]
        for key, value in row["drawn"].items():
            assert table[key][place] == value
        for name, value in row["metrics"].items():
            mine: Any = table[name][place]
            np.testing.assert_array_equal(mine, np.nan if value is None else value)


@pytest.fixture
def short(fixed: Scenario) -> Scenario:
    return fixed.with_("duration", 300.0)


def by_command(command: Command, *arguments: str | Path) -> list[dict[str, Any]]:
    path = SCENARIOS / "relay-fixed.toml"
    return json_lines(command("sweep", path, "--set", "duration=300", "--json", *arguments))


@pytest.mark.parametrize("method", ["sobol", "latin-hypercube", "random"])
def test_samples_are_the_commands(short: Scenario, command: Command, method: Any) -> None:
    table = flexsc.sweep(short, RANGES, sample=(method, 16))
    varied = [f"--vary={key}={low!r}:{high!r}" for key, (low, high) in RANGES.items()]
    same(table, by_command(command, *varied, "--sample", f"{method}:16"))
    for key, (low, high) in RANGES.items():
        part = (table[key] - low) / (high - low)
        assert (part >= 0.0).all()
        assert (part < 1.0).all()
        if method != "random":
            # One point in each of 16 intervals: of a hypercube by definition, of Sobol's sequence as a net.
            assert sorted(np.floor(16.0 * part).astype(int).tolist()) == list(range(16))


def test_samples_combine_with_values_and_replicas(short: Scenario, command: Command) -> None:
    varied: dict[str, Any] = {"seed": [1, 2], GAIN: (0.28, 0.40)}
    table = flexsc.sweep(short, varied, sample=("sobol", 4), replicas=2)
    assert table.rows == 16
    arguments = (
        "--vary",
        "seed=1,2",
        "--vary",
        f"{GAIN}=0.28:0.40",
        "--sample",
        "sobol:4",
        "--replicas",
        "2",
    )
    same(table, by_command(command, *arguments))
    part = flexsc.sweep(short, varied, sample=("sobol", 4), replicas=2, runs=range(3, 9))
    assert part["run"].tolist() == list(range(3, 9))
    np.testing.assert_array_equal(part[GAIN], table[GAIN][3:9])
    with pytest.raises(ValueError, match="within the 16 runs of the sweep"):
        flexsc.sweep(short, varied, sample=("sobol", 4), replicas=2, runs=range(3, 17))


def test_a_sample_draws_uncertain_keys(sampled: Scenario, command: Command) -> None:
    short = sampled.with_("duration", 100.0)
    table = flexsc.sweep(
        short, {GAIN: (0.28, 0.40)}, sample=("latin-hypercube", 8), uncertain=True, metrics=["duty"]
    )
    path = SCENARIOS / "relay-sampled.toml"
    arguments = ("--set", "duration=100", "--vary", f"{GAIN}=0.28:0.40", "--sample", "latin-hypercube:8")
    same(table, json_lines(command("sweep", path, *arguments, "--uncertain", "--metrics=duty", "--json")))
    campaign = flexsc.campaign(short, range(2, 5), sample=("latin-hypercube", 8), metrics=["duty"])
    whole = flexsc.campaign(short, 8, sample="latin-hypercube", metrics=["duty"])
    np.testing.assert_array_equal(campaign[ANGLE], whole[ANGLE][2:5])
    with pytest.raises(ValueError, match="no key has a range"):
        flexsc.sweep(short, GAIN, [0.3], sample="sobol")


class Frame:
    """A data frame as pandas and Polars have it: columns by name, and their names."""

    def __init__(self, columns: dict[str, Any]) -> None:
        self._columns = {name: np.asarray(values) for name, values in columns.items()}
        self.columns = list(columns)

    def __getitem__(self, name: str) -> Any:
        return self._columns[name]


def test_points_are_the_commands(short: Scenario, command: Command, tmp_path: Path) -> None:
    columns = {GAIN: [0.3, 0.34, 0.36], ANGLE: [0.0, 1e-4, 5e-4]}
    rows = [dict(zip(columns, values, strict=True)) for values in zip(*columns.values(), strict=True)]
    path = tmp_path / "points.csv"
    text = "\n".join(f"{row[GAIN]!r}, {row[ANGLE]!r}" for row in rows)
    path.write_text(f"{GAIN}, {ANGLE}\n{text}\n")
    expected = by_command(command, "--points", path)
    for points in (columns, rows, path, Frame(columns)):
        same(flexsc.sweep(short, points=points), expected)
    both = flexsc.sweep(short, "seed", [1, 2], points=columns)
    same(both, by_command(command, "--points", path, "--vary", "seed=1,2"))
    # The directory of the command is that of the same sweep.
    path.write_text(f"{GAIN}\n0.3\n0.34\n")
    by_command(command, "--points", path, "-o", "out")
    again = flexsc.sweep(short, points=path, out=tmp_path / "out")
    assert again[GAIN].tolist() == [0.3, 0.34]


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("", "must begin with the keys of its columns"),
        ("0.3,0.4\n1,2\n", "must begin with the keys of its columns, got '0.3'"),
        (f"{GAIN}\n", "at least one key and one point"),
        (f"{GAIN},{ANGLE}\n0.3,1e-4\n0.3\n", "line 3 has 1 values, and there are 2 keys"),
        (f"{GAIN}\n0.3\nlarge\n", f"line 3: `{GAIN}` must be a number, got 'large'"),
        (f"{GAIN}\n0.3\ninf\n", f"line 3: `{GAIN}` must be a number, got 'inf'"),
        (f"{GAIN},{GAIN}\n0.3,0.4\n", "a key can be varied once"),
    ],
)
def test_a_file_of_points_is_checked(short: Scenario, tmp_path: Path, text: str, why: str) -> None:
    path = tmp_path / "points.csv"
    path.write_text(text)
    with pytest.raises(ValueError, match=why):
        flexsc.sweep(short, points=path)


@pytest.mark.parametrize(
    ("points", "why"),
    [
        ({GAIN: [0.3, 0.4], ANGLE: [0.0]}, "equally many values of each key, got 2 of 'law.relay.k_t'"),
        ([{GAIN: 0.3}, {ANGLE: 0.0}], "point 1 has the keys body.planar.angle"),
        ({}, "at least one key and one point"),
        ([], "at least one key and one point"),
        ({GAIN: "0.3"}, "must be of shape"),
        ({GAIN: [0.3, np.inf], ANGLE: [0.0, 0.0]}, "must be finite"),
    ],
)
def test_points_are_checked(short: Scenario, points: Any, why: str) -> None:
    with pytest.raises(ValueError, match=why):
        flexsc.sweep(short, points=points)


def test_words_flags_and_arrays_are_values(tmp_path: Path) -> None:
    observer = flexsc.Scenario.example("earth-observer").with_("duration", 4.0)
    key = "actuator.wheels.allocation"
    words = flexsc.sweep(observer, key, ["pseudo_inverse", "least_largest"], out=tmp_path / "words")
    assert words[key].tolist() == ["pseudo_inverse", "least_largest"]
    for place, word in enumerate(words[key]):
        alone = observer.with_(key, word.item()).simulate(log="none")
        assert alone.metrics["pointing_error_end_rad"] == words["pointing_error_end_rad"][place]
        assert words.row(place).scenario.get(key) == word
    read = flexsc.read_campaign(tmp_path / "words")
    assert read[key].tolist() == words[key].tolist()
    flags = flexsc.sweep(observer, "spacecraft.whole_damping", np.array([True, False]), metrics=["goal"])
    assert flags["spacecraft.whole_damping"].dtype == np.bool_
    assert flags["spacecraft.whole_damping"].tolist() == [True, False]
    assert flags.row(0).scenario.get("spacecraft.whole_damping") is True
    for place, flag in enumerate([True, False]):
        assert flags.row(place).scenario == observer.with_("spacecraft.whole_damping", flag)


def test_arrays_and_tables_are_values(fixed: Scenario) -> None:
    hold = flexsc.Scenario.example("attitude-hold").with_("duration", 20.0)
    inertias = np.array([np.diag([100.0, 120.0, 90.0]), np.diag([80.0, 90.0, 100.0])])
    table = flexsc.sweep(hold, "body.spatial.inertia", inertias)
    for place, inertia in enumerate(inertias):
        alone = hold.with_("body.spatial.inertia", inertia)
        assert table.row(place).scenario == alone
        metrics = alone.simulate(log="none").metrics
        assert table["pointing_error_end_rad"][place] == metrics["pointing_error_end_rad"]
    rates = np.array([[0.0, 0.0, 1e-3], [1e-3, 0.0, 0.0]])
    rated = flexsc.sweep(hold, "body.spatial.rate", rates)
    assert [row.tolist() for row in rated["body.spatial.rate"]] == rates.tolist()
    assert rated._grid() == {}
    # Structures of several kinds in one sweep.
    short = fixed.with_("duration", 200.0)
    modes = [short.get("body.planar.modes"), short.get("body.planar.modes")[:1]]
    parts = flexsc.sweep(short, points=[{"body.planar.modes": mode} for mode in modes] * 10)
    assert set(parts["error"]) == {""}
    for place in (0, 1, 18, 19):
        metrics = short.with_("body.planar.modes", modes[place % 2]).simulate(log="none").metrics
        assert parts["torque_impulse_per_hour_nm_s"][place] == metrics["torque_impulse_per_hour_nm_s"]


def test_a_value_of_another_type_is_refused(short: Scenario) -> None:
    with pytest.raises(ScenarioError, match="expected a number"):
        flexsc.sweep(short, GAIN, ["large", 0.3])
    table = flexsc.sweep(short, GAIN, [0.3, "large", 0.31])
    assert [bool(error) for error in table["error"]] == [False, True, False]
    with pytest.raises(ValueError, match="must be of shape"):
        flexsc.sweep(short, GAIN, "large")


def test_logs_are_the_commands(sampled: Scenario, command: Command, tmp_path: Path) -> None:
    short = sampled.with_("duration", 100.0)
    path = SCENARIOS / "relay-sampled.toml"
    arguments = ("--set", "duration=100", "--log", "full")
    command("simulate", path, *arguments, "--runs", "3", "-o", "theirs")
    table = flexsc.campaign(short, 3, out=tmp_path / "mine", log="full")
    rows = flexsc.read_campaign(tmp_path / "theirs")
    np.testing.assert_array_equal(table["duty"], rows["duty"])
    names = sorted(log.name for log in (tmp_path / "mine").glob("*.mcap"))
    assert names == [f"relay-sampled-{run}.mcap" for run in range(3)]
    for name in names:
        assert (tmp_path / "mine" / name).read_bytes() == (tmp_path / "theirs" / name).read_bytes()
    assert flexsc.read_log(tmp_path / "mine" / names[2]).scenario == short.draw(2)
    written = (tmp_path / "theirs" / "statistics.csv").read_text()
    assert (tmp_path / "mine" / "statistics.csv").read_text() == written
    command("sweep", path, *arguments, "--vary", f"{GAIN}=0.30,0.31", "-o", "swept")
    with ProcessPoolExecutor(1) as pool:
        flexsc.sweep(short, GAIN, [0.30, 0.31], out=tmp_path / "pool", log="full", executor=pool)
    for log in (tmp_path / "swept").glob("*.mcap"):
        assert (tmp_path / "pool" / log.name).read_bytes() == log.read_bytes()
    # The log of another run is not replaced.
    (tmp_path / "mine" / "runs" / "part-0000000000-0000000003.parquet").unlink()
    (tmp_path / "mine" / names[0]).write_bytes((tmp_path / "mine" / names[1]).read_bytes())
    with pytest.raises(ValueError, match=r"force=True"):
        flexsc.campaign(short, 3, out=tmp_path / "mine", log="full")
    flexsc.campaign(short, 3, out=tmp_path / "mine", log="full", force=True)
    assert flexsc.read_log(tmp_path / "mine" / names[0]).scenario == short.draw(0)

    def begun(*_: int) -> None:
        raise AssertionError("logs of more than 20 GB need yes=True")

    many = sampled.with_("duration", 2e4)
    with pytest.raises(ValueError, match="yes=True"):
        flexsc.campaign(many, 5000, out=tmp_path / "big", log="full", progress=begun)
    assert not flexsc.estimate(many, 5000)["needs_yes"], "it is the logs that do"
    wrong: Any
    for wrong in ({"log": "events"}, {"log": "events", "out": "s3://bucket/a"}, {"log": "everything"}):
        with pytest.raises(ValueError, match="log "):
            flexsc.campaign(short, 3, **wrong)


def test_a_row_has_the_plan_of_the_nominal_body() -> None:
    slew = flexsc.Scenario.example("rotation-robust")
    table = flexsc.campaign(slew, 3)
    for place in range(3):
        again = table.row(place).simulate("none").metrics
        for name in ("angle_error_peak_rad", "settling_time_s", "peak_torque_nm"):
            np.testing.assert_array_equal(again[name], table[name][place])
