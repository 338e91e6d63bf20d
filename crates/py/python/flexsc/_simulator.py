"""A run advanced in steps."""

from __future__ import annotations

import os
from _thread import RLock
from typing import Any, Literal, NoReturn

from flexsc import _native as engine
from flexsc._numpy import np, npt
from flexsc._quantities import Fields, Quantities, parse_commands
from flexsc._result import Detail, Logged, Result
from flexsc._scenario import Scenario
from flexsc._units import Metrics
from flexsc._values import run_number

Event = Literal["sample", "decision", "switching", "window"]
"""The events that a run can be advanced to: see `Simulator.run_until`."""


def unpicklable(run: object) -> str:
    """Return why a run cannot be pickled."""
    return f"cannot pickle {type(run).__name__}, a state of this process; `Simulator.result()` can be pickled"


class Snapshot:
    """The saved state of a run at an instant, made by `Simulator.snapshot`. It cannot be pickled.

    >>> sim = flexsc.Simulator(flexsc.Scenario.example("relay-fixed"))
    >>> before = sim.snapshot()
    >>> sim.run_until(100.0)
    True
    >>> sim.restore(before)
    >>> sim.time == before.time == 0.0
    True
    """

    __slots__ = ("_native", "run", "scenario")

    def __init__(self, native: engine.Simulator, scenario: Scenario, run: int) -> None:
        self._native = native
        self.scenario = scenario
        self.run = run

    @property
    def time(self) -> float:
        """The time of the snapshot (s).

        >>> sim.snapshot().time == sim.time
        True
        """
        return self._native.time

    def __reduce__(self) -> NoReturn:
        raise TypeError(unpicklable(self))

    def __repr__(self) -> str:
        return f"<flexsc.Snapshot of {self.scenario.name}, run {self.run}, at {self.time:g} s>"


