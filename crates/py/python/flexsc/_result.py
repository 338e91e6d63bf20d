"""Results of runs, and samples of their motion: topics as mappings of columns."""

from __future__ import annotations

import os
from collections.abc import Iterator
from math import inf
from typing import TYPE_CHECKING, Any, Literal

from flexsc import _native as engine
from flexsc._analysis import analysis
from flexsc._answer import Answer
from flexsc._columns import Lookup, read_only
from flexsc._drawable import Drawable
from flexsc._handover import Exportable
from flexsc._named import Named, library, no_such
from flexsc._numpy import np, npt
from flexsc._sample_times import SampleTimes
from flexsc._topic import Topic
from flexsc._units import Metrics

if TYPE_CHECKING:
    from flexsc._scenario import Scenario

Logged = Literal["events", "full", "scene"]
"""What a log file holds of a run."""
Detail = Literal["events", "full", "scene", "none"]
"""What is recorded of a run: see `Scenario.simulate`."""
# Times whose samples fit in memory on any body.
_FEW_TIMES = 10_000


class Topics(Lookup[Topic]):
    """Topics by name, each a mapping of columns."""

    _instead = "use to_pandas(), to_polars() or to_xarray(), or index it by the name of a topic"

    @property
    def topics(self) -> list[str]:
        """The names of the topics, without the slash that they have in a log file.

        >>> run.topics[:2]
        ['command', 'law']
        """
        raise NotImplementedError

    def _topic(self, name: str) -> Topic:
        raise NotImplementedError

    def __contains__(self, topic: object) -> bool:
        return isinstance(topic, str) and topic.removeprefix("/") in self.topics

    def __iter__(self) -> Iterator[str]:
        return iter(self.topics)

    def __len__(self) -> int:
        """The number of topics."""
        return len(self.topics)

    def __getitem__(self, topic: str) -> Topic:
        """Return the columns of a topic, such as `command`; other libraries can read them through Arrow.

        Every column has shape (rows,): numbers as float64, counts as int64, labels such as `state` as str.
        Values with several parts per row, such as modes, are columns of shape (rows, modes), such as
        `modes.displacement_rad`, or (rows, axes, modes); if the rows have different lengths, they are arrays
        of arrays.

        Raises:
            KeyError: There is no such topic.
        """
        if topic not in self:
            raise self._no_topic(topic)
        return self._topic(topic.removeprefix("/"))

    def _no_topic(self, topic: str) -> KeyError:
        return no_such("no topic", topic, self.topics)

    def to_pandas(self) -> dict[str, Any]:
        """Return each topic as a `pandas.DataFrame`: see `Topic.to_pandas`.

        >>> import flexsc
        >>> run = flexsc.Scenario.example("relay-fixed").with_("duration", 50.0).simulate()
        >>> run.to_pandas()["command"].groupby("state").size()          # doctest: +SKIP

        Raises:
            ImportError: pandas is not installed.
        """
        return Named.of({name: topic.to_pandas() for name, topic in self.items()}, "no topic")

    def to_polars(self) -> dict[str, Any]:
        """Return each topic as a `polars.DataFrame`: see `Topic.to_polars`.

        >>> import flexsc
        >>> run = flexsc.Scenario.example("relay-fixed").with_("duration", 50.0).simulate()
        >>> run.to_polars()["command"].height                           # doctest: +SKIP

        Raises:
            ImportError: Polars is not installed.
        """
        return Named.of({name: topic.to_polars() for name, topic in self.items()}, "no topic")

    def to_xarray(self) -> Any:
        """Return an `xarray.DataTree` with a data set per topic: see `Topic.to_xarray`.

        >>> import flexsc
        >>> run = flexsc.Scenario.example("relay-fixed").with_("duration", 50.0).simulate(log="full")
        >>> run.to_xarray()["modes"]["modes.displacement_rad"].dims     # doctest: +SKIP
        ('time_s', 'modes')

        Raises:
            ImportError: xarray (2024.10 or later) is not installed.
        """
        xarray = library("xarray", f"{type(self).__name__}.to_xarray")
        return xarray.DataTree.from_dict({name: topic.to_xarray() for name, topic in self.items()})


class Samples(Topics):
    """The motion of a run at chosen times: topics as columns, with one row per time.

    >>> import flexsc
    >>> run = flexsc.Scenario.example("relay-fixed").with_("duration", 100.0).simulate()
    >>> run.sample([50.0, 12.5])["attitude"]["time_s"].tolist()
    [50.0, 12.5]
    """

    times: npt.NDArray[np.float64]
    """The times (s), of shape (rows,).

    >>> run.sample([50.0, 12.5]).times.tolist()
    [50.0, 12.5]
    """

    def __init__(self, times: npt.NDArray[np.float64], topics: dict[str, Topic]) -> None:
        self.times = times
        self._topics = topics
        read_only([times])

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        read_only([self.times])

    @property
    def topics(self) -> list[str]:
        """The names of the topics.

        >>> run.sample([50.0, 12.5]).topics[:2]
        ['law', 'attitude']
        """
        return list(self._topics)

    def _topic(self, name: str) -> Topic:
        return self._topics[name]

    def __repr__(self) -> str:
        return f"<flexsc.Samples at {len(self.times)} times: {', '.join(self.topics)}>"


