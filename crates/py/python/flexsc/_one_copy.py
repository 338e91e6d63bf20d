"""One run with the interface of many: an environment of its own needs no threads."""

from __future__ import annotations

from typing import TYPE_CHECKING

from flexsc import _native as engine
from flexsc._numpy import np, npt

if TYPE_CHECKING:
    from flexsc._scenario import Scenario


class OneCopy:
    """A single copy, as `engine.Simulators` has many: advanced by a simulator in the calling thread."""

    def __init__(self, scenario: Scenario, run: int) -> None:
        self._scenario = scenario
        self._run = run
        self.simulator = engine.Simulator(scenario._native, run)
        # Those of the nominal scenario, whatever is drawn.
        self.axes = self.simulator.axes
        self.command_unit = self.simulator.command_unit
        self.command_limit = self.simulator.command_limit
        self.fields = self.simulator.fields
        self.row = self.simulator.look()
        self.failed: list[tuple[int, int, str]] = []
        self._start(run)

    def __len__(self) -> int:
        return 1

    @property
    def runs(self) -> npt.NDArray[np.uint64]:
        return np.array([self._run], dtype=np.uint64)

    @property
    def time(self) -> npt.NDArray[np.float64]:
        return np.array([self.simulator.time])

    @property
    def done(self) -> npt.NDArray[np.bool_]:
        return np.array([self.simulator.done])

    def _start(self, run: int) -> None:
        self._run, self.failed = run, []
        try:
            self.simulator = engine.Simulator(self._scenario.draw(run)._native, run)
            self.row = self.simulator.look()
        except (engine.ScenarioError, engine.SimulationError) as error:
            self._fail(error)

    def _fail(self, error: Exception | str) -> None:
        self.failed = [(0, self._run, str(error))]
        self.row = np.full_like(self.row, np.nan)

    def reset(
        self, mask: npt.NDArray[np.bool_] | None, runs: npt.NDArray[np.uint64] | None
    ) -> npt.NDArray[np.float64]:
        """Restart the run, or another one; return its row."""
        if mask is None or mask[0]:
            self._start(self._run if runs is None else int(runs[0]))
        return self.look()

    def restore(
        self, simulators: list[engine.Simulator], runs: list[int], mask: npt.NDArray[np.bool_] | None
    ) -> npt.NDArray[np.float64]:
        """Set the run to the state of a simulator; return its row."""
        if mask is None or mask[0]:
            self._run, self.failed, self.simulator = runs[0], [], simulators[0].copy()
            if self.simulator.failed is None:
                self.row = self.simulator.look()
            else:
                self._fail(self.simulator.failed)
        return self.look()

    def step(
        self, values: npt.NDArray[np.float64] | None, dt: float, mask: npt.NDArray[np.bool_] | None
    ) -> npt.NDArray[np.float64]:
        """Advance the run by a time (s) under a command; return its row."""
        if (mask is None or mask[0]) and not self.failed:
            if values is not None:
                self.simulator.steer(values[0])
            self.advance(dt)
        return self.look()

    def advance(self, dt: float) -> None:
        """Advance the run by a time (s)."""
        try:
            self.simulator.step(dt)
        except engine.SimulationError as error:
            self._fail(error)
        else:
            self.row = self.simulator.look()

    def look(self) -> npt.NDArray[np.float64]:
        """Return the row of the present time, of shape (1, numbers)."""
        return self.row.reshape(1, -1)

    def one(self, index: int) -> engine.Simulator:
        """Return a copy of the simulator."""
        return self.simulator.copy()
