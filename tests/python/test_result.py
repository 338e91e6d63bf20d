"""Results: the command's metrics and log files to the bit, columns, errors."""

from pathlib import Path
from typing import Any, Literal

import flexsc
import numpy as np
import pytest
from conftest import SCENARIOS, Command, json_lines, shipped
from flexsc import LogError, Scenario, SimulationError


def plain(value: Any) -> Any:
    return value.tolist() if isinstance(value, np.ndarray) else value


@pytest.mark.parametrize("name", ["relay-adaptive", "relay-fixed", "relay-one-sided", "relay-sampled"])
def test_metrics_are_the_commands(name: str, command: Command) -> None:
    [told] = json_lines(command("simulate", SCENARIOS / f"{name}.toml", "--log", "none", "--json"))
    metrics = shipped(name).simulate(log="none").metrics
    assert {key: plain(value) for key, value in metrics.items()} == told["metrics"]


FULL_WHEEL = """duration = 220.0
law.attitude = { period = 0.25, bandwidth = 0.3 }
[spacecraft]
mass = 100.0
inertia = [[100, 0, 0], [0, 80, 0], [0, 0, 60]]
[[sensor]]
gyro = { period = 0.25 }
[actuator.wheels]
arrangement = "orthogonal"
inertia = 0.02
torque = 0.2
momentum = 0.3
[[target]]
from = 100.0
yaw = 1.0
acceleration = 1e-3
rate_limit = 1e-2
"""


def test_warnings_are_the_commands(tmp_path: Path, command: Command) -> None:
    path = tmp_path / "full.toml"
    path.write_text(FULL_WHEEL, encoding="utf-8")
    [told] = json_lines(command("simulate", path, "--log", "none", "--json"))
    run = Scenario.load(path).simulate(log="none")
    assert list(run.warnings) == told["warnings"]
    assert run.warnings[0].startswith("the target is lost, error up to ")
    assert "wheel 3 at its momentum limit for " in run.warnings[0]
    assert run.metrics["target_loss_limits"] == ["wheel 3 at its momentum limit"]
    # A limit that is never reached has a first time of NaN.
    assert np.isnan(run.metrics["wheel_torque_limit_starts_s"]).all()
    assert run.metrics == Scenario.load(path).simulate(log="none").metrics
    assert shipped("relay-fixed").with_("duration", 10.0).simulate(log="none").warnings == ()


@pytest.mark.parametrize(("log", "duration"), [("events", 20000.0), ("full", 2000.0)])
def test_log_files_are_the_commands(
    log: Literal["events", "full"], duration: float, tmp_path: Path, command: Command
) -> None:
    path = SCENARIOS / "relay-adaptive.toml"
    command("simulate", path, "--log", log, "--set", f"duration={duration}", "-o", "command")
    result = shipped("relay-adaptive").with_("duration", duration).simulate(log=log)
    size = result.to_mcap(tmp_path / "python.mcap")
    written = (tmp_path / "python.mcap").read_bytes()
    assert written == (tmp_path / "command" / "relay-adaptive.mcap").read_bytes()
    assert size == len(written)


def test_log_files_hold_what_is_asked_for(fixed: Scenario, tmp_path: Path) -> None:
    short = fixed.with_("duration", 100.0)
    quiet = short.simulate(log="none")
    assert quiet.topics == []
    assert list(quiet) == []
    quiet.to_mcap(tmp_path / "default.mcap")
    assert "command" in flexsc.read_log(tmp_path / "default.mcap")
    short.simulate().to_mcap(tmp_path / "full.mcap", log="full")
    assert "attitude" in flexsc.read_log(tmp_path / "full.mcap")
    with pytest.raises(ValueError, match="log must be 'events', 'full' or 'scene' for a file"):
        quiet.to_mcap(tmp_path / "none.mcap", log="none")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="log must be 'events', 'full', 'scene' or 'none', got \"all\""):
        short.simulate(log="all")  # type: ignore[arg-type]
    with pytest.raises(LogError, match=r"cannot write .*nowhere"):
        quiet.to_mcap(tmp_path / "nowhere" / "x.mcap")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["default.mcap", "full.mcap"]


def test_columns_have_types_and_shapes(fixed: Scenario) -> None:
    result = fixed.with_("duration", 50.0).simulate(log="full")
    assert set(result) == {"command", "law", "log", "attitude", "rate", "modes", "envelope"}
    command = result["command"]
    assert command["time_s"].dtype == np.float64
    assert command["time_fs"].dtype == np.int64
    assert command["state"].tolist()[:6] == ["RACC", "RBRK", "W+", "LACC", "LBRK", "W-"]
    assert command["cause"].tolist()[:3] == ["guard", "guard", "timeout"]
    exact = command["time_whole_s"] + command["time_fs"] / 1e15
    np.testing.assert_allclose(command["time_s"], exact, rtol=1e-15)
    modes, rows = result["modes"], len(result["modes"]["time_s"])
    # Each period of 0.1 s from 0 to 50 s, and each switching.
    assert rows == 501 + len(command["time_s"])
    assert modes["modes.displacement_rad"].shape == (rows, 2)
    np.testing.assert_allclose(modes["modes.displacement_rad"].sum(axis=1), modes["elastic_rad"], atol=1e-18)
    envelope = result["envelope"]
    np.testing.assert_allclose(envelope["modes.envelope_rad"].sum(axis=1), envelope["envelope_rad"])
    assert result["/modes"] is result["modes"]
    assert "/modes" in result
    assert "wheel" not in result
    with pytest.raises(KeyError, match="no topic 'wheel'; there are command, law"):
        result["wheel"]


def test_a_rigid_body_has_no_mode_columns(fixed: Scenario) -> None:
    rigid = fixed.with_({"duration": 10.0, "body.planar.modes": []}).simulate(log="full")
    assert rigid["modes"]["modes.displacement_rad"].shape == (len(rigid["modes"]["time_s"]), 0)


def test_runs_differ_by_their_noise_alone(sampled: Scenario) -> None:
    first, again, second = sampled.simulate(0), sampled.simulate(0), sampled.simulate(1)
    np.testing.assert_array_equal(first["command"]["time_s"], again["command"]["time_s"])
    assert first["command"]["time_s"].tolist() != second["command"]["time_s"].tolist()
    assert second.run == 1
    for wrong in (-1, 2**63):
        with pytest.raises(ValueError, match="number of a run must be from 0"):
            sampled.simulate(wrong)
    with pytest.raises(TypeError):
        sampled.simulate(1.5)  # type: ignore[arg-type]


def test_a_run_that_cannot_go_on_says_when(fixed: Scenario) -> None:
    with pytest.raises(SimulationError, match=r"^relay-fixed: the state is no longer finite at t = "):
        fixed.with_("body.planar.rate", 1e308).with_("body.planar.angle", 1e308).simulate()


def test_a_topic_of_the_motion_is_in_a_full_log() -> None:
    run = shipped("earth-observer").with_("duration", 1.0).simulate()
    with pytest.raises(KeyError, match="no topic 'pointing'; there are log: a run with log='full'"):
        run["pointing"]
    with pytest.raises(KeyError, match="no topic 'pointin'; there are log"):
        run["pointin"]


def test_texts_of_margins_have_no_arrays() -> None:
    scenario = shipped("earth-observer")
    for value in (scenario.margins(), scenario.spectrum(), shipped("bounded-jitter").bound()[0]):
        text = repr(value)
        assert "array(" not in text
        assert len(text) < 600
    assert "modulus=0.5773" in repr(scenario.margins())
