"""Analyses of the engine by name."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from flexsc import _native as engine

if TYPE_CHECKING:
    from flexsc._scenario import Scenario


def analysis(name: str, scenario: Scenario | None = None, /, **options: object) -> Any:
    """Run an analysis, and return its result as JSON has it: without NaN and infinity.

    A scenario that it found is the result's `scenario`.
    """
    text, found = engine.analysis(name, None if scenario is None else scenario._native, options)
    result = json.loads(text)
    if scenario is not None and found is not None:
        result["scenario"] = type(scenario)._of(found)
    return result
