"""Logs in files: topics as mappings of columns."""

from __future__ import annotations

import json
from functools import cached_property
from typing import TYPE_CHECKING, Any

from flexsc import _native as engine
from flexsc._answer import Answer
from flexsc._drawable import Drawable
from flexsc._handover import Exportable
from flexsc._result import Result, Samples, Topics
from flexsc._topic import Topic
from flexsc._values import arrays

if TYPE_CHECKING:
    import os
    from pathlib import Path

    from flexsc._numpy import npt
    from flexsc._scenario import Scenario
    from flexsc._units import Metrics


class Log(Topics, Exportable, Drawable):
    """A log file in memory.

    >>> import flexsc, pathlib, tempfile
    >>> run = flexsc.Scenario.example("relay-fixed").with_("duration", 100.0).simulate()
    >>> with tempfile.TemporaryDirectory() as out:
    ...     size = run.to_mcap(pathlib.Path(out) / "run.mcap")
    ...     log = flexsc.read_log(pathlib.Path(out) / "run.mcap")
    >>> log.metadata["end"], log["command"].rows == run["command"].rows
    ('complete', True)
    """

    def __init__(self, native: engine.Log) -> None:
        self._native = native
        self._names = {name.removeprefix("/"): name for name in native.topics}
        self._read: dict[str, Topic] = {}

    @property
    def topics(self) -> list[str]:
        """The names of the topics, without their slash.

        >>> log.topics[:2]
        ['command', 'law']
        """
        return list(self._names)

    @property
    def metadata(self) -> dict[str, str]:
        """The metadata of the run: `scenario`, `seed`, `run`, `version`, `end`, ...

        >>> log.metadata["seed"]
        '1'
        """
        return self._native.metadata

    @cached_property
    def scenario(self) -> Scenario | None:
        """The simulated scenario, if the log contains it.

        >>> log.scenario.duration                                           # s
        100.0

        Raises:
            ScenarioError: This version does not accept it.
        """
        from flexsc._scenario import Scenario

        text = self._native.scenario
        return None if text is None else Scenario.parse(text, self.metadata.get("scenario", "scenario"))

    @property
    def answer(self) -> Answer:
        """The answer of the run: it is repeated, or, where that is impossible, its rows are read.

        >>> log.answer.verdict
        'not_asked'
        """
        return Answer(engine.log_answer(self._native)[1])

    @cached_property
    def _run(self) -> Result:
        """The run, repeated once to see that it is that of the log."""
        from flexsc._scenario import Scenario

        scenario, run, commands, end, metrics = engine.log_run(self._native)
        return Result(Scenario._of(scenario), run, "none", metrics, {}, stepped=commands, until=end)

    @property
    def metrics(self) -> Metrics:
        """The metrics of the run, as `Result.metrics` has them; the run is repeated once.

        >>> log.metrics["switchings"], log.metrics.unit("cycle_period_s")
        (15, 's')

        Raises:
            ValueError: The run cannot be repeated, or is another one in this version: `log["metrics"]` has
                what was written.
        """
        return self._run.metrics

    def at(self, time: float) -> dict[str, dict[str, Any]]:
        """Return the exact motion at a time (s), as `Result.at` does; the run is repeated once.

        >>> round(log.at(12.5)["attitude"]["angle_rad"], 9)
        9.298e-06

        Raises:
            ValueError: The time is not within the run, or the run cannot be repeated.
        """
        return self._run.at(time)

    def sample(self, times: npt.ArrayLike) -> Samples:
        """Return the exact motion at chosen times (s), as `Result.sample` does; the run is repeated once.

        >>> log.sample([50.0, 12.5])["attitude"]["time_s"].tolist()
        [50.0, 12.5]

        Raises:
            ValueError: A time is not within the run, or the run cannot be repeated.
        """
        return self._run.sample(times)

    def frames(self, rate: float, exposure: float | None = None) -> tuple[Topic, list[dict[str, Any]]]:
        """Return the lines of sight as frames of a camera, and where lines of their spectrum land.

        The topic `frames` has, for each frame, the mean error about x, y and z over its exposure and the rms
        about it, for simulators of images. A line is a dictionary, the largest in the frames first: its
        source, its frequency and where it lands (Hz), and its amplitudes in the run and in the frames (rad).

        >>> craft = flexsc.Scenario.example("wheel-run-up").with_("duration", 2.0)
        >>> with tempfile.TemporaryDirectory() as out:
        ...     _ = craft.simulate(log="full").to_mcap(pathlib.Path(out) / "run.mcap")
        ...     frames, lines = flexsc.read_log(pathlib.Path(out) / "run.mcap").frames(5.0, 0.02)
        >>> list(frames)[:4], len(frames["time_s"])
        (['frame', 'time_s', 'line', 'mean_x_rad'], 10)

        Args:
            rate: Frames per second (Hz).
            exposure: Length of each exposure, at the start of its frame (s). Default: the whole frame.

        Raises:
            ValueError: The exposure is longer than a frame, or shorter than two samples.
            LogError: The log has no samples of a line of sight.
        """
        columns, lines = self._native.frames(rate, exposure)
        return Topic("frames", arrays(columns), self._known(), {}), json.loads(lines)

    def _export(self, options: engine.ExportOptions, path: str | os.PathLike[str]) -> int:
        return engine.export_log(self._native, options, path)

    def _topic(self, name: str) -> Topic:
        if name not in self._read:
            columns = arrays(self._native.columns(self._names[name]))
            about = {key: text for key in ("scenario", "seed", "run") if (text := self.metadata.get(key))}
            self._read[name] = Topic(name, columns, self._known(), about)
        return self._read[name]

    def __reduce__(self) -> tuple[Any, ...]:
        return _from_bytes, (self._native.path, self._native.contents)

    def _known(self) -> Scenario | None:
        try:
            return self.scenario
        except engine.ScenarioError:
            return None

    def __repr__(self) -> str:
        return f"<flexsc.Log: {', '.join(self.topics)}>"


def _from_bytes(path: Path, contents: bytes) -> Log:
    """Create the log of a pickle."""
    return Log(engine.Log.read(path, contents))
