"""The control system of a scenario as C99, by the command `flexsc export-c`."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Literal, get_args

from flexsc import _native as engine

if TYPE_CHECKING:
    from collections.abc import Sequence

    from flexsc._scenario import Scenario


Guest = Literal["cfs", "fprime"]


def export_c(
    scenario: Scenario,
    path: str | os.PathLike[str],
    name: str | None,
    calls: int,
    guests: Sequence[Guest],
    force: bool,
) -> list[Path]:
    """Write the control system of a scenario, and return its files."""
    if engine.parts_of(scenario._native):
        raise ValueError(f"{scenario.name}: a law that is written in Python has no code for flight")
    names = [guests] if isinstance(guests, str) else list(guests)
    for guest in names:
        if guest not in get_args(Guest):
            raise ValueError(f"guests: {guest!r} is none of {', '.join(get_args(Guest))}")
    stem = scenario.name if re.fullmatch(r"[\w.-]+", scenario.name) else "scenario"
    folder = Path(path)
    with tempfile.TemporaryDirectory(prefix="flexsc-") as scratch:
        file = Path(scratch) / f"{stem}.toml"
        file.write_text(scenario.to_toml(), encoding="utf-8")
        command = [sys.executable, "-m", "flexsc", "export-c", str(file), "-o", os.path.abspath(folder)]
        command += ["--calls", str(calls), *(["--force"] if force else [])]
        command += ["--name", name] if name is not None else []
        command += [f"--guest={guest}" for guest in names]
        done = subprocess.run(command, stderr=subprocess.PIPE, text=True, errors="replace", check=False)
    if done.returncode != 0:
        (_, _, why) = done.stderr.rpartition("error: ")
        raise ValueError(why.strip() or f"`flexsc export-c` ended with exit code {done.returncode}")
    return sorted(path for path in folder.rglob("*") if path.is_file())
