"""Logs: what the engine wrote, read by the foreign reader and by our own, number by number."""

from pathlib import Path
from typing import Any

import flexsc
import numpy as np
import pytest
from conftest import shipped
from flexsc import LogError, Result, Scenario
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory


@pytest.fixture(scope="module")
def dense(adaptive: Scenario) -> Result:
    """Every topic, in about 10 000 messages."""
    return adaptive.with_({"duration": 200.0, "estimator.envelope.window": 20.0}).simulate(log="full")


@pytest.fixture(scope="module")
def path(dense: Result, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("logs") / "dense.mcap"
    dense.to_mcap(path)
    return path


def decoded(path: Path) -> dict[str, list[tuple[int, Any]]]:
    """Log time and message of each topic, by the public readers of MCAP and protobuf."""
    topics: dict[str, list[tuple[int, Any]]] = {}
    with path.open("rb") as file:
        reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
        for _, channel, message, proto in reader.iter_decoded_messages():
            topics.setdefault(channel.topic, []).append((message.log_time, proto))
    return topics


def labels(message: Any, field: str) -> str:
    """An enumeration's value as the label that columns have: W_PLUS is W+."""
    of = message.DESCRIPTOR.fields_by_name[field].enum_type
    name: str = of.values_by_number[getattr(message, field)].name
    return name.replace("_PLUS", "+").replace("_MINUS", "-")


def test_the_foreign_reader_sees_the_same_numbers(dense: Result, path: Path) -> None:
    topics = decoded(path)
    assert {name.removeprefix("/") for name in topics} == {*dense, "metrics", "summary", "params"}
    assert sum(map(len, topics.values())) < 20_000
    for name in dense:
        messages = topics[f"/{name}"]
        for column, values in dense[name].items():
            if column == "time_s" and name != "command":
                told: list[Any] = [time / 1e9 for time, _ in messages]
                np.testing.assert_allclose(told, values, rtol=0, atol=1.1e-9)
                continue
            outer, _, inner = column.partition(".")
            if inner:
                told = [[getattr(part, inner) for part in getattr(message, outer)] for _, message in messages]
            elif column == "timestamp":
                told = [message.timestamp.ToNanoseconds() / 1e9 for _, message in messages]
            elif values.dtype.kind == "U" and messages[0][1].DESCRIPTOR.fields_by_name[column].enum_type:
                told = [labels(message, column) for _, message in messages]
                values = np.char.upper(values)
            else:
                told = [getattr(message, column) for _, message in messages]
            np.testing.assert_array_equal(np.array(told), values, err_msg=f"{name} {column}")


def test_log_times_are_the_exact_times_in_nanoseconds(path: Path) -> None:
    for time, message in decoded(path)["/command"]:
        assert time == message.time_whole_s * 10**9 + message.time_fs // 10**6


def test_metrics_and_parameters_in_a_log(dense: Result, path: Path) -> None:
    topics = decoded(path)
    [(_, params)] = topics["/params"]
    assert Scenario.parse(params.toml) == dense.scenario
    assert (params.seed, params.run) == (157, 0)
    [(_, told)] = topics["/metrics"]
    metrics: dict[str, list[float]] = {}
    for metric in told.metrics:
        metrics.setdefault(metric.name, []).append(metric.text or metric.value)
    for name, value in dense.metrics.items():
        expected = [np.nan if value is None else value] if np.ndim(value) == 0 else list(value)
        if expected and isinstance(expected[0], str):
            assert metrics[name] == expected
        else:
            np.testing.assert_array_equal(metrics.get(name, []), expected, err_msg=name)


def test_our_reader_sees_the_same_columns(dense: Result, path: Path) -> None:
    log = flexsc.read_log(path)
    assert set(log) == {*dense, "metrics", "summary", "params"}
    for name in dense:
        for column, values in dense[name].items():
            if column == "time_s" and name != "command":
                np.testing.assert_allclose(log[name][column], values, rtol=0, atol=1.1e-9)
            else:
                np.testing.assert_array_equal(log[f"/{name}"][column], values)
                assert log[name][column].dtype == values.dtype
    assert log.scenario == dense.scenario
    assert (log.metadata["scenario"], log.metadata["end"]) == ("relay-adaptive", "complete")
    assert log["params"]["toml"].tolist() == [dense.scenario.to_toml()]
    with pytest.raises(KeyError, match="no topic 'wheel'; there are adaptation, attitude"):
        log["wheel"]


def test_an_epoch_moves_the_log_and_not_the_columns(fixed: Scenario, tmp_path: Path) -> None:
    from datetime import datetime, timezone

    epoch = datetime(2026, 3, 20, 14, 46, tzinfo=timezone.utc)
    result = fixed.with_({"duration": 50.0, "epoch": epoch}).simulate()
    result.to_mcap(tmp_path / "x.mcap")
    first = decoded(tmp_path / "x.mcap")["/params"][0][0]
    assert first == int(epoch.timestamp()) * 10**9
    log = flexsc.read_log(tmp_path / "x.mcap")
    np.testing.assert_array_equal(log["command"]["time_s"], result["command"]["time_s"])
    assert log["law"]["time_s"].tolist() == [0.0]


def test_damaged_logs_are_errors_and_nothing_else(fixed: Scenario, tmp_path: Path) -> None:
    good, bad = tmp_path / "good.mcap", tmp_path / "bad.mcap"
    fixed.with_("duration", 100.0).simulate().to_mcap(good)
    whole = good.read_bytes()
    random = np.random.default_rng(1)
    read = 0
    for trial in range(400):
        data = bytearray(whole)
        if trial % 4 == 0:
            data = data[: random.integers(len(data))]
        else:
            for place in random.integers(len(data), size=random.integers(1, 4)):
                data[place] ^= 1 << random.integers(8)
        bad.write_bytes(data)
        try:
            log = flexsc.read_log(bad)
            for topic in log:
                log[topic]
            _ = log.scenario
            read += 1
        except (LogError, flexsc.ScenarioError):
            pass
    assert read < 400
    bad.write_bytes(whole[:-100])
    with pytest.raises(LogError, match="the log is torn"):
        flexsc.read_log(bad)
    with pytest.raises(LogError, match=r"nowhere\.mcap"):
        flexsc.read_log(tmp_path / "nowhere.mcap")
    bad.write_bytes(b"time,angle\n")
    with pytest.raises(LogError, match="not a readable MCAP log"):
        flexsc.read_log(bad)


def test_the_scene_is_read_by_all(tmp_path: Path) -> None:
    path = tmp_path / "scene.mcap"
    result = shipped("rotation-sine").with_({"duration": 6.0, "log.period": 0.1}).simulate(log="scene")
    assert "tf" not in result  # columns hold what is measured, not what is drawn
    result.to_mcap(path)
    topics = decoded(path)
    [(_, scene)] = topics["/scene"]
    [words] = [text.text for entity in scene.entities for text in entity.texts]
    assert words == "bending \N{MULTIPLICATION SIGN} 1, turning \N{MULTIPLICATION SIGN} 1 (schematic)"
    frames = [message for _, message in topics["/tf"]]
    assert [frame.child_frame_id for frame in frames[0].transforms[:3]] == ["body", "panel_1/1", "panel_1/2"]
    # The body's frame is where the engine's body is, at each period of the log.
    angle = [2 * np.arctan2(m.transforms[0].rotation.z, m.transforms[0].rotation.w) for m in frames]
    np.testing.assert_allclose(angle, result["attitude"]["angle_rad"], rtol=0, atol=1e-6)
    log = flexsc.read_log(path)
    assert log["tf"]["transforms.rotation.z"].shape == (len(frames), 9)
    assert log["log"]["message"].tolist() == [message.message for _, message in topics["/log"]]
    assert log["plumes"]["entities.id"][0].tolist() == []


def test_the_schemas_of_viewers_are_the_published_ones(tmp_path: Path) -> None:
    import importlib

    path = tmp_path / "scene.mcap"
    shipped("rotation-sine").with_("duration", 1.0).simulate().to_mcap(path, log="scene")
    compared: set[str] = set()

    def compare(own: Any) -> None:
        if not own.full_name.startswith("foxglove.") or own.full_name in compared:
            return
        compared.add(own.full_name)
        module = importlib.import_module(f"foxglove_schemas_protobuf.{own.name}_pb2")
        published = getattr(module, own.name).DESCRIPTOR
        assert own.file.name == published.file.name
        for field in own.fields:
            other = published.fields_by_name[field.name]
            assert (field.number, field.type) == (other.number, other.type)
            assert field.is_repeated == other.is_repeated
            if field.message_type:
                assert field.message_type.full_name == other.message_type.full_name
                compare(field.message_type)
            if field.enum_type:
                assert field.enum_type.full_name == other.enum_type.full_name
                numbers = {value.name: value.number for value in field.enum_type.values}
                assert numbers == {value.name: value.number for value in other.enum_type.values}

    for topic in ("/log", "/tf", "/scene", "/plumes"):
        compare(decoded(path)[topic][0][1].DESCRIPTOR)
    assert {"foxglove.Log", "foxglove.FrameTransform", "foxglove.SceneUpdate", "foxglove.Color"} <= compared


def test_a_log_has_metrics_and_motion_of_its_run(dense: Result, path: Path, tmp_path: Path) -> None:
    log = flexsc.read_log(path)
    assert log.metrics == dense.metrics
    assert log.metrics.unit("cycle_period_s") == "s"
    assert log.at(123.4) == dense.at(123.4)
    assert dict(log.sample([0.1, 150.0])) == dict(dense.sample([0.1, 150.0]))
    with pytest.raises(ValueError, match="times must be from 0 to the duration, 200 s, got 201"):
        log.at(201.0)
    # Of a run under commands from outside too, up to its end.
    sim = flexsc.Simulator(shipped("attitude-hold"))
    for torque in (0.02, -0.03, 0.0):
        sim.step([torque, 0.0, 0.5 * torque], 0.7)
    stepped = sim.result("full")
    stepped.to_mcap(tmp_path / "stepped.mcap")
    again = flexsc.read_log(tmp_path / "stepped.mcap")
    assert again.metrics == stepped.metrics
    assert again.at(1.3) == stepped.at(1.3)
    with pytest.raises(ValueError, match=r"times must be from 0 to the time of the run, 2\.1 s, got 2.2"):
        again.at(2.2)


def test_a_run_of_own_parts_is_not_repeated_from_its_log(tmp_path: Path) -> None:
    class Off(flexsc.Law):
        period = 1.0

        def decide(self, event: flexsc.parts.Event) -> float:
            return 0.0

    own = shipped("relay-fixed").with_("duration", 20.0).with_parts(law=Off())
    own.simulate().to_mcap(tmp_path / "own.mcap")
    with pytest.raises(ValueError, match=r"only the program of its parts \(law\) can repeat its run"):
        flexsc.read_log(tmp_path / "own.mcap").metrics  # noqa: B018
