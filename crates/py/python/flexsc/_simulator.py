"""Runs advanced in steps: one run, or thousands together."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Literal

from flexsc import _native as engine
from flexsc._scenario import Scenario, run_number

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

Event = Literal["sample", "decision", "switching", "window"]
"""The events that a run can be advanced to: see `Simulator.run_until`."""

# More copies than this are a mistake: each takes some kilobytes.
_MOST = 10_000_000


class Quantities(Mapping[str, "npt.NDArray[np.float64]"]):
    """The quantities of motion of a run at an instant: arrays by name, with units.

    For one run a quantity has shape () or (k,), for n copies shape (n,) or (n, k). The arrays do not change
    when the run is advanced.

    >>> sim = flexsc.Simulator(flexsc.Scenario.example("four-clamped-modes"))
    >>> sim.state["attitude"].shape, sim.state.units["rate"]
    ((4,), 'rad/s')
    """

    __slots__ = ("_values", "units")

    units: Mapping[str, str]
    """The unit of each quantity, empty for a dimensionless one."""

    def __init__(self, values: dict[str, npt.NDArray[np.float64]], units: Mapping[str, str]) -> None:
        self._values = values
        self.units = units

    def __getitem__(self, name: str) -> npt.NDArray[np.float64]:
        if name not in self._values:
            raise KeyError(f"no quantity {name!r}; there are {', '.join(self._values)}")
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __repr__(self) -> str:
        each = (f"{name}: {values} {self.units[name]}".rstrip() for name, values in self._values.items())
        return "\n".join(each)


class _Fields:
    """The positions of the quantities of each group in a row."""

    def __init__(self, fields: list[tuple[str, str, str, int | None]]) -> None:
        self._places: dict[str, list[tuple[str, int | slice]]] = {}
        units: dict[str, dict[str, str]] = {}
        at = 0
        for group, name, unit, count in fields:
            place = at if count is None else slice(at, at + count)
            self._places.setdefault(group, []).append((name, place))
            units.setdefault(group, {})[name] = unit
            at += 1 if count is None else count
        self._units = {group: MappingProxyType(each) for group, each in units.items()}

    def of(self, group: str, rows: npt.NDArray[np.float64]) -> Quantities:
        values = {name: rows[..., place] for name, place in self._places[group]}
        return Quantities(values, self._units[group])


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
        """The time of the snapshot (s)."""
        return self._native.time

    def __repr__(self) -> str:
        return f"<flexsc.Snapshot of {self.scenario.name}, run {self.run}, at {self.time:g} s>"


class Simulator:
    """A run advanced in steps: the same run as `scenario.simulate(run)`, in pieces.

    The run stops after the measurements at an instant and before the response to them. A command computed
    from `measured` or `state` therefore acts from that instant on. However a run is divided into steps, the
    results are bit-identical.

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

    __slots__ = ("_fields", "_native", "_row", "run", "scenario")

    scenario: Scenario
    """The simulated scenario."""
    run: int
    """The number of the run."""

    def __init__(self, scenario: Scenario, run: int = 0) -> None:
        self._set(engine.Simulator(scenario._native, run_number(run)), scenario, run_number(run))

    def _set(self, native: engine.Simulator, scenario: Scenario, run: int) -> None:
        self.scenario = scenario
        self.run = run
        self._native = native
        self._fields = _Fields(native.fields)
        self._row: npt.NDArray[np.float64] | None = None

    @classmethod
    def _of(cls, native: engine.Simulator, scenario: Scenario, run: int) -> Simulator:
        simulator = cls.__new__(cls)
        simulator._set(native, scenario, run)
        return simulator

    @property
    def time(self) -> float:
        """The time of the run (s)."""
        return self._native.time

    @property
    def done(self) -> bool:
        """Whether the run has reached the end of the scenario's `duration`."""
        return self._native.done

    @property
    def axes(self) -> int:
        """The number of values in a command: 1, or 3 about x, y and z."""
        return self._native.axes

    @property
    def command_unit(self) -> str:
        """The unit of commands: N m, or rad/s² for a body without inertia or with a prescribed motion of the
        hub.

        It is empty for the command of a wheel on one axis.
        """
        return self._native.command_unit

    @property
    def command_limit(self) -> npt.NDArray[np.float64]:
        """The largest command about each axis that the actuator can execute, of shape (axes,); infinite
        without a limit."""
        import numpy as np

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
        """
        return self._fields.of("state", self._look())

    @property
    def measured(self) -> Quantities:
        """The latest measurements of the sensors: `angle` (rad), or on three axes `error` (rad), and `rate`
        (rad/s).

        NaN before the first sample. Without a sampled sensor they are the true motion at the present time.
        """
        return self._fields.of("measured", self._look())

    @property
    def believed(self) -> Quantities:
        """The input of the laws, from the estimators: the same quantities as `measured`, at the last
        sample."""
        return self._fields.of("believed", self._look())

    def _look(self) -> npt.NDArray[np.float64]:
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

        Raises:
            ValueError: The command has another shape or is not finite, or `dt` is not a positive time.
            SimulationError: The state is no longer finite, or the law switches without end.
        """
        if command is not None:
            self._native.steer(_commands(command, (self.axes,), self.command_unit))
        self._row = None
        self._native.step(dt)

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
        if not until >= self.time:
            raise ValueError(f"the run is at {self.time:g} s and cannot go on to {until:g} s")
        self._row = None
        if isinstance(event, str):
            return self._native.run_to_next(event, until)
        self._native.run_until(min(until, 1e15))
        return self.time >= until

    def snapshot(self) -> Snapshot:
        """Save the state of the run, including all future noise, for `restore`."""
        return Snapshot(self._native.copy(), self.scenario, self.run)

    def restore(self, snapshot: Snapshot) -> None:
        """Return to a snapshot, which can be used again.

        Raises:
            ValueError: It is of another scenario.
        """
        if snapshot.scenario != self.scenario:
            raise ValueError(f"the snapshot is of another scenario, {snapshot.scenario.name}")
        self._set(snapshot._native.copy(), self.scenario, snapshot.run)

    def clone(self) -> Simulator:
        """Return a copy of the run at the same instant, which is advanced independently."""
        return self._of(self._native.copy(), self.scenario, self.run)

    __copy__ = clone

    def __deepcopy__(self, memo: dict[int, Any]) -> Simulator:
        return self.clone()

    def __repr__(self) -> str:
        of = f"{self.scenario.name}, run {self.run}"
        return f"<flexsc.Simulator of {of}: at {self.time:g} s of {self.scenario.duration:g} s>"


