"""Hand-over: files for other programs, read by programs of others."""

from datetime import datetime, timedelta, timezone
from pathlib import Path
from typing import Any

import flexsc
import numpy as np
import pytest
from conftest import shipped
from flexsc import Result

EPOCH = "2026-03-20T14:46:00Z"


@pytest.fixture(scope="module")
def pointing() -> Result:
    """A spacecraft on an orbit that points to the planet."""
    scenario = shipped("detumble-and-point").with_({"duration": 400.0, "log.period": 2.0})
    return scenario.simulate(log="full")


@pytest.fixture(scope="module")
def ccsds() -> Any:
    return pytest.importorskip("brahe.ccsds", reason="brahe reads CCSDS messages: pip install brahe")


def test_attitude_and_orbit_messages_agree_in_another_reader(
    pointing: Result, ccsds: Any, tmp_path: Path
) -> None:
    """The rotation from frame A to frame B brings the nadir of the orbit message to that of the log."""
    pointing.export(tmp_path / "a.aem", frame="EME2000")
    pointing.export(tmp_path / "o.oem", frame="EME2000")
    attitude = ccsds.AEM.from_str((tmp_path / "a.aem").read_text())
    states = ccsds.OEM.from_str((tmp_path / "o.oem").read_text()).segments[0].states
    (trajectory,) = attitude.to_attitude_trajectories()
    orbit = pointing["orbit"]
    assert len(states) == len(attitude.segments[0].states) == orbit.rows == 201
    for row in range(0, 201, 20):
        position = np.array(states[row].position)
        rotation = np.array(trajectory.rotation_matrix(states[row].epoch).to_matrix())
        nadir = rotation @ (-position / np.linalg.norm(position))
        np.testing.assert_allclose(nadir, orbit["axes.nadir"][row], atol=1e-12)
        # The axes of the date are rotated into those of 2000.
        np.testing.assert_allclose(
            np.linalg.norm(position), np.linalg.norm(orbit["axes.position_m"][row]), atol=1e-5
        )
        # Degrees per second in the file, radians per second inside.
        rate = np.array(trajectory.angular_velocity(states[row].epoch))
        np.testing.assert_allclose(rate, pointing["rates"]["axes.rate_rad_s"][row], atol=1e-12)


def test_every_frame_has_a_name_that_another_reader_knows(
    pointing: Result, ccsds: Any, tmp_path: Path
) -> None:
    elements = shipped("two-line-orbit").with_({"duration": 20.0}).simulate(log="full")
    for run, frame in [(pointing, "EME2000"), (pointing, "GCRF"), (pointing, "ICRF"), (elements, "TEME")]:
        run.export(tmp_path / "a.aem", frame=frame)
        run.export(tmp_path / "o.oem", frame=frame)
        assert ccsds.AEM.from_str((tmp_path / "a.aem").read_text()).to_attitude_trajectories()
        assert ccsds.OEM.from_str((tmp_path / "o.oem").read_text()).to_trajectories()
    for run, frame in [(pointing, "TOD"), (pointing, "TEME"), (elements, "EME2000")]:
        with pytest.raises(ValueError, match="nutation"):
            run.export(tmp_path / "o.oem", frame=frame)


def test_logs_and_runs_in_memory_export_equal_bytes(pointing: Result, tmp_path: Path) -> None:
    pointing.to_mcap(tmp_path / "run.mcap", log="scene")
    log = flexsc.read_log(tmp_path / "run.mcap")
    for name in ["a.aem", "o.oem", "s.glb", "v.bin"]:
        size = log.export(tmp_path / f"log-{name}")
        assert pointing.export(tmp_path / name) == size
        assert (tmp_path / name).read_bytes() == (tmp_path / f"log-{name}").read_bytes()


def test_options_are_checked(tmp_path: Path) -> None:
    run = shipped("relay-fixed").with_({"duration": 20.0}).simulate()
    path = tmp_path / "run.aem"
    with pytest.raises(ValueError, match="the scenario has no `epoch`"):
        run.export(path)
    with pytest.raises(ValueError, match="the run has no orbit"):
        run.export(path, "oem", epoch=EPOCH)
    with pytest.raises(ValueError, match=r"must end in \.aem, \.oem, \.glb, \.bin"):
        run.export(tmp_path / "run.txt", epoch=EPOCH)
    with pytest.raises(ValueError, match="format must be one of 'aem', 'oem', 'glb', 'vizard', got 'kvn'"):
        run.export(path, "kvn")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="epoch must be a date and time"):
        run.export(path, epoch="yesterday")
    with pytest.raises(ValueError, match="speed must be from 1e-6"):
        run.export(tmp_path / "run.glb", speed=0.0)
    with pytest.raises(OSError, match="nowhere"):
        run.export(tmp_path / "nowhere" / "run.aem", epoch=EPOCH)
    assert not list(tmp_path.iterdir())
    # A date with a zone is the same instant.
    run.export(path, epoch=EPOCH)
    text = path.read_text()
    run.export(path, epoch=datetime(2026, 3, 20, 16, 46, tzinfo=timezone(timedelta(hours=2))))
    assert path.read_text() == text
    run.export(path, epoch=datetime(2026, 3, 20, 14, 46))
    assert path.read_text() == text


