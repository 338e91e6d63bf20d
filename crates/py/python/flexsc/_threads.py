"""The number of threads of many runs."""

from __future__ import annotations

from operator import index

from flexsc._scenario import Scenario


def threads(jobs: int | None, scenario: Scenario) -> int:
    """Return the number of threads, or 0 for one per core; parts written in Python run one at a time."""
    if jobs is None:
        return 1 if scenario.own_parts else 0
    count = index(jobs)
    if not 0 <= count <= 1024:
        raise ValueError(f"jobs must be from 0 to 1024, got {jobs}")
    return count
