"""The control system of a scenario as C99 or Rust, by the command `flexsc export-c`."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Literal, get_args

from flexsc import _command
from flexsc import _native as engine

if TYPE_CHECKING:
    from collections.abc import Sequence

    from flexsc._scenario import Scenario


Guest = Literal["cfs", "fprime"]
Language = Literal["c", "rust"]


def export_c(
    scenario: Scenario,
    path: str | os.PathLike[str],
    name: str | None,
    calls: int,
    guests: Sequence[Guest],
    language: Language,
    force: bool,
) -> list[Path]:
    """Write the control system of a scenario, and return its files."""
    if engine.parts_of(scenario._native):
        raise ValueError(f"{scenario.name}: a law that is written in Python has no code for flight")
    names = [guests] if isinstance(guests, str) else list(guests)
    for guest in names:
        if guest not in get_args(Guest):
            raise ValueError(f"guests: {guest!r} is none of {', '.join(get_args(Guest))}")
    if language not in get_args(Language):
        raise ValueError(f"language: {language!r} is none of {', '.join(get_args(Language))}")
    folder = Path(path)
    options = ["--as", language, "--calls", str(calls), *(f"--guest={guest}" for guest in names)]
    options += ["--name", name] if name is not None else []
    _command.run(scenario, "export-c", folder, options, force)
    return sorted(path for path in folder.rglob("*") if path.is_file())
