"""Files that are missing: errors that are `FileNotFoundError` and what they were before it."""

from __future__ import annotations

import errno
import os
from collections.abc import Callable
from typing import TypeVar

from flexsc import _native as engine

_Read = TypeVar("_Read")


class _Missing(FileNotFoundError):
    """A missing file, with the engine's text."""

    text: str

    def __str__(self) -> str:
        return self.text


class MissingScenarioError(_Missing, engine.ScenarioError):
    """A scenario file that does not exist."""


class MissingLogError(_Missing, engine.LogError):
    """A log file that does not exist."""


class MissingCampaignError(_Missing, ValueError):
    """A directory of a campaign that does not exist."""


_KINDS: list[tuple[type[Exception], type[_Missing]]] = [
    (engine.ScenarioError, MissingScenarioError),
    (engine.LogError, MissingLogError),
    (ValueError, MissingCampaignError),
]


def reading(path: str | os.PathLike[str], read: Callable[[str | os.PathLike[str]], _Read]) -> _Read:
    """Read a path; if it does not exist, the error is a `FileNotFoundError` with `errno` and `filename`."""
    try:
        return read(os.fsdecode(path))
    except (ValueError, OSError) as error:
        kind = next((missing for old, missing in _KINDS if isinstance(error, old)), None)
        if kind is None or os.path.lexists(path):
            raise
        missing = kind(errno.ENOENT, os.strerror(errno.ENOENT), os.fspath(path))
        missing.text = str(error)
        if isinstance(missing, engine.ScenarioError):
            missing.mistakes = getattr(error, "mistakes", [])
        raise missing from None
