"""The page for a design review, by the command `flexsc report`."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from flexsc import _command
from flexsc import _native as engine

if TYPE_CHECKING:
    from flexsc._scenario import Scenario


def report(scenario: Scenario, path: str | os.PathLike[str], runs: int, force: bool) -> bool:
    """Write the page of a scenario, and return whether it meets its requirements and proves its claims."""
    if engine.parts_of(scenario._native):
        raise ValueError(f"{scenario.name}: a report has no parts that are written in Python")
    return _command.run(scenario, "report", path, ["--runs", str(runs)], force) == 0
