"""Bounds: what asks for too much is refused before it begins, and logs of other programs are read."""

from pathlib import Path
from typing import Any

import flexsc
import numpy as np
import pytest
from conftest import shipped
from google.protobuf import descriptor_pb2, struct_pb2
from mcap.writer import Writer


def log_of(path: Path, name: str, schema: bytes, messages: list[bytes]) -> None:
    """A log with one topic, by the public writer."""
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start()
        number = writer.register_schema(name=name, encoding="protobuf", data=schema)
        channel = writer.register_channel(topic="/a", message_encoding="protobuf", schema_id=number)
        for index, message in enumerate(messages):
            time = index * 10**9
            writer.add_message(channel_id=channel, log_time=time, publish_time=time, data=message)
        writer.finish()  # type: ignore[no-untyped-call]


def schema_of(message: Any) -> bytes:
    files = descriptor_pb2.FileDescriptorSet()
    message.DESCRIPTOR.file.CopyToProto(files.file.add())
    data: bytes = files.SerializeToString()
    return data


def test_a_struct_is_refused_for_its_topic_alone(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    log_of(path, "google.protobuf.Struct", schema_of(struct_pb2.Struct), [b""])
    log = flexsc.read_log(path)
    assert log.topics == ["a"]
    with pytest.raises(flexsc.LogError, match=r"topic `/a`.*a `google.protobuf.Struct` within itself"):
        log["a"]


def test_lists_maps_and_signs_are_columns(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    messages = [
        descriptor_pb2.SourceCodeInfo.Location(path=[1, -2], leading_comments="grün"),
        descriptor_pb2.SourceCodeInfo.Location(path=[3, 4], span=[5]),
    ]
    data = [message.SerializeToString() for message in messages]
    log_of(path, "google.protobuf.SourceCodeInfo.Location", schema_of(descriptor_pb2.FileDescriptorSet), data)
    columns = flexsc.read_log(path)["a"]
    np.testing.assert_array_equal(columns["time_s"], [0.0, 1.0])
    np.testing.assert_array_equal(columns["path"], [[1, -2], [3, 4]])
    assert [list(span) for span in columns["span"]] == [[], [5]]
    assert list(columns["leading_comments"]) == ["grün", ""]


def test_long_work_needs_a_yes() -> None:
    long = shipped("wheel-ekf").with_("sensor.sampled.period", 1e-8)
    log: Any
    for log in ("none", "events"):
        with pytest.raises(ValueError, match=r"makes .* steps: about .* on one core(.|\n)*`yes=True`"):
            long.simulate(log=log)
    with pytest.raises(ValueError, match="steps in each of 10 runs"):
        flexsc.campaign(long, 10)
    with pytest.raises(ValueError, match="at most 100000000 runs, got 1000000000000"):
        flexsc.campaign(long, 10**12, yes=True)
    with pytest.raises(flexsc.ScenarioError, match=r"`law.pd.period` makes .* at most 1.0e12 are allowed"):
        long.with_("law.pd.period", 1e-13)
    with pytest.raises(ValueError, match="horizon must be at most 1e7 samples"):
        flexsc.papers.stability_map(shipped("wheel-ekf"), [0.3], [1e-15], yes=True)
    with pytest.raises(ValueError, match="runs and cycles must be from 1 to 1000000"):
        flexsc.papers.identify([(1.5, 2.0)], runs=10**12)


def test_pushes_come_within_some_turns_of_a_mode() -> None:
    with pytest.raises(ValueError, match="at most 1e5 rad later than its sample"):
        flexsc.papers.relay_damping([1.0], 0.1, period=1e20)


def test_work_is_estimated_beforehand() -> None:
    scenario = shipped("relay-sampled")
    one, all_ = flexsc.estimate(scenario), flexsc.estimate(scenario, runs=1000)
    assert set(one) == {"seconds", "steps", "key", "memory_bytes", "needs_yes"}
    assert (one["steps"], one["key"]) == (200_000.0, "sensor.sampled.period")
    assert all_["seconds"] == pytest.approx(1000 * one["seconds"])
    assert flexsc.estimate(scenario, log="full")["seconds"] > one["seconds"]
    assert not all_["needs_yes"]
    assert flexsc.estimate(scenario, runs=10_000_000)["needs_yes"]
    # It agrees with what is refused.
    with pytest.raises(ValueError, match=r"10000000 runs|1\.0e7 runs"):
        flexsc.campaign(scenario, runs=10_000_000)
    for runs in (0, -1):
        with pytest.raises(ValueError, match="runs must be at least 1"):
            flexsc.estimate(scenario, runs)
    with pytest.raises(ValueError, match="runs must be at most 100000000"):
        flexsc.estimate(scenario, 10**9)
    wrong: Any = "relay-sampled"
    with pytest.raises(TypeError, match=r"Scenario\.load reads a file"):
        flexsc.estimate(wrong)
    with pytest.raises(TypeError):
        flexsc.estimate(scenario, 1.5)  # type: ignore[arg-type]
