"""A row of a table, as the scenario and the run that it came from."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from flexsc._scenario import Scenario

if TYPE_CHECKING:
    from flexsc._result import Detail, Result


class Row(NamedTuple):
    """The scenario and the run number of a row of a table: `scenario.simulate(run)` repeats the row.

    >>> import flexsc
    >>> scenario = flexsc.Scenario.example("relay-sampled").with_("duration", 100.0)
    >>> table = flexsc.campaign(scenario, runs=4)
    >>> scenario, run = table.row(2)
    >>> run, table.row(2).simulate().metrics["duty"] == table["duty"][2].item()
    (2, True)
    """

    scenario: Scenario
    """The scenario, with the values of the row in place of the keys that vary.

    >>> table.row(2).scenario.get("body.planar.angle") == table["body.planar.angle"][2].item()
    True
    """
    run: int
    """The number of the run, which selects its noise.

    >>> table.row(2).run
    2
    """

    def simulate(self, log: Detail = "events", yes: bool = False) -> Result:
        """Simulate the run again, to the bit: see `Scenario.simulate`.

        >>> import flexsc
        >>> table = flexsc.sweep(flexsc.Scenario.example("relay-fixed"), "duration", [50.0, 60.0])
        >>> table.row(1).simulate("full")["attitude"]["time_s"][-1].item()
        60.0

        Raises:
            SimulationError: The run failed in the table, too.
        """
        return self.scenario.simulate(self.run, log, yes)