def test_events_alone_are_no_motion(tmp_path: Path) -> None:
    run = shipped("relay-fixed").with_({"duration": 20.0}).simulate()
    run.to_mcap(tmp_path / "run.mcap", log="events")
    with pytest.raises(ValueError, match="no motion"):
        flexsc.read_log(tmp_path / "run.mcap").export(tmp_path / "run.glb")


def length_at(data: bytes, at: int) -> tuple[int, int]:
    """A length of seven bits in each byte, and where it ends."""
    value, shift = 0, 0
    while data[at] >= 0x80:
        value |= (data[at] & 0x7F) << shift
        at, shift = at + 1, shift + 7
    return value | data[at] << shift, at + 1


def test_vizard_messages_are_read_by_protobuf(pointing: Result, tmp_path: Path) -> None:
    """The fields of Basilisk's vizMessage.proto that a run has, by their published numbers."""
    messages = pytest.importorskip("google.protobuf.message_factory", reason="protobuf reads them")
    from google.protobuf import descriptor_pb2, descriptor_pool

    kinds = descriptor_pb2.FieldDescriptorProto
    file = descriptor_pb2.FileDescriptorProto(name="viz.proto", package="viz", syntax="proto3")

    def message(kind_name: str, **fields: tuple[int, str, bool]) -> None:
        made = file.message_type.add(name=kind_name)
        for field, (number, kind, many) in fields.items():
            label = kinds.LABEL_REPEATED if many else kinds.LABEL_OPTIONAL
            added = made.field.add(name=field, number=number, label=label)
            if kind[0].isupper():
                added.type, added.type_name = kinds.TYPE_MESSAGE, f".viz.{kind}"
            else:
                added.type = getattr(kinds, f"TYPE_{kind.upper()}")

    message("Epoch", year=(1, "int32", False), month=(2, "int32", False), seconds=(6, "double", False))
    message("Time", frame=(1, "int64", False), elapsed=(2, "double", False))
    message("Body", name=(1, "string", False), mu=(5, "double", False))
    message("Wheel", axis=(4, "double", True), speed=(5, "double", False))
    message(
        "Craft",
        name=(1, "string", False),
        position=(2, "double", True),
        rotation=(4, "double", True),
        wheels=(5, "Wheel", True),
        parent=(19, "string", False),
    )
    message(
        "Viz",
        time=(1, "Time", False),
        bodies=(2, "Body", True),
        craft=(3, "Craft", True),
        epoch=(8, "Epoch", False),
    )
    pool = descriptor_pool.DescriptorPool()
    pool.Add(file)
    viz = messages.GetMessageClass(pool.FindMessageTypeByName("viz.Viz"))

    pointing.export(tmp_path / "run.bin")
    data, at, read = (tmp_path / "run.bin").read_bytes(), 0, []
    while at < len(data):
        length, at = length_at(data, at)
        read.append(viz.FromString(data[at : at + length]))
        at += length
    assert len(read) == pointing["pointing"].rows == 201
    assert (read[0].epoch.year, read[0].epoch.month) == (2027, 4)
    assert [body.name for body in read[0].bodies] == ["earth", "sun"]
    attitude, orbit = pointing["pointing"], pointing["orbit"]
    for row, found in enumerate(read):
        assert found.time.elapsed == pytest.approx(2e9 * row)
        main = found.craft[0]
        np.testing.assert_allclose(main.position, orbit["axes.position_m"][row])
        quaternion = np.array([attitude[f"q_{part}"][row] for part in "wxyz"])
        expected = quaternion[1:] * np.sign(quaternion[0]) / (1.0 + abs(quaternion[0]))
        np.testing.assert_allclose(main.rotation, expected, atol=1e-14)
        assert [wheel.speed for wheel in main.wheels] == list(pointing["wheels"]["wheels.speed_rad_s"][row])
        assert {part.parent for part in found.craft[1:]} == {"detumble-and-point"}
