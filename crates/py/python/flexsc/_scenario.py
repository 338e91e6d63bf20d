"""Scenarios, their results, and logs: topics as dictionaries of columns."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping
from functools import cached_property
from operator import index
from typing import TYPE_CHECKING, Any, Literal, overload

from flexsc import _native as engine
from flexsc._plan import Plan
from flexsc._values import arrays, document, plain, toml

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from flexsc._linear import Break, Linear
    from flexsc.parts import Actuator, Adaptation, Estimator, Law, Sensor


class Scenario:
    """A study: everything that a scenario file contains. It is valid and immutable.

    Args:
        values: The keys of a scenario file, as nested dictionaries. Numbers may be numpy's, lists its arrays;
            the `epoch` is a `datetime`.
        name: The scenario's name if `values` has none, and in errors.

    Raises:
        ScenarioError: A key is unknown, missing, or has a value that is not accepted.
    """

    __slots__ = ("_native",)
    _native: engine.Scenario

    def __init__(self, values: Mapping[str, object], name: str = "scenario") -> None:
        if not isinstance(values, Mapping):
            hint = "Scenario.load reads a file, Scenario.parse a text"
            raise TypeError(f"a scenario is made of a dict, not of a {type(values).__name__}; {hint}")
        self._native = engine.Scenario.from_values(document(name, {"name": name, **values}), name)

    @classmethod
    def _of(cls, native: engine.Scenario) -> Scenario:
        scenario = cls.__new__(cls)
        scenario._native = native
        return scenario

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Scenario:
        """Read a scenario file.

        Raises:
            ScenarioError: The file cannot be read, or is not accepted; the text names line, key and what is
                accepted.
        """
        return cls._of(engine.Scenario.load(path))

    @classmethod
    def parse(cls, text: str, name: str = "scenario") -> Scenario:
        """Read a scenario from TOML text. `name` is its name if it has none, and in errors.

        Raises:
            ScenarioError: The text is not accepted.
        """
        return cls._of(engine.Scenario.parse(text, name))

    @classmethod
    def example(cls, name: str) -> Scenario:
        """Read a shipped scenario by its name, one of `flexsc.examples()`.

        >>> flexsc.Scenario.example("relay-fixed").duration
        20000.0

        Raises:
            KeyError: There is none of this name.
        """
        return cls.parse(dict(engine.examples())[name], name)

    @property
    def name(self) -> str:
        """Name of the study."""
        return self._native.name

    @property
    def seed(self) -> int:
        """Seed of all randomness."""
        return self._native.seed

    @property
    def duration(self) -> float:
        """Simulated time (s)."""
        return self._native.duration

    @property
    def modes(self) -> dict[str, npt.NDArray[np.float64]]:
        """The elastic modes, as arrays of shape (modes,).

        `frequency` (rad/s), `period` (s), `damping` (ratio), `gain` (angle's response per unit of reduced
        torque), `excitability`, the gain over the squared frequency (s²), `effective_inertia`, the gain times
        the moment of inertia (kg m²), and `free_frequency` and `clamped_frequency` (rad/s), with the hub free
        and with the hub held; NaN where there is no such body.

        Of a spatial body `frequency`, `period` and `damping`, and `influence` of shape (modes, 3): the jump
        of the elastic rate at the gyro for each jump of the rigid rate that the jets give about x, y and z.
        """
        import numpy as np

        table = json.loads(self._native.modes_json())
        if self._native.spatial:
            names = {"frequency": "frequencies_rad_s", "period": "periods_s", "damping": "dampings"}
            of_modes = {name: np.array(table[key], dtype=np.float64) for name, key in names.items()}
            return of_modes | {"influence": np.array(table["influences"], dtype=np.float64).T}
        columns = {
            "frequency": table["frequencies_rad_s"],
            "period": table["periods_s"],
            "damping": table["dampings"],
            "gain": table["gains"],
            "excitability": table["excitabilities_s2"],
            "effective_inertia": table["effective_inertias_kg_m2"],
            "free_frequency": table["free_frequencies_rad_s"],
            "clamped_frequency": table["clamped_frequencies_rad_s"],
        }
        none = [np.nan] * self._native.mode_count
        return {
            name: np.array(none if column is None else column, dtype=np.float64)
            for name, column in columns.items()
        }

    @property
    def outputs(self) -> dict[str, npt.NDArray[np.float64]]:
        """The observed coordinates by name: weights of rigid angle and modes, of shape (1 + modes,)."""
        import numpy as np

        outputs = json.loads(self._native.modes_json()).get("outputs", [])
        return {o["name"]: np.array([o["rigid"], *o["weights"]], dtype=np.float64) for o in outputs}

    def to_dict(self) -> dict[str, Any]:
        """The scenario with all its defaults, as `Scenario(...)` takes it."""
        values: dict[str, Any] = plain(self._native.to_json())
        return values

    def to_toml(self) -> str:
        """The scenario with all its defaults, as TOML."""
        return self._native.to_toml()

    @overload
    def with_(self, key: str, value: object, /) -> Scenario: ...
    @overload
    def with_(self, keys: Mapping[str, object], /) -> Scenario: ...
    def with_(self, key: str | Mapping[str, object], value: object = None, /) -> Scenario:
        """A scenario with one key set, or several: `with_("law.relay.k_t", 0.34)`, `with_({"seed": 3, ...})`.

        Keys are paths into the file, such as `body.planar.modes[0].frequency`. Several are set together: only
        the result has to be valid.

        Raises:
            ScenarioError: A key or a value is not accepted.
        """
        keys = {key: value} if isinstance(key, str) else key
        return self._of(self._native.with_keys([(k, toml(self.name, k, v)) for k, v in keys.items()]))

    def with_parts(
        self,
        *,
        law: Law | None = None,
        sensor: Sensor | Mapping[int, Sensor] | None = None,
        estimator: Estimator | None = None,
        adaptation: Adaptation | None = None,
        actuator: Actuator | None = None,
    ) -> Scenario:
        """A scenario with parts of your own in the place of its own, as `flexsc.parts` describes them.

        The objects are copied: what happens to them later does not change the scenario. Several sensors are
        given by their places in the scenario's list, `sensor={1: MyTracker()}`; one alone takes the place of
        the first. No file can hold such parts: `to_toml` has empty tables for them, a log of a run does not
        repeat alone, and campaigns run in this process only.

        >>> class Off(flexsc.Law):
        ...     def decide(self, event):
        ...         return flexsc.Hold(0.0)
        >>> flexsc.Scenario.example("relay-fixed").with_parts(law=Off()).parts
        {'law': <...Off object at ...>}

        Raises:
            TypeError: An object is not of the class of its role.
            ScenarioError: The parts do not fit the others.
        """
        from flexsc import parts

        sensors = sensor if isinstance(sensor, Mapping) else {} if sensor is None else {0: sensor}
        given: list[tuple[str, type[Any], object]] = [
            ("law", parts.Law, law),
            ("estimator", parts.Estimator, estimator),
            ("adaptation", parts.Adaptation, adaptation),
            ("actuator", parts.Actuator, actuator),
            *((f"sensor {index(place)}", parts.Sensor, each) for place, each in sensors.items()),
        ]
        brought = []
        for role, kind, part in given:
            if part is None:
                continue
            if not isinstance(part, kind):
                found = part.__name__ if isinstance(part, type) else type(part).__name__
                raise TypeError(f"{role} must be an object of a flexsc.{kind.__name__}, got {found}")
            brought.append((role, part))
        return self._of(engine.with_parts(self._native, brought))

    @property
    def parts(self) -> dict[str, object]:
        """The parts of your own by role; sensors as `sensor 0`."""
        return dict(engine.parts_of(self._native))

    def linearise(
        self,
        at: float = 0.0,
        *,
        period: float | None = None,
        delay: float | None = None,
        loop: Break | None = None,
    ) -> Linear:
        """The scenario's body at rest as a linear model, or its loop cut open.

        States are rigid motion and modes, inputs the torques of the actuator (N m), outputs what is measured:
        angles and rates at the sensor with their elastic parts, then all states. Wheels' momentum couples the
        axes; surroundings and limits are left out.

        Args:
            at: The time (s) at which natural frequencies that drift are taken.
            period: Period of samples (s), at which inputs change and are held; None for continuous time.
            delay: How late inputs act (s); None for the delay of the scenario's wheel.
            loop: Cuts the loop of a linear law (`pd`, `attitude`, `state_space`) open, sampled with its
            period:
                at what it commands, at the actuator's torque, or at the measured angles and rates. The signs
                are those of negative feedback: `closed()` closes it again.

        >>> flexsc.Scenario.example("relay-fixed").linearise(period=0.5).a.shape
        (6, 6)

        Raises:
            ScenarioError: The body is no linear system: drives turn its appendages.
            ValueError: The loop is not linear, or a time is not accepted.
        """
        from flexsc._linear import linearise

        return linearise(self, at, period, delay, loop)

    def with_law(
        self,
        controller: object,
        period: float | None = None,
        *,
        method: Literal["held", "tustin"] = "held",
        command: Literal["torque", "acceleration"] = "torque",
        limit: float | None = None,
        track: bool = False,
    ) -> Scenario:
        """A scenario with a linear controller as its law, `[law.state_space]`.

        Args:
            controller: Matrices (A, B, C, D), or what has them, as `control.ss` and `scipy.signal.StateSpace`
            do;
                for three axes one for all, or a dict of one for `roll`, `pitch` and `yaw`. Its inputs are the
                errors of the angle (rad) and, if there are two, of the rate (rad/s): what is wanted less what
                is believed; its output is the command.
            period: Period of its samples (s), of a controller of continuous time; one of discrete time has
            it. method: How continuous time is sampled: with errors `held` over a period exactly, or by
            `tustin`. command: Whether the output is a torque (N m) or an acceleration (rad/s²).
            limit: Largest command; None without a limit.
            track: Whether it follows a manoeuvre while it lasts.

        >>> scenario = flexsc.Scenario.example("relay-fixed")
        >>> pd = scenario.with_law(([], [], [], [[0.04, 0.3]]), 0.25)
        >>> pd.to_dict()["law"]["state_space"]["d"]
        [[0.04, 0.3]]

        Raises:
            ScenarioError: The matrices are not accepted, or do not go with the other parts.
            ValueError: The period is missing, or there is more than one output.
        """
        from flexsc._linear import law_of

        return self.with_("law", law_of(controller, period, method, command, limit, track))

    def draw(self, run: int) -> Scenario:
        """The scenario of one run of a campaign: its `[uncertain]` keys drawn and set.

        `scenario.draw(57).simulate(run=57)` is run 57 of `campaign(scenario)`.

        Raises:
            ScenarioError: The drawn values do not make a valid scenario.
        """
        return self._of(self._native.draw(run_number(run)))

    def plan(self, band: float = 0.1) -> Plan:
        """The plan of the scenario's manoeuvre; frequencies are off by at most a relative `band`.

        Raises:
            ValueError: The scenario has no manoeuvre, or the band is not between 0 and 1.
        """
        return Plan(self._native, band)

    def simulate(
        self,
        run: int = 0,
        log: Literal["events", "full", "scene", "none"] = "events",
        yes: bool = False,
    ) -> Result:
        """Simulate the scenario. Other Python threads continue meanwhile.

        Args:
            run: Number of the run: another number, other noise.
            log: `events` keeps all that changes (switchings, window means, adaptation), `full` also the
                motion at each period of the scenario's log and at every switching, `none` the metrics only.
                `scene` is `full` for columns; a file that is written of it has the scene for viewers, too.
            yes: Run even if the estimate is more than 10 h on one core, 4 GB of memory or 20 GB of logs.

        Raises:
            SimulationError: The state is no longer finite, or the law switches without end.
            ValueError: The estimate is above these limits, and `yes` is not given.
        """
        run = run_number(run)
        metrics, topics = engine.simulate(self._native, run, log, yes)
        return Result(self, run, log, metrics, {name: arrays(columns) for name, columns in topics.items()})

    def __eq__(self, other: object) -> bool:
        return self._native == other._native if isinstance(other, Scenario) else NotImplemented

    # Two scenarios are equal with zeros of either sign, but differ as texts: there is no cheap hash.
    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        modes = self._native.mode_count
        return f"<flexsc.Scenario {self.name}: {self.duration:g} s, {modes} modes, seed {self.seed}>"

    def __reduce__(self) -> tuple[Any, ...]:
        parts = engine.parts_of(self._native)
        if parts:
            return _beside, (engine.text_beside_parts(self._native), self.name, parts)
        return Scenario.parse, (self.to_toml(), self.name)


def _beside(text: str, name: str, parts: list[tuple[str, object]]) -> Scenario:
    return Scenario._of(engine.beside_parts(text, name, parts))


class _Topics:
    """Topics by name, each as a dictionary of columns."""

    @property
    def topics(self) -> list[str]:
        """Names of the topics, without the slash that they have in a log file."""
        raise NotImplementedError

    def _columns(self, topic: str) -> dict[str, npt.NDArray[Any]]:
        raise NotImplementedError

    def __contains__(self, topic: object) -> bool:
        return isinstance(topic, str) and topic.removeprefix("/") in self.topics

    def __iter__(self) -> Iterator[str]:
        return iter(self.topics)

    def __getitem__(self, topic: str) -> dict[str, npt.NDArray[Any]]:
        """The columns of a topic, such as `command`.

        Every column has shape (rows,): numbers as float64, counts as int64, labels such as `state` as str.
        The parts of each row, such as its modes, are columns of shape (rows, modes), such as
        `modes.displacement_rad`; if the rows have different numbers of parts, arrays of arrays.

        Raises:
            KeyError: There is no such topic.
        """
        if topic not in self:
            raise KeyError(f"no topic {topic!r}; there are {', '.join(self.topics) or 'none'}")
        return self._columns(topic.removeprefix("/"))


class Result(_Topics):
    """What a run came to: its metrics, and its topics as columns."""

    scenario: Scenario
    """What was simulated."""
    run: int
    """The number of the run."""
    metrics: dict[str, Any]
    """Metrics by name, as `flexsc.metrics()` explains them: lists as arrays, None where there is none."""

    def __init__(
        self,
        scenario: Scenario,
        run: int,
        log: str,
        metrics: dict[str, Any],
        topics: dict[str, dict[str, npt.NDArray[Any]]],
    ) -> None:
        self.scenario = scenario
        self.run = run
        self.metrics = metrics
        self._log = log
        self._topics = topics

    @property
    def topics(self) -> list[str]:
        """Names of the topics."""
        return list(self._topics)

    def _columns(self, topic: str) -> dict[str, npt.NDArray[Any]]:
        return self._topics[topic]

    def to_mcap(
        self, path: str | os.PathLike[str], log: Literal["events", "full", "scene"] | None = None
    ) -> int:
        """Write the run's log, the same bytes as the command's, and return their number.

        The run is simulated again. `log` is what the log holds; left out, what the result holds, and at least
        `events`.

        Raises:
            LogError: The file cannot be written.
        """
        detail = log or ("events" if self._log == "none" else self._log)
        return engine.to_mcap(self.scenario._native, self.run, detail, path)

    def __repr__(self) -> str:
        topics = ", ".join(self.topics) or "metrics only"
        return f"<flexsc.Result of {self.scenario.name}, run {self.run}: {topics}>"


class Log(_Topics):
    """A log file in memory."""

    def __init__(self, native: engine.Log) -> None:
        self._native = native
        self._names = {name.removeprefix("/"): name for name in native.topics}
        self._read: dict[str, dict[str, npt.NDArray[Any]]] = {}

    @property
    def topics(self) -> list[str]:
        """Names of the topics, without their slash."""
        return list(self._names)

    @property
    def metadata(self) -> dict[str, str]:
        """What the log says about its run: `scenario`, `seed`, `run`, `version`, `end`, ..."""
        return self._native.metadata

    @cached_property
    def scenario(self) -> Scenario | None:
        """The scenario that was simulated, if the log has it.

        Raises:
            ScenarioError: This version does not accept it.
        """
        text = self._native.scenario
        return None if text is None else Scenario.parse(text, self.metadata.get("scenario", "scenario"))

    def _columns(self, topic: str) -> dict[str, npt.NDArray[Any]]:
        if topic not in self._read:
            self._read[topic] = arrays(self._native.columns(self._names[topic]))
        return self._read[topic]

    def __repr__(self) -> str:
        return f"<flexsc.Log: {', '.join(self.topics)}>"


def run_number(number: int) -> int:
    """Check the number of a run."""
    if not 0 <= index(number) < 2**63:
        raise ValueError(f"the number of a run must be from 0 to 2**63 - 1, got {number}")
    return index(number)
