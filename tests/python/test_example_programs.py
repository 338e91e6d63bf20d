"""The programs of examples/ run and reach their ends."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[2] / "examples"


def printed(name: str, *arguments: str) -> str:
    """What an example prints."""
    command = [sys.executable, str(EXAMPLES / name), *arguments]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_an_agent_of_stable_baselines_learns() -> None:
    pytest.importorskip("gymnasium")
    pytest.importorskip("stable_baselines3")
    rows = re.findall(r"(-[\d.]+) +([\d.]+)$", printed("ppo.py", "16384"), re.MULTILINE)
    assert len(rows) == 2
    (before, _), (after, _) = [(float(of), float(error)) for of, error in rows]
    # A sixth of the steps of the documentation.
    assert after > 0.7 * before


def test_a_controller_of_rollouts_turns_the_spacecraft() -> None:
    rows = [list(map(float, line.split())) for line in printed("mppi.py", "96", "50").splitlines()[1:]]
    times, errors, rates, torques = zip(*rows, strict=True)
    assert times == (0.0, 10.0, 20.0, 30.0, 40.0, 50.0)
    assert errors[0] > 1.4
    assert errors[-1] < 0.02
    assert rates[-1] < 0.01
    assert max(torques) <= 1.0
