"""What the command shows on a terminal, and what it does not show elsewhere."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import SCENARIOS, command_path

pty = pytest.importorskip("pty")
pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="terminals of POSIX")

ESCAPE = b"\x1b"
SAMPLED = str(SCENARIOS / "relay-sampled.toml")
CAMPAIGN = ["simulate", SAMPLED, "--set", "duration=300", "--runs", "300", "--table", "csv", "-o", "out"]
MISTAKE = ["simulate", str(SCENARIOS / "relay-fixed.toml"), "--set", "law.relay.kt=1"]

# What a machine may have set, and what changes what is shown.
DECIDING = ("NO_COLOR", "CLICOLOR", "CLICOLOR_FORCE", "CI")


def on_terminal(directory: Path, arguments: list[str], exits: int = 0, **environment: str) -> bytes:
    """What the command writes to a terminal as its stderr."""
    leader, follower = pty.openpty()
    clean = {name: value for name, value in os.environ.items() if name not in DECIDING}
    running = subprocess.Popen(
        [command_path(), *arguments],
        cwd=directory,
        stdout=subprocess.DEVNULL,
        stderr=follower,
        stdin=subprocess.DEVNULL,
        env={**clean, "TERM": "xterm-256color", **environment},
    )
    os.close(follower)
    shown = b""
    while True:
        try:
            part = os.read(leader, 65536)
        except OSError:
            break
        if not part:
            break
        shown += part
    os.close(leader)
    assert running.wait(timeout=60) == exits, shown.decode()
    return shown


def piped(directory: Path, arguments: list[str], exits: int = 0) -> bytes:
    done = subprocess.run([command_path(), *arguments], cwd=directory, capture_output=True, check=False)
    assert done.returncode == exits, done.stderr.decode()
    return done.stdout + done.stderr


def test_a_bar_shows_rate_and_time_left(tmp_path: Path) -> None:
    shown = on_terminal(tmp_path, CAMPAIGN)
    assert b"/300 runs" in shown
    assert b"/s, " in shown
    assert b" left" in shown
    assert b"table out/runs.csv" in shown


@pytest.mark.parametrize(
    "environment",
    [{"NO_COLOR": "1"}, {"TERM": "dumb"}, {"TERM": "dumb", "CI": "true"}, {"NO_COLOR": "1", "CI": "true"}],
)
def test_no_escapes_where_they_are_not_wanted(tmp_path: Path, environment: dict[str, str]) -> None:
    for arguments, exits in ((CAMPAIGN, 0), (MISTAKE, 2), (["simulate"], 2), (["--help"], 0)):
        shown = on_terminal(tmp_path, arguments, exits, **environment)
        assert ESCAPE not in shown
        assert b" left" not in shown


def test_no_bar_and_no_escapes_in_pipes(tmp_path: Path) -> None:
    for arguments, exits in ((CAMPAIGN, 0), (MISTAKE, 2), (["simulate"], 2), (["--help"], 0)):
        told = piped(tmp_path, arguments, exits)
        assert ESCAPE not in told
        assert b" left" not in told


def test_errors_and_hints_are_coloured_on_a_terminal(tmp_path: Path) -> None:
    shown = on_terminal(tmp_path, MISTAKE, 2)
    assert b"\x1b[1m\x1b[31merror:\x1b[0m " in shown
    assert b"unknown key" in shown
    # The same words as in a pipe.
    plain = shown.replace(b"\r\n", b"\n")
    for style in (b"\x1b[1m", b"\x1b[31m", b"\x1b[36m", b"\x1b[0m"):
        plain = plain.replace(style, b"")
    assert plain == piped(tmp_path, MISTAKE, 2)


def test_lines_for_machines_are_whole_objects(tmp_path: Path) -> None:
    """One object a line on stdout, of every verb that tells of several things."""
    fixed = str(SCENARIOS / "relay-fixed.toml")
    short = ["--set", "duration=500"]
    for arguments, count in (
        (["check", fixed, str(SCENARIOS / "wheel-ekf.toml"), "--json"], 2),
        (["simulate", fixed, *short, "--json"], 1),
        (["simulate", fixed, *short, "--runs", "3", "--json"], 4),
        (["sweep", fixed, *short, "--vary", "law.relay.k_t=0.3:0.34:4", "-o", "out", "--json"], 4),
        (["plot", "relay-fixed.mcap", "--what", "torque,modes", "--format", "svg", "--json"], 2),
        (["modes", fixed, "--json"], 1),
        (["cycle", fixed, "--json"], 1),
    ):
        done = subprocess.run([command_path(), *arguments], cwd=tmp_path, capture_output=True, check=True)
        lines = done.stdout.decode().splitlines()
        assert len(lines) == count, arguments
        assert all(isinstance(json.loads(line), dict) for line in lines), arguments
        # Several runs of what has nothing random are the same run.
        alike = b"warning: no metric differs" if "--runs" in arguments else b""
        assert done.stderr.startswith(alike), arguments
        assert done.stderr.count(b"\n") == (1 if alike else 0), arguments
