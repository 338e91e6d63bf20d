"""Export of a run in the formats of other programs: the options that logs and results share."""

from __future__ import annotations

from datetime import datetime, timezone
from pathlib import Path
from typing import TYPE_CHECKING, Literal, TypeAlias

from flexsc import _native as engine

if TYPE_CHECKING:
    import os

Format: TypeAlias = Literal["aem", "oem", "glb", "vizard"]
"""CCSDS attitude and orbit ephemeris messages, glTF, and messages for Vizard."""

_ENDINGS = {".aem": "aem", ".oem": "oem", ".glb": "glb", ".bin": "vizard"}


def options(
    path: str | os.PathLike[str],
    format: Format | None,
    epoch: str | datetime | None,
    frame: str | None,
    center: str | None,
    object_id: str | None,
    speed: float | None,
    modes: bool,
) -> engine.ExportOptions:
    """Check the options of an export to a file; without a format, the ending of the file says which."""
    if format is None:
        ending = Path(path).suffix.lower()
        if ending not in _ENDINGS:
            raise ValueError(
                f"the file must end in {', '.join(_ENDINGS)} unless `format` is given, got {path}"
            )
        name = _ENDINGS[ending]
    else:
        name = format
    if isinstance(epoch, datetime):
        date = epoch if epoch.tzinfo is None else epoch.astimezone(timezone.utc).replace(tzinfo=None)
        epoch = date.isoformat() + "Z"
    return engine.ExportOptions(name, epoch, frame, center, object_id, speed, modes)
