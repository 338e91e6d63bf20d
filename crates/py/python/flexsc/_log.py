"""Logs in files: topics as mappings of columns."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

from flexsc import _native as engine
from flexsc._answer import Answer
from flexsc._drawable import Drawable
from flexsc._handover import Exportable
from flexsc._result import Topics
from flexsc._topic import Topic
from flexsc._values import arrays

if TYPE_CHECKING:
    import os
    from pathlib import Path

    from flexsc._scenario import Scenario


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
