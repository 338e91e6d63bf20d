"""The command that comes with the package."""

import signal
import subprocess
import sys
import time
from pathlib import Path

import flexsc
import pytest
from conftest import SCENARIOS, Command, command_path


def test_versions_agree(command: Command) -> None:
    version = f"flexsc {flexsc.__version__}\n"
    assert command("--version").stdout.decode() == version
    module = subprocess.run([sys.executable, "-m", "flexsc", "--version"], capture_output=True, check=True)
    assert module.stdout.decode() == version


def test_exit_codes(command: Command) -> None:
    assert (
        "unknown key"
        in command("check", SCENARIOS / "relay-fixed.toml", exits=0).stderr.decode()
        + command(
            "simulate", SCENARIOS / "relay-fixed.toml", "--set", "law.relay.kt=1", exits=2
        ).stderr.decode()
    )
    assert b"Usage: flexsc simulate" in command("simulate", exits=2).stderr


def test_a_run_is_live(command: Command) -> None:
    arguments = ["--live=127.0.0.1:0", "--speed", "max", "--set", "duration=10"]
    told = command("simulate", SCENARIOS / "relay-fixed.toml", *arguments).stderr.decode()
    assert "ws://127.0.0.1:" in told
    assert "as fast as possible" in told


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_control_c_reaches_the_engine(tmp_path: Path) -> None:
    arguments = ["simulate", str(SCENARIOS / "relay-fixed.toml"), "--set", "duration=1e10"]
    running = subprocess.Popen([command_path(), *arguments], cwd=tmp_path, stderr=subprocess.PIPE)
    partial = tmp_path / "relay-fixed.mcap.partial"
    began = time.monotonic()
    while not (partial.exists() and partial.stat().st_size > 100_000):
        assert time.monotonic() - began < 30.0
        time.sleep(0.01)
    running.send_signal(signal.SIGINT)
    _, told = running.communicate(timeout=30)
    assert running.returncode == 130
    assert b"interrupted" in told
    log = flexsc.read_log(tmp_path / "relay-fixed.mcap")
    assert log.metadata["end"] == "interrupted"
