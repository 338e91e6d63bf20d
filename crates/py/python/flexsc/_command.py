"""The command `flexsc`, started for a scenario of this process."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from flexsc._scenario import Scenario


def run(scenario: Scenario, verb: str, out: str | os.PathLike[str], options: list[str], force: bool) -> int:
    """Run a verb that writes something, and return its exit code: 0, or 3 if a requirement is not met.

    Raises:
        ValueError: It ended otherwise.
    """
    name = scenario.name if re.fullmatch(r"[\w.-]+", scenario.name) else "scenario"
    with tempfile.TemporaryDirectory(prefix="flexsc-") as folder:
        file = Path(folder) / f"{name}.toml"
        file.write_text(scenario.to_toml(), encoding="utf-8")
        command = [sys.executable, "-m", "flexsc", verb, str(file), "-o", os.path.abspath(out), *options]
        command += ["--force"] if force else []
        done = subprocess.run(command, stderr=subprocess.PIPE, text=True, errors="replace", check=False)
    if done.returncode in (0, 3):
        return done.returncode
    (_, _, why) = done.stderr.rpartition("error: ")
    # The option of the command is a keyword here.
    why = why.strip().replace("--force replaces", "force=True replaces")
    raise ValueError(why or f"`flexsc {verb}` ended with exit code {done.returncode}")
