"""The progress of campaigns: a line on standard error, or a function of the caller."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable

Progress = bool | Callable[[int, int], None] | None
"""True for a line on standard error, False for none, or a function of the number of finished runs and the
total number; None for a line on a terminal where the work is long."""

# Work on one core (s) that is long.
_LONG_S = 60.0


def callback(progress: Progress, seconds: Callable[[], float]) -> Callable[[int, int], None] | None:
    """Return the function that is called with the progress, if any, of work that takes some seconds."""
    # A program without a console has no standard error.
    is_shown = progress is None and sys.stderr is not None and sys.stderr.isatty()
    if progress is True or (is_shown and seconds() > _LONG_S):
        return Line()
    return progress if callable(progress) else None


class Line:
    """A line on standard error, written again after each task."""

    def __init__(self) -> None:
        self._began = time.monotonic()

    def __call__(self, done: int, total: int) -> None:
        took = time.monotonic() - self._began
        left = f", {_duration(took * (total - done) / done)} left" if 0 < done < total else ""
        text = f"{done} of {total} runs, {_duration(took)}{left}"
        sys.stderr.write(f"\r{text:<60}" + ("\n" if done == total else ""))
        sys.stderr.flush()


def _duration(seconds: float) -> str:
    """Return a time in words: `4 s`, `3 min 20 s`, `2 h 5 min`."""
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60} s"
    return f"{whole // 3600} h {whole % 3600 // 60} min"
