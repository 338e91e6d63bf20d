"""Export of a run in the formats of other programs: what logs and results share."""

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


class Exportable:
    """A run that can be written in the formats of other programs."""

    def export(
        self,
        path: str | os.PathLike[str],
        format: Format | None = None,
        *,
        epoch: str | datetime | None = None,
        frame: str | None = None,
        center: str | None = None,
        object_id: str | None = None,
        speed: float | None = None,
        modes: bool = False,
    ) -> int:
        """Write the run in a format of other programs, and return the number of bytes.

        A log must have the motion (`log="full"` or `"scene"`). A run in memory is simulated again with its
        motion and its scene, whatever the detail of the result.

        Args:
            path: The file, which is replaced if it exists.
            format: `aem` and `oem`, CCSDS attitude and orbit ephemeris messages; `glb`, an animated scene for
                browsers, Blender and Cesium; `vizard`, for the viewer of Basilisk. If omitted, by the ending
                of the file: `.aem`, `.oem`, `.glb` or `.bin`.
            epoch: The date of the start in UTC, for a scenario without `epoch`: `aem` and `oem` need one.
            frame: The frame of `aem` and `oem`: EME2000, GCRF, ICRF, TEME or TOD; if omitted, TEME with a
                `tle`, else EME2000.
            center: The planet of the orbit in `oem` and `vizard`; if omitted, EARTH.
            object_id: The international designator in `aem` and `oem`.
            speed: The speed of the animation in `glb` relative to real time; if omitted, it lasts at most a
                minute.
            modes: Whether `glb` also has an animation of each mode's shape.

        >>> import flexsc, pathlib, tempfile
        >>> scenario = flexsc.Scenario.example("relay-fixed").with_("duration", 50.0)
        >>> run = scenario.simulate(log="none")
        >>> with tempfile.TemporaryDirectory() as out:
        ...     size = run.export(pathlib.Path(out) / "run.aem", epoch="2026-03-20T14:46:00Z")
        ...     text = (pathlib.Path(out) / "run.aem").read_text()
        >>> text.splitlines()[0]
        'CCSDS_AEM_VERS = 2.0'

        Raises:
            ValueError: The run lacks what the format needs, such as an orbit, or an option contradicts it.
        """
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
        options = engine.ExportOptions(name, epoch, frame, center, object_id, speed, modes)
        return self._export(options, path)

    def _export(self, options: engine.ExportOptions, path: str | os.PathLike[str]) -> int:
        raise NotImplementedError