class Result(Topics, Exportable, Drawable):
    """The result of a run: its metrics, and a mapping of its topics as columns, which are read-only.

    >>> import flexsc
    >>> run = flexsc.Scenario.example("relay-fixed").with_("duration", 100.0).simulate(log="full")
    >>> run["attitude"]["angle_rad"].shape == run["attitude"]["time_s"].shape
    True
    >>> round(run.at(12.5)["attitude"]["angle_rad"], 9)
    9.298e-06
    """

    scenario: Scenario
    """The simulated scenario.

    >>> run.scenario.duration                                           # s
    100.0
    """
    run: int
    """The number of the run.

    >>> run.run
    0
    """
    samples: Samples | None
    """The motion at the times `at` of `Scenario.simulate`; None without them.

    >>> scenario = flexsc.Scenario.example("relay-fixed").with_("duration", 100.0)
    >>> scenario.simulate(at=[12.5, 50.0]).samples["attitude"]["angle_rad"].round(9).tolist()
    [9.298e-06, 0.000514145]
    """
    metrics: Metrics
    """Metrics by name, as `flexsc.metrics()` explains them: lists as arrays, None where there is no value.
    `metrics.unit(name)` returns their units.

    >>> run.metrics["switchings"], run.metrics.unit("cycle_period_s")
    (15, 's')
    """

    def __init__(
        self,
        scenario: Scenario,
        run: int,
        log: str,
        metrics: dict[str, Any],
        topics: dict[str, dict[str, npt.NDArray[Any]]],
        took: float = 0.0,
        stepped: engine.Commands | None = None,
        until: float = inf,
        answer: Answer | None = None,
        sampled: tuple[SampleTimes, dict[str, dict[str, Any]]] | None = None,
    ) -> None:
        self.scenario = scenario
        self.run = run
        self._answer = answer
        self.metrics = Metrics(metrics, scenario)
        self._log = log
        self._topics = self._named(topics)
        self._took = took
        self._stepped = stepped
        self._until = min(until, scenario.duration)
        self._drawn: engine.Log | None = None
        self._motion: engine.MotionSampler | None = None
        self.samples = None if sampled is None else self._sampled(*sampled)

    def __setattr__(self, name: str, value: object) -> None:
        # What a result says of its run stays as it is.
        if not name.startswith("_") and name in self.__dict__:
            raise AttributeError(f"cannot assign to {name!r}: results are read-only")
        object.__setattr__(self, name, value)

    @property
    def answer(self) -> Answer:
        """What was asked, whether it is met, by how much, and when not.

        As text it is the first screen of `flexsc simulate`.

        >>> run.answer.verdict
        'not_asked'
        """
        if self._answer is None:
            raise ValueError("a result that no run has made has no answer")
        return self._answer

    @property
    def warnings(self) -> tuple[str, ...]:
        """Warnings about the run, as `flexsc simulate` prints them.

        A target that is lost while an actuator is at a limit, an end in saturation, an unstable loop.

        >>> run.warnings
        ()
        """
        return tuple(warning["text"] for warning in self.answer.warnings)

    def _named(self, topics: dict[str, dict[str, npt.NDArray[Any]]]) -> dict[str, Topic]:
        about = {"scenario": self.scenario.name, "seed": str(self.scenario.seed), "run": str(self.run)}
        return {name: Topic(name, columns, self.scenario, about) for name, columns in topics.items()}

    @property
    def topics(self) -> list[str]:
        """The names of the topics.

        >>> run.topics[:2]
        ['command', 'law']
        """
        return list(self._topics)

    def _topic(self, name: str) -> Topic:
        return self._topics[name]

    def _no_topic(self, topic: str) -> KeyError:
        if self._log not in ("full", "scene") and str(topic).removeprefix("/") in analysis("topics"):
            there = ", ".join(self.topics) or "none"
            return KeyError(
                f"no topic {topic!r}; there are {there}: a run with log='full' has those of the motion"
            )
        return super()._no_topic(topic)

    def sample(self, times: npt.ArrayLike) -> Samples:
        """Return the exact motion at chosen times (s), whatever the detail of the run's log.

        The run is simulated again, up to the last time, and its exact motion is read at each time: nothing is
        interpolated. At the time of a row of a full log, such as a switching, the values are bit-identical to
        those of the row. Later calls go on from the last sample, or from one of 64 snapshots of the run; a
        run with parts of one's own has none, and is simulated from its start.

        Args:
            times: Of shape (times,), in any order, from 0 to the duration.

        Returns:
            The topics of the motion, such as `attitude` and `law` for a single-axis body and `pointing` for a
            three-axis one, each with one row per time, in the order of `times`.

        >>> import flexsc
        >>> run = flexsc.Scenario.example("relay-fixed").with_("duration", 50.0).simulate(log="none")
        >>> run.sample([0.0, 25.0, 50.0])["modes"]["modes.displacement_rad"].shape
        (3, 2)

        Raises:
            ValueError: A time is not within the run, or there are more than 200 000 000 values.
        """
        end = self._until
        what = "duration" if end == self.scenario.duration else "time of the run"
        asked = SampleTimes(times, end, what)
        if len(asked.asked) > _FEW_TIMES:
            asked.check_size(engine.sample_sizes(self.scenario._native, self.run))
        if self._motion is None:
            self._motion = engine.MotionSampler(self.scenario._native, self.run, self._stepped)
        return self._sampled(asked, self._motion.sample(asked.grown))

    def _sampled(self, times: SampleTimes, topics: dict[str, dict[str, Any]]) -> Samples:
        return Samples(times.asked.copy(), self._named(times.rows(topics)))

    def at(self, time: float) -> dict[str, dict[str, Any]]:
        """Return the exact motion at a time (s): the row of each topic of `sample`, as plain numbers.

        Values with several parts, such as modes, are arrays of shape (parts,). Use `sample` for many times.

        >>> import flexsc
        >>> run = flexsc.Scenario.example("relay-fixed").with_("duration", 50.0).simulate()
        >>> round(run.at(12.5)["attitude"]["angle_rad"], 9)
        9.298e-06

        Raises:
            ValueError: The time is not within the run.
        """
        seen = self.sample([time])

        def plain_cell(values: npt.NDArray[Any]) -> Any:
            return values[0].item() if values.ndim == 1 and values.dtype != object else values[0]

        rows = {name: {c: plain_cell(v) for c, v in seen[name].items()} for name in seen}
        return Named.of(
            {name: Named.of(row, f"topic {name!r} has no column") for name, row in rows.items()}, "no topic"
        )

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Result):
            return NotImplemented
        same = self.scenario == other.scenario and self.run == other.run and self.metrics == other.metrics
        return same and dict(self) == dict(other)

    def _native_log(self) -> engine.Log:
        """The log of the run, the source of figures: with its rows if the result has them."""
        if self._drawn is None:
            detail = "events" if self._log == "none" else self._log
            self._drawn = engine.log_of(self.scenario._native, self.run, detail, self._stepped)
        return self._drawn

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_drawn": None, "_motion": None}

    def to_mcap(self, path: str | os.PathLike[str], log: Logged | None = None) -> int:
        """Write the run's log, with the same bytes as the command writes, and return the number of bytes.

        The run is simulated again. The log of a run that was stepped under commands from outside holds them
        as `commands.csv`. `log` is the detail of the log; if omitted, that of the result, and at
        least `events`.

        >>> import flexsc, pathlib, tempfile
        >>> run = flexsc.Scenario.example("relay-fixed").with_("duration", 50.0).simulate()
        >>> with tempfile.TemporaryDirectory() as out:
        ...     size = run.to_mcap(pathlib.Path(out) / "run.mcap", log="full")
        ...     size == (pathlib.Path(out) / "run.mcap").stat().st_size
        True

        Raises:
            LogError: The file cannot be written.
        """
        detail = log or ("events" if self._log == "none" else self._log)
        return engine.to_mcap(self.scenario._native, self.run, detail, path, self._stepped)

    def _export(self, options: engine.ExportOptions, path: str | os.PathLike[str]) -> int:
        return engine.export_run(self.scenario._native, self.run, options, path, self._stepped)

    def __repr__(self) -> str:
        topics = ", ".join(self.topics) or "metrics only"
        until = f", to {self._until:g} s" if self._until < self.scenario.duration else ""
        return f"<flexsc.Result of {self.scenario.name}, run {self.run}{until}: {topics}>"

    def _repr_html_(self) -> str:
        from flexsc import _html

        about = f"run {self.run}, {self._until:g} s, seed {self.scenario.seed}"
        topics = [(name, self[name].rows, ", ".join(self[name])) for name in self]
        held = _html.folded(f"{len(topics)} topics", _html.table(("topic", "rows", "columns"), topics))
        figure = _html.of_log(self._native_log(), self.scenario._native) if self._took < _html.SOON_S else ""
        answer = self.answer._repr_html_()
        return _html.heading(self.scenario.name, about) + answer + figure + self.metrics._repr_html_() + held
