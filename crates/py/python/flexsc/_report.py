"""The page for a design review, by the command `flexsc report`."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from flexsc import _native as engine

if TYPE_CHECKING:
    from flexsc._scenario import Scenario


def report(scenario: Scenario, path: str | os.PathLike[str], runs: int, force: bool) -> bool:
    """Write the page of a scenario, and return whether it meets its requirements and proves its claims."""
    if engine.parts_of(scenario._native):
        raise ValueError(f"{scenario.name}: a report has no parts that are written in Python")
    name = scenario.name if re.fullmatch(r"[\w.-]+", scenario.name) else "scenario"
    with tempfile.TemporaryDirectory(prefix="flexsc-") as folder:
        file = Path(folder) / f"{name}.toml"
        file.write_text(scenario.to_toml(), encoding="utf-8")
        command = [sys.executable, "-m", "flexsc", "report", str(file), "-o", os.path.abspath(path)]
        command += ["--runs", str(runs), *(["--force"] if force else [])]
        done = subprocess.run(command, stderr=subprocess.PIPE, text=True, errors="replace", check=False)
    if done.returncode not in (0, 3):
        (_, _, why) = done.stderr.rpartition("error: ")
        raise ValueError(why.strip() or f"`flexsc report` ended with exit code {done.returncode}")
    return done.returncode == 0
