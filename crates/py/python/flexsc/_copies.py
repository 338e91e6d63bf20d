"""Copies of runs at their present time: what is read of them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from flexsc import _native as engine
from flexsc._numpy import np, npt
from flexsc._quantities import Fields, Quantities
from flexsc._run_lock import RunLock
from flexsc._scenario import Scenario

if TYPE_CHECKING:
    from flexsc._one_copy import OneCopy


class Copies:
    """The present state of copies of runs."""

    __slots__ = ("_drawn", "_fields", "_lock", "_native", "_origin", "_rows", "scenario")
    _native: engine.Simulators | OneCopy
    # Scenarios of copies: as drawn, or of the states that they were set to.
    _drawn: dict[int, Scenario]
    # The scenario of the sources that copies began from.
    _origin: Scenario

    scenario: Scenario
    """The scenario from which the runs are drawn.

    >>> sims.scenario.name
    'four-clamped-modes'
    """

    def _set(self, native: engine.Simulators | OneCopy, scenario: Scenario) -> None:
        self.scenario = self._origin = scenario
        self._lock = RunLock(waits=not scenario.own_parts)
        self._native = native
        self._fields = Fields(native.fields)
        self._rows: npt.NDArray[np.float64] | None = None
        self._drawn = {}

    def __len__(self) -> int:
        """The number of copies."""
        with self._lock:
            return len(self._native)

    @property
    def runs(self) -> npt.NDArray[np.uint64]:
        """The run number of each copy, of shape (n,).

        >>> sims.runs[:3].tolist()
        [0, 1, 2]
        """
        with self._lock:
            return self._native.runs

    @property
    def time(self) -> npt.NDArray[np.float64]:
        """The time of each copy (s), of shape (n,).

        >>> sims.time[:2].tolist()
        [0.1, 0.1]
        """
        with self._lock:
            return self._native.time

    @property
    def done(self) -> npt.NDArray[np.bool_]:
        """Whether each copy has reached its end, of shape (n,). It stays there until it is reset.

        >>> sims.done.any().item()
        False
        """
        with self._lock:
            return self._native.done

    @property
    def failed(self) -> npt.NDArray[np.bool_]:
        """Which copies have failed, of shape (n,). Their values are NaN until they are reset.

        >>> sims.failed.any().item()
        False
        """
        failed = np.zeros(len(self), dtype=np.bool_)
        with self._lock:
            failed[[index for index, _, _ in self._native.failed]] = True
        return failed

    @property
    def axes(self) -> int:
        """The number of values in a command: 1, or 3 about x, y and z.

        >>> sims.axes
        3
        """
        with self._lock:
            return self._native.axes

    @property
    def command_unit(self) -> str:
        """The unit of commands: see `Simulator.command_unit`.

        >>> sims.command_unit
        'N m'
        """
        with self._lock:
            return self._native.command_unit

    @property
    def command_limit(self) -> npt.NDArray[np.float64]:
        """The largest command about each axis for the nominal scenario: see `Simulator.command_limit`.

        >>> sims.command_limit.shape
        (3,)
        """
        with self._lock:
            return np.array(self._native.command_limit, dtype=np.float64)

    @property
    def state(self) -> Quantities:
        """The true states at the present time: those of `Simulator.state`, of shape (n,) or (n, k).

        >>> sims.state["rate"].shape, sims.state.units["rate"]
        ((100, 3), 'rad/s')
        """
        return self._fields.view("state", self._observe_row())

    @property
    def measured(self) -> Quantities:
        """The latest measurements of the sensors: see `Simulator.measured`.

        >>> sims.measured["error"].shape
        (100, 3)
        """
        return self._fields.view("measured", self._observe_row())

    @property
    def believed(self) -> Quantities:
        """The input of the laws: see `Simulator.believed`.

        >>> sims.believed["rate"].shape
        (100, 3)
        """
        return self._fields.view("believed", self._observe_row())

    def _observe_row(self) -> npt.NDArray[np.float64]:
        with self._lock:
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

    def __repr__(self) -> str:
        return f"<flexsc.Simulators of {self.scenario.name}: {len(self)} copies>"