class Simulators:
    """Many runs of a scenario advanced together in steps, on all cores.

    Copy i is run `runs[i]`, with its keys of `[uncertain]` drawn. It is bit-identical to
    `Simulator(scenario.draw(run), run)` for any number of threads, and independent of the other copies.

    Args:
        scenario: The scenario from which the runs are drawn.
        runs: The number of runs, or the run number of each.
        jobs: Number of threads; if omitted, one per core.
        seed: Seed that replaces the scenario's.

    Raises:
        SimulationError: The keys drawn for a run do not make a valid scenario.

    >>> sims = flexsc.Simulators(flexsc.Scenario.example("four-clamped-modes"), 100)
    >>> state = sims.step(numpy.zeros((100, 3)), 0.1)
    >>> state["attitude"].shape
    (100, 4)
    """

    __slots__ = ("_fields", "_native", "_rows", "scenario")

    scenario: Scenario
    """The scenario from which the runs are drawn."""

    def __init__(
        self,
        scenario: Scenario,
        runs: int | Sequence[int] | npt.NDArray[np.integer[Any]] = 1000,
        jobs: int | None = None,
        seed: int | None = None,
    ) -> None:
        count = runs if isinstance(runs, int) else len(runs)
        if count > _MOST:
            raise ValueError(f"runs must be at most {_MOST}, got {count}")
        numbers = range(run_number(runs)) if isinstance(runs, int) else [run_number(run) for run in runs]
        if jobs is not None and not 1 <= jobs <= 1024:
            raise ValueError(f"jobs must be from 1 to 1024, got {jobs}")
        self.scenario = scenario if seed is None else scenario.with_("seed", seed)
        if not len(numbers):
            raise ValueError("runs must be one or more, got none")
        self._native = engine.Simulators(self.scenario._native, list(numbers), jobs or 0)
        self._fields = _Fields(self._native.fields)
        self._rows: npt.NDArray[np.float64] | None = None
        self._raise()

    def __len__(self) -> int:
        """The number of copies."""
        return len(self._native)

    def __getitem__(self, index: int) -> Simulator:
        """Return a clone of one copy."""
        index = range(len(self))[index]
        run = int(self.runs[index])
        scenario = self.scenario.draw(run)
        return Simulator._of(self._native.one(index), scenario, run)

    @property
    def runs(self) -> npt.NDArray[np.uint64]:
        """The run number of each copy, of shape (n,)."""
        return self._native.runs

    @property
    def time(self) -> npt.NDArray[np.float64]:
        """The time of each copy (s), of shape (n,)."""
        return self._native.time

    @property
    def done(self) -> npt.NDArray[np.bool_]:
        """Whether each copy has reached its end, of shape (n,). It stays there until it is reset."""
        return self._native.done

    @property
    def failed(self) -> npt.NDArray[np.bool_]:
        """Which copies have failed, of shape (n,). Their values are NaN until they are reset."""
        import numpy as np

        failed = np.zeros(len(self), dtype=np.bool_)
        failed[[index for index, _, _ in self._native.failed]] = True
        return failed

    @property
    def axes(self) -> int:
        """The number of values in a command: 1, or 3 about x, y and z."""
        return self._native.axes

    @property
    def command_unit(self) -> str:
        """The unit of commands: see `Simulator.command_unit`."""
        return self._native.command_unit

    @property
    def command_limit(self) -> npt.NDArray[np.float64]:
        """The largest command about each axis for the nominal scenario: see `Simulator.command_limit`."""
        import numpy as np

        return np.array(self._native.command_limit, dtype=np.float64)

    @property
    def state(self) -> Quantities:
        """The true states at the present time: those of `Simulator.state`, of shape (n,) or (n, k)."""
        return self._fields.of("state", self._look())

    @property
    def measured(self) -> Quantities:
        """The latest measurements of the sensors: see `Simulator.measured`."""
        return self._fields.of("measured", self._look())

    @property
    def believed(self) -> Quantities:
        """The input of the laws: see `Simulator.believed`."""
        return self._fields.of("believed", self._look())

    def _look(self) -> npt.NDArray[np.float64]:
        if self._rows is None:
            self._keep(self._native.look())
        assert self._rows is not None
        return self._rows

    def _keep(self, rows: npt.NDArray[np.float64]) -> None:
        rows.flags.writeable = False
        self._rows = rows

    def _raise(self) -> None:
        failed = self._native.failed
        if failed:
            each = [f"copy {index}, run {run}: {why}" for index, run, why in failed[:5]]
            more = [f"and {len(failed) - 5} more"] if len(failed) > 5 else []
            count = f"{len(failed)} of {len(self)} copies cannot go on"
            raise engine.SimulationError("\n".join([f"{self.scenario.name}: {count}", *each, *more]))

    def step(
        self,
        commands: npt.ArrayLike | None,
        dt: float,
        mask: npt.NDArray[np.bool_] | None = None,
    ) -> Quantities:
        """Advance all copies by a time. Other Python threads continue meanwhile.

        Args:
            commands: A command for each copy, of shape (n, axes), or (n,) for one axis, as in
                `Simulator.step`; None leaves the present source of commands in force.
            dt: The length of the step (s).
            mask: The copies to advance, of shape (n,); if omitted, all.

        Returns:
            The states at the end of the step.

        Raises:
            ValueError: The commands have another shape or are not finite, or `dt` is not a positive time.
            SimulationError: Copies have failed; the text names them. The others have completed the step:
                `reset(sims.failed)` restarts the failed ones.
        """
        native, n = self._native, len(self)
        if commands is not None:
            commands = _commands(commands, (n, native.axes), native.command_unit)
        self._keep(native.step(commands, dt, _mask(mask, n)))
        self._raise()
        return self.state

    def reset(
        self,
        mask: npt.NDArray[np.bool_] | None = None,
        runs: npt.ArrayLike | None = None,
    ) -> Quantities:
        """Restart copies.

        Args:
            mask: The copies to restart, of shape (n,); if omitted, all.
            runs: The new run number of each copy, of shape (n,), of which only those in the mask are used; if
                omitted, each copy restarts its own run. Another number draws new `[uncertain]` keys and
                noise.

        Returns:
            The states of all copies.

        Raises:
            ValueError: The mask or the run numbers have another shape.
            SimulationError: The keys drawn for a run do not make a valid scenario.
        """
        import numpy as np

        numbers = None
        if runs is not None:
            numbers = np.asarray(runs)
            if numbers.shape != (len(self),) or numbers.dtype.kind not in "iu" or (numbers < 0).any():
                raise ValueError(f"runs must be {len(self)} whole numbers from 0, got {runs!r}")
            numbers = numbers.astype(np.uint64)
        self._keep(self._native.reset(_mask(mask, len(self)), numbers))
        self._raise()
        return self.state

    def __repr__(self) -> str:
        return f"<flexsc.Simulators of {self.scenario.name}: {len(self)} copies>"


def _commands(given: npt.ArrayLike, shape: tuple[int, ...], unit: str) -> npt.NDArray[np.float64]:
    import numpy as np

    try:
        values = np.ascontiguousarray(given, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise ValueError(f"commands must be numbers of shape {shape}, got {given!r}") from error
    if np.shape(given) != shape:
        if shape[-1] != 1 or np.shape(given) != shape[:-1]:
            raise ValueError(f"commands must have shape {shape}, got {np.shape(given)}")
        values = values.reshape(shape)
    if not np.isfinite(values).all():
        where = np.argwhere(~np.isfinite(values))[0].tolist()
        raise ValueError(f"commands must be finite numbers{unit and f' of {unit}'}, not so at {where}")
    return values


def _mask(mask: npt.NDArray[np.bool_] | None, count: int) -> npt.NDArray[np.bool_] | None:
    import numpy as np

    if mask is None:
        return None
    mask = np.asarray(mask)
    if mask.shape != (count,) or mask.dtype != np.bool_:
        raise ValueError(f"a mask must be {count} of bool, got shape {mask.shape} of {mask.dtype}")
    return np.ascontiguousarray(mask)