class Simulator:
    """A run advanced in steps: the same run as `scenario.simulate(run)`, in pieces.

    The run stops after the measurements at an instant and before the response to them. A command computed
    from `measured` or `state` therefore acts from that instant on. However a run is divided into steps, the
    results are bit-identical. Another thread that reads the run waits until a step has ended.

    Args:
        scenario: The scenario to simulate. Its `[law]` commands the actuator until the first command is
            given.
        run: Number of the run, which selects its noise. Keys of `[uncertain]` keep their nominal values:
            `Simulator(scenario.draw(7), 7)` has those of run 7.

    >>> sim = flexsc.Simulator(flexsc.Scenario.example("four-clamped-modes"))
    >>> sim.step([0.5, 0.0, -0.5], 0.1)      # N m about x, y and z for 0.1 s
    >>> sim.time, sim.state["rate"].shape
    (0.1, (3,))
    """

    __slots__ = ("_fields", "_lock", "_metrics", "_native", "_row", "run", "scenario")

    scenario: Scenario
    """The simulated scenario.

    >>> sim.scenario.name
    'four-clamped-modes'
    """
    run: int
    """The number of the run.

    >>> sim.run
    0
    """

    def __init__(self, scenario: Scenario, run: int = 0) -> None:
        # The engine refuses to be read while it advances, and other threads continue meanwhile.
        self._lock = RLock()
        self._set(engine.Simulator(scenario._native, run_number(run)), scenario, run_number(run))

    def _set(self, native: engine.Simulator, scenario: Scenario, run: int) -> None:
        self.scenario = scenario
        self.run = run
        self._native = native
        self._fields = Fields(native.fields)
        self._row: npt.NDArray[np.float64] | None = None
        self._metrics: Metrics | None = None

    @classmethod
    def _of(cls, native: engine.Simulator, scenario: Scenario, run: int) -> Simulator:
        simulator = cls.__new__(cls)
        simulator._lock = RLock()
        simulator._set(native, scenario, run)
        return simulator

    @property
    def time(self) -> float:
        """The time of the run (s).

        >>> sim.time
        0.1
        """
        with self._lock:
            return self._native.time

    @property
    def done(self) -> bool:
        """Whether the run has reached the end of the scenario's `duration`.

        >>> sim.done
        False
        """
        with self._lock:
            return self._native.done

    @property
    def axes(self) -> int:
        """The number of values in a command: 1, or 3 about x, y and z.

        >>> sim.axes
        3
        """
        with self._lock:
            return self._native.axes

    @property
    def command_unit(self) -> str:
        """The unit of commands: N m, or rad/s² for a body without inertia or with a prescribed motion of the
        hub.

        It is empty for the command of a wheel on one axis.

        >>> sim.command_unit
        'N m'
        """
        with self._lock:
            return self._native.command_unit

    @property
    def command_limit(self) -> npt.NDArray[np.float64]:
        """The largest command about each axis that the actuator can execute, of shape (axes,); infinite
        without a limit.

        >>> sim.command_limit.shape
        (3,)
        """
        with self._lock:
            return np.array(self._native.command_limit, dtype=np.float64)

    @property
    def state(self) -> Quantities:
        """The true state at the present time.

        For a single-axis body: `angle`, `rigid_angle` (rad), `rate`, `rigid_rate` (rad/s), `modes` (rad) and
        `mode_rates` (rad/s) of shape (modes,), `torque`, and `wheel_speed` (rad/s) if there is a wheel.

        For a three-axis body: `attitude`, the quaternion w, x, y, z that rotates vectors from the body frame
        to the inertial frame; `error` (rad), the angles relative to the target; `rate` and `rigid_rate`
        (rad/s), with and without the elastic part at the first sensor; `modes` (m sqrt(kg)) and `mode_rates`
        of shape (modes,); the `torque` of the actuator (N m); and `wheel_speeds` (rad/s) of shape (wheels,)
        if there are wheels.

        >>> sim.state["rate"].shape, sim.state.units["rate"]
        ((3,), 'rad/s')
        """
        return self._fields.view("state", self._observe_row())

    @property
    def measured(self) -> Quantities:
        """The latest measurements of the sensors: `angle` (rad), or on three axes `error` (rad), and `rate`
        (rad/s).

        NaN before the first sample. Without a sampled sensor they are the true motion at the present time.

        >>> sim.measured["error"].shape
        (3,)
        """
        return self._fields.view("measured", self._observe_row())

    @property
    def believed(self) -> Quantities:
        """The input of the laws, from the estimators: the same quantities as `measured`, at the last
        sample.

        >>> sim.believed["rate"].shape
        (3,)
        """
        return self._fields.view("believed", self._observe_row())

    def _observe_row(self) -> npt.NDArray[np.float64]:
        with self._lock:
            if self._row is None:
                self._row = self._native.look()
                self._row.flags.writeable = False
            return self._row

    def step(self, command: npt.ArrayLike | None, dt: float) -> None:
        """Advance by a time, or to the end of the scenario if that is earlier.

        Args:
            command: The command to the scenario's actuator from now until the next command, in place of its
                `[law]`: of shape (axes,), or a number for one axis, in `command_unit`. The actuator executes
                it like a command of the law: in its periods and within its limits. With None the last command
                stays in force, or the law if no command has been given yet.
            dt: The length of the step (s).

        >>> sim.step([0.0, 0.1, 0.0], 2.5)                                  # N m, s
        >>> round(sim.time, 9)
        2.6

        Raises:
            ValueError: The command has another shape or is not finite, or `dt` is not a positive time.
            SimulationError: The state is no longer finite, or the law switches without end.
        """
        with self._lock:
            native = self._native
            if command is not None:
                native.steer(parse_commands(command, (native.axes,), native.command_unit))
            self._row = self._metrics = None
            native.step(dt)

    def run_until(self, event: float | Event, limit: float = float("inf")) -> bool:
        """Advance to a time or an event, or to the end of the scenario if that is earlier.

        Args:
            event: A time (s), or one of `sample` (a sensor measures), `decision` (a law is about to decide),
                `switching` (a law has changed its state) and `window` (a window of the mean envelope has
                ended). A run under external commands has neither decisions nor switchings.
            limit: The latest time (s) to advance to, if `event` is an event.

        Returns:
            Whether the time or the event was reached.

        Raises:
            ValueError: The time is before the present one, or there is no such event.
            SimulationError: As `step`.

        >>> sim = flexsc.Simulator(flexsc.Scenario.example("relay-fixed"))
        >>> sim.run_until("switching"), sim.time < 100.0
        (True, True)
        """
        until = limit if isinstance(event, str) else float(event)
        with self._lock:
            if not until >= self.time:
                raise ValueError(f"the run is at {self.time:g} s and cannot go on to {until:g} s")
            self._row = self._metrics = None
            if isinstance(event, str):
                return self._native.run_to_next(event, until)
            self._native.run_until(min(until, 1e15))
            return self.time >= until

    @property
    def metrics(self) -> Metrics:
        """The metrics of the run so far; at its end those of the run.

        The run is repeated under its commands, once for each time at which they are read. Before its end they
        are those of a run that ends now.

        >>> scenario = flexsc.Scenario.example("relay-fixed").with_("duration", 500.0)
        >>> sim = flexsc.Simulator(scenario)
        >>> sim.run_until(500.0), sim.metrics["duty"] == scenario.simulate().metrics["duty"]
        (True, True)

        Raises:
            ValueError: The run is a copy of `Simulators` that did not keep its commands.
            SimulationError: As `step`.
        """
        with self._lock:
            if self._metrics is None:
                self._metrics = self.result("none").metrics
            return self._metrics

    def result(self, log: Detail = "events") -> Result:
        """Return the run so far as a result: metrics, columns, `at`, `sample`, `to_mcap` and figures.

        The run is repeated under its commands. Without commands, the result of a run at its end is that of
        `scenario.simulate(run, log)`, and its log file has the same bytes.

        Args:
            log: The detail of the columns, as in `Scenario.simulate`.

        >>> sim = flexsc.Simulator(flexsc.Scenario.example("four-clamped-modes"))
        >>> sim.step([0.5, 0.0, -0.5], 2.0)
        >>> sim.result("full")["rates"].rows > 0
        True

        Raises:
            ValueError: The run is a copy of `Simulators` that did not keep its commands.
            SimulationError: As `step`.
        """
        with self._lock:
            stepped, until = self._stepped(), self.time
        return self.scenario._simulate(self.run, log, True, stepped, until)

    def to_mcap(self, path: str | os.PathLike[str], log: Logged = "events") -> int:
        """Write the log of the run so far and return the number of bytes.

        The run is repeated under its commands, which the log holds as `commands.csv`; figures and viewers
        show it like any other. The metadata `end` is `interrupted` before the end of the run.

        >>> import pathlib, tempfile
        >>> sim = flexsc.Simulator(flexsc.Scenario.example("relay-fixed"))
        >>> sim.step(-1e-5, 30.0)
        >>> with tempfile.TemporaryDirectory() as out:
        ...     size = sim.to_mcap(pathlib.Path(out) / "run.mcap")
        ...     log = flexsc.read_log(pathlib.Path(out) / "run.mcap")
        >>> log.metadata["end"]
        'interrupted'

        Raises:
            ValueError: The run is a copy of `Simulators` that did not keep its commands.
            LogError: The file cannot be written.
        """
        return engine.to_mcap(self.scenario._native, self.run, log, path, self._stepped())

    def _stepped(self) -> engine.Commands:
        with self._lock:
            stepped = self._native.commands()
        if stepped is None:
            hint = "Simulators(..., keep_commands=True) keeps them"
            raise ValueError(f"the commands to run {self.run} were not kept: {hint}")
        return stepped

    def snapshot(self) -> Snapshot:
        """Save the state of the run, including all future noise, for `restore`.

        >>> before = sim.snapshot()
        >>> sim.step(None, 1.0)
        >>> sim.restore(before)
        >>> sim.time
        0.1
        """
        with self._lock:
            return Snapshot(self._native.copy(), self.scenario, self.run)

    def restore(self, snapshot: Snapshot) -> None:
        """Return to a snapshot, which can be used again.

        >>> before = sim.snapshot()
        >>> sim.step(None, 1.0)
        >>> sim.restore(before)
        >>> sim.time == before.time
        True

        Raises:
            ValueError: It is of another scenario.
        """
        if snapshot.scenario != self.scenario:
            raise ValueError(f"the snapshot is of another scenario, {snapshot.scenario.name}")
        with self._lock:
            self._set(snapshot._native.copy(), self.scenario, snapshot.run)

    def clone(self) -> Simulator:
        """Return a copy of the run at the same instant, which is advanced independently.

        >>> other = sim.clone()
        >>> other.step(None, 1.0)
        >>> round(other.time - sim.time, 9)
        1.0
        """
        with self._lock:
            return self._of(self._native.copy(), self.scenario, self.run)

    __copy__ = clone

    def __deepcopy__(self, memo: dict[int, Any]) -> Simulator:
        return self.clone()

    def __reduce__(self) -> NoReturn:
        raise TypeError(unpicklable(self))

    def __repr__(self) -> str:
        of = f"{self.scenario.name}, run {self.run}"
        return f"<flexsc.Simulator of {of}: at {self.time:g} s of {self.scenario.duration:g} s>"
