"""Ensembles: the motion of all runs of a campaign at the same times."""

from __future__ import annotations

from copy import copy
from typing import TYPE_CHECKING, Any

from flexsc._columns import read_only, rectangular
from flexsc._named import library
from flexsc._numpy import np, npt
from flexsc._result import Topics
from flexsc._sample_times import missing
from flexsc._topic import Topic

if TYPE_CHECKING:
    from flexsc._sample_times import SampleTimes
    from flexsc._scenario import Scenario


class EnsembleTopic(Topic):
    """A topic of an ensemble: columns of shape (runs, times), or (runs, times, parts) for values with several
    parts, such as modes.

    >>> import flexsc
    >>> scenario = flexsc.Scenario.example("relay-sampled").with_("duration", 60.0)
    >>> table = flexsc.campaign(scenario, 3, at=[0.0, 30.0, 60.0, 45.0], topics=["attitude"])
    >>> table.samples["attitude"]["angle_rad"].shape
    (3, 4)
    """

    def to_xarray(self) -> Any:
        """Return the topic as an `xarray.Dataset` with the dimensions `run` and `time_s`.

        >>> table.samples["attitude"].to_xarray()["angle_rad"].dims         # doctest: +SKIP
        ('run', 'time_s')

        Raises:
            ImportError: xarray is not installed.
        """
        xarray = library("xarray", "EnsembleTopic.to_xarray")
        flat = self._flat()
        variables, shape = flat._variables("row"), self["time_s"].shape
        places = {"run": self["run"][:, 0], "time_s": self["time_s"][0]}
        found = {
            name: (("run", "time_s", *dimensions[1:]), values.reshape(*shape, *values.shape[1:]), attributes)
            for name, (dimensions, values, attributes) in variables.items()
            if name not in places
        }
        return xarray.Dataset(found, places, self._about())

    def to_pandas(self) -> Any:
        """Return a `pandas.DataFrame` with a row for each run and time.

        >>> table.samples["attitude"].to_pandas().groupby("time_s").mean()  # doctest: +SKIP

        Raises:
            ImportError: pandas is not installed.
        """
        return self._flat().to_pandas()

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        """Return the rows, one for each run and time, through Arrow's PyCapsule interface."""
        return self._flat().__arrow_c_stream__(requested_schema)

    def __arrow_c_schema__(self) -> object:
        """Return the schema of the rows through Arrow's PyCapsule interface."""
        return self._flat().__arrow_c_schema__()

    def unit(self, column: str) -> str:
        """Return the unit of a column; empty for a count, a ratio or a label.

        >>> table.samples["attitude"].unit("angle_rad")
        'rad'
        """
        return "" if column == "run" else Topic.unit(self, column)

    def _flat(self) -> _FlatTopic:
        columns = {name: values.reshape(-1, *values.shape[2:]) for name, values in self.items()}
        return _FlatTopic(self.name, columns, self._scenario, self._metadata)


class _FlatTopic(Topic):
    """An ensemble's topic with a row for each run and time."""

    unit = EnsembleTopic.unit


class Ensemble(Topics):
    """The motion of all runs of a campaign at the same times: topics of columns of shape (runs, times).

    A run that failed has NaN, and empty texts.

    >>> import flexsc
    >>> scenario = flexsc.Scenario.example("relay-sampled").with_("duration", 60.0)
    >>> samples = flexsc.campaign(scenario, 3, at=[0.0, 30.0, 60.0], topics=["attitude", "rate"]).samples
    >>> samples
    <flexsc.Ensemble of 3 runs at 3 times: attitude, rate>
    """

    times: npt.NDArray[np.float64]
    """The times (s), of shape (times,).

    >>> samples.times.tolist()
    [0.0, 30.0, 60.0]
    """
    runs: npt.NDArray[np.int64]
    """The numbers of the runs, of shape (runs,).

    >>> samples.runs.tolist()
    [0, 1, 2]
    """

    def __init__(
        self,
        scenario: Scenario,
        runs: npt.NDArray[np.int64],
        times: SampleTimes,
        seen: list[tuple[int, dict[str, dict[str, Any]]]],
    ) -> None:
        self.runs, self.times = np.array(runs, dtype=np.int64), times.asked.copy()
        found = {run: times.rows(topics) for run, topics in seen}
        # A run may lack the topic of a part that acts in one mode of operation.
        known = {name: columns for topics in found.values() for name, columns in topics.items()}
        about = {"scenario": scenario.name, "seed": str(scenario.seed)}
        self._topics = {
            name: EnsembleTopic(name, self._stacked(name, columns, found), scenario, about)
            for name, columns in known.items()
        }
        read_only([self.runs, self.times])

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        # A pickle does not keep that they are.
        read_only([self.runs, self.times])

    def _stacked(
        self, topic: str, columns: dict[str, npt.NDArray[Any]], found: dict[int, Any]
    ) -> dict[str, npt.NDArray[Any]]:
        """Return the columns of a topic over all runs."""
        shape = (len(self.runs), len(self.times))
        stacked = {
            "time_s": np.broadcast_to(self.times, shape).copy(),
            "run": np.broadcast_to(self.runs[:, None], shape).copy(),
        }
        for name, values in columns.items():
            if name in stacked:
                continue
            shaped = rectangular(values)
            lacking = missing(shaped.shape, shaped.dtype)
            of_runs = (found.get(run, {}).get(topic) for run in self.runs.tolist())
            stacked[name] = np.stack([lacking if of is None else rectangular(of[name]) for of in of_runs])
        return stacked

    def _taken(self, places: npt.NDArray[Any]) -> Ensemble:
        """Return the ensemble of the runs at some places."""
        taken = copy(self)
        taken.runs = self.runs[places]
        taken._topics = {
            name: EnsembleTopic(
                name, {c: v[places] for c, v in topic.items()}, topic._scenario, topic._metadata
            )
            for name, topic in self._topics.items()
        }
        read_only([taken.runs])
        return taken

    @property
    def topics(self) -> list[str]:
        """The names of the topics.

        >>> samples.topics
        ['attitude', 'rate']
        """
        return list(self._topics)

    def _topic(self, name: str) -> Topic:
        return self._topics[name]

    def __repr__(self) -> str:
        size = f"{len(self.runs)} runs at {len(self.times)} times"
        return f"<flexsc.Ensemble of {size}: {', '.join(self.topics)}>"
