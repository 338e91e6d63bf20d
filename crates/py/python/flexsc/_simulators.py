"""Runs of a scenario advanced together in steps."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from operator import index as place
from typing import Any, NoReturn

from flexsc import _native as engine
from flexsc._copies import Copies
from flexsc._numpy import np, npt
from flexsc._quantities import Quantities, parse_commands
from flexsc._scenario import Scenario
from flexsc._simulator import Simulator, Snapshot, unpicklable
from flexsc._sources import Source, check_scenarios, held, parse_sources
from flexsc._threads import threads
from flexsc._values import checked, run_number

# More copies than this are a mistake: each takes some kilobytes.
_MOST = 10_000_000


class Simulators(Copies):
    """Many runs of a scenario advanced together in steps, on all cores.

    Copy i is run `runs[i]`, with its keys of `[uncertain]` drawn. It is bit-identical to
    `Simulator(scenario.draw(run), run)` for any number of threads, and independent of the other copies.
    `Simulators.of(simulator, n)` starts copies at the present state of a run instead, for roll-outs.

    Args:
        scenario: The scenario from which the runs are drawn.
        runs: The number of runs, or the run number of each.
        jobs: Number of threads, at most 1024; 0, or if omitted, one per core.
        seed: Seed that replaces the scenario's.
        keep_commands: Whether copies keep their commands, 64 bytes each, so that `sims[i].metrics`,
            `sims[i].result()` and `sims[i].to_mcap(path)` can repeat their runs.

    Raises:
        SimulationError: The keys drawn for a run do not make a valid scenario.

    >>> sims = flexsc.Simulators(flexsc.Scenario.example("four-clamped-modes"), 100)
    >>> state = sims.step(numpy.zeros((100, 3)), 0.1)
    >>> state["attitude"].shape
    (100, 4)
    """

    __slots__ = ()

    def __init__(
        self,
        scenario: Scenario,
        runs: int | Sequence[int] | npt.NDArray[np.integer[Any]] = 1000,
        jobs: int | None = None,
        seed: int | None = None,
        *,
        keep_commands: bool = False,
    ) -> None:
        if isinstance(scenario, (Simulator, Snapshot)):
            raise TypeError(f"Simulators.of starts copies at the state of a run, got {scenario!r}")
        checked(scenario)
        count = runs if isinstance(runs, int) else len(runs)
        if count > _MOST:
            raise ValueError(f"runs must be at most {_MOST}, got {count}")
        numbers = range(run_number(runs)) if isinstance(runs, int) else [run_number(run) for run in runs]
        count_of_threads = threads(jobs, scenario)
        scenario = scenario if seed is None else scenario.with_("seed", seed)
        if not len(numbers):
            raise ValueError("runs must be one or more, got none")
        self._set(
            engine.Simulators(scenario._native, list(numbers), count_of_threads, keep_commands, True),
            scenario,
        )
        self._raise()

    @classmethod
    def of(
        cls,
        source: Source | Iterable[Source],
        copies: int = 1,
        jobs: int | None = None,
        *,
        keep_commands: bool = False,
    ) -> Simulators:
        """Return copies of a run at its present state, for roll-outs of sampling controllers and searches.

        A copy continues as `Simulator.restore` would, to the bit: with the state of sensors, estimators,
        law and actuator, and with the last command. The source does not change. The copies share the future
        noise of its run: under equal commands they remain equal. A roll-out thus foresees the random
        disturbances and failures of its run; sensor noise does not act on a motion under commands.

        `restore` sets the copies to another state. `reset` starts runs of `scenario`, which is that of the
        source, with the present values of its keys of `[uncertain]`.

        Args:
            source: A `Simulator` or a `Snapshot`, or several of them, all of one scenario.
            copies: The number of copies of each source; copy i is one of source `i // copies`.
            jobs, keep_commands: As in `Simulators`; commands that the source has kept are kept too.

        >>> sim = flexsc.Simulator(flexsc.Scenario.example("four-clamped-modes"))
        >>> sim.step([0.5, 0.0, -0.5], 2.0)
        >>> rollouts = flexsc.Simulators.of(sim, 100)
        >>> torques = numpy.random.default_rng(1).normal(0.0, 0.3, (100, 3))
        >>> state = rollouts.step(torques, 1.0)
        >>> rollouts.time[0].item(), sim.time
        (3.0, 2.0)

        Raises:
            TypeError: A source is neither a `Simulator` nor a `Snapshot`.
            ValueError: There is no source, the sources are of several scenarios, or there are too many
                copies.
            SimulationError: A source cannot continue.
        """
        sources = parse_sources(source)
        if not sources:
            raise ValueError("copies need one source or more, got none")
        if not isinstance(copies, int) or not 1 <= copies * len(sources) <= _MOST:
            most = _MOST // len(sources)
            raise ValueError(f"copies of each of {len(sources)} sources must be 1 to {most}, got {copies!r}")
        origin = sources[0].scenario
        check_scenarios(sources, [origin])
        # Those that are drawn are not drawn again.
        scenario = origin.without("uncertain") if origin.get("uncertain") else origin
        each_copy = [one for one in sources for _ in range(copies)]
        runs = [one.run for one in each_copy]
        simulators = cls.__new__(cls)
        native = engine.Simulators(scenario._native, runs, threads(jobs, scenario), keep_commands, False)
        simulators._set(native, scenario)
        simulators._origin = origin
        simulators.restore(sources if len(sources) == 1 else each_copy)
        return simulators

    @classmethod
    def _of_one(cls, scenario: Scenario, run: int) -> Simulators:
        """One copy that is advanced in the calling thread, and keeps its commands."""
        from flexsc._one_copy import OneCopy

        simulators = cls.__new__(cls)
        simulators._set(OneCopy(scenario, run), scenario)
        simulators._raise()
        return simulators

    def __getitem__(self, index: int) -> Simulator:
        """Return a clone of one copy."""
        index = range(len(self))[place(index)]
        with self._lock:
            run = int(self.runs[index])
            return Simulator._of(self._native.one(index), self._scenario_of(index, run), run)

    def _scenario_of(self, index: int, run: int) -> Scenario:
        """The scenario of a copy, as it is drawn or as it was restored."""
        if index not in self._drawn:
            self._drawn[index] = self.scenario.draw(run)
        return self._drawn[index]

    def step(
        self,
        commands: npt.ArrayLike | None,
        dt: float,
        mask: npt.NDArray[np.bool_] | None = None,
    ) -> Quantities:
        """Advance all copies by a time. Other Python threads continue meanwhile.

        Threads that read the copies wait for the end of the step; if the scenario has parts written in
        Python, they get a `RuntimeError` instead.

        Args:
            commands: A command for each copy, of shape (n, axes), or (n,) for one axis, as in
                `Simulator.step`; None leaves the present source of commands in force.
            dt: The length of the step (s).
            mask: The copies to advance, of shape (n,); if omitted, all.

        Returns:
            The states at the end of the step.

        >>> state = sims.step(numpy.full((100, 3), 0.01), 1.0)              # N m, s
        >>> state["rate"].shape
        (100, 3)

        Raises:
            ValueError: The commands have another shape or are not finite, or `dt` is not a positive time.
            SimulationError: Copies have failed; the text names them. The others have completed the step:
                `reset(sims.failed)` restarts the failed ones.
        """
        with self._lock:
            native, n = self._native, len(self)
            if commands is not None:
                commands = parse_commands(commands, (n, native.axes), native.command_unit)
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

        >>> first = numpy.arange(100) < 10
        >>> state = sims.reset(first)
        >>> sims.time[9:11].tolist()
        [0.0, 0.1]

        Raises:
            ValueError: The mask or the run numbers have another shape.
            SimulationError: The keys drawn for a run do not make a valid scenario.
        """
        numbers = None
        if runs is not None:
            numbers = np.asarray(runs)
            if numbers.shape != (len(self),) or numbers.dtype.kind not in "iu" or (numbers < 0).any():
                raise ValueError(f"runs must be {len(self)} whole numbers from 0, got {runs!r}")
            numbers = numbers.astype(np.uint64)
        mask = _mask(mask, len(self))
        with self._lock:
            self._keep(self._native.reset(mask, numbers))
            for index in np.flatnonzero(mask).tolist() if self._drawn and mask is not None else ():
                self._drawn.pop(index, None)
            if mask is None:
                self._drawn.clear()
            self._raise()
            return self.state

    def snapshot(self) -> list[Snapshot]:
        """Save the state of each copy, for `restore`, `Simulators.of` or `Simulator.restore`.

        >>> sims = flexsc.Simulators(flexsc.Scenario.example("four-clamped-modes"), 3)
        >>> before = sims.snapshot()
        >>> moved = sims.step(numpy.ones((3, 3)), 1.0)
        >>> sims.restore(before)["rate"].tolist() == sims.reset()["rate"].tolist()
        True

        Raises:
            SimulationError: A copy has failed; the text names it.
        """
        with self._lock:
            self._raise()
            each = enumerate(self.runs.tolist())
            return [
                Snapshot(self._native.one(index), self._scenario_of(index, run), run) for index, run in each
            ]

    def restore(
        self, snapshots: Source | Iterable[Source], mask: npt.NDArray[np.bool_] | None = None
    ) -> Quantities:
        """Set copies to saved states, or to the present state of simulators, as `Simulator.restore` does.

        A copy takes the run number and the drawn keys of its snapshot, until it is reset.

        Args:
            snapshots: One `Snapshot` or `Simulator` for all copies, or n of them, one for each copy. They are
                of `scenario`, or of `scenario.draw(run)` with the run of the snapshot. They can be used
                again.
            mask: The copies to set, of shape (n,); if omitted, all.

        Returns:
            The states of all copies.

        >>> sim = flexsc.Simulator(flexsc.Scenario.example("four-clamped-modes"))
        >>> rollouts = flexsc.Simulators.of(sim, 4)
        >>> for _ in range(3):
        ...     tried = rollouts.step(numpy.ones((4, 3)), 1.0)
        ...     sim.step([1.0, 1.0, 1.0], 0.5)
        ...     state = rollouts.restore(sim)
        >>> state["rate"][2].tolist() == sim.state["rate"].tolist()
        True

        Raises:
            TypeError: One is neither a `Snapshot` nor a `Simulator`.
            ValueError: They are of another scenario, or not as many as there are copies; the mask has another
                shape.
            SimulationError: What is restored cannot continue.
        """
        count, mask, sources = len(self), _mask(mask, len(self)), parse_sources(snapshots)
        if len(sources) not in (1, count):
            raise ValueError(f"snapshots must be 1 or {count}, one for each copy, got {len(sources)}")
        accepted = [self.scenario, self._origin]
        chosen = range(count) if mask is None else np.flatnonzero(mask).tolist()
        if len(sources) == 1:
            check_scenarios(sources, accepted)
            drawn = dict.fromkeys(chosen, sources[0].scenario)
            sources = sources * count
        else:
            check_scenarios([sources[index] for index in chosen], accepted, self._drawn.values())
            drawn = {index: sources[index].scenario for index in chosen}
        with self._lock, held(sources):
            native, runs = [one._native for one in sources], [one.run for one in sources]
            self._keep(self._native.restore(native, runs, mask))
            self._drawn.update(drawn)
            self._raise()
            return self.state

    def __reduce__(self) -> NoReturn:
        raise TypeError(unpicklable(self))

    def __copy__(self) -> NoReturn:
        # A shallow copy would share the engine: a step of one would advance the other.
        raise TypeError("Simulators cannot be copied; `sims[i]` is a copy of one run, a Simulator")

    def __deepcopy__(self, memo: dict[int, Any]) -> NoReturn:
        self.__copy__()


def _mask(mask: npt.NDArray[np.bool_] | None, count: int) -> npt.NDArray[np.bool_] | None:
    if mask is None:
        return None
    mask = np.asarray(mask)
    if mask.shape != (count,) or mask.dtype != np.bool_:
        raise ValueError(f"a mask must be {count} of bool, got shape {mask.shape} of {mask.dtype}")
    return np.ascontiguousarray(mask)
