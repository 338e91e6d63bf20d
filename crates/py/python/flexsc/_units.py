"""Units: the names of columns and metrics end with their units."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from flexsc import _native as engine

if TYPE_CHECKING:
    from flexsc._scenario import Scenario

# The longest endings first: `_rad_s` ends with `_s`, too.
_ENDINGS = {
    "_kg_m2": "kg m²",
    "_rad_s2": "rad/s²",
    "_rad_s": "rad/s",
    "_m_s2": "m/s²",
    "_nm_s": "N m s",
    "_m_s": "m/s",
    "_1_s": "1/s",
    "_am2": "A m²",
    "_rad": "rad",
    "_nm": "N m",
    "_kg": "kg",
    "_fs": "fs",
    "_s": "s",
    "_m": "m",
    "_j": "J",
    "_t": "T",
    "_n": "N",
}
# On a body without a moment of inertia a torque is an acceleration.
_REDUCED = {"N m": "rad/s²", "N m s": "rad/s"}


def meanings(scenario: Scenario | None) -> dict[str, dict[str, str]]:
    """Return `unit` and `doc` of the metrics by name, for runs of a scenario if it is given."""
    text = engine.metrics_json() if scenario is None else engine.meanings_json(scenario._native)
    values: dict[str, dict[str, str]] = json.loads(text)
    return values


def is_reduced(scenario: Scenario | None) -> bool:
    """Whether the torques of a scenario are accelerations."""
    return meanings(scenario)["peak_torque_nm"]["unit"] != "N m"


def of_column(name: str, reduced: bool = False) -> str:
    """The unit of a column such as `modes.displacement_rad`; empty for a count, a ratio or a word."""
    for part in reversed(name.split(".")):
        for ending, unit in _ENDINGS.items():
            if part.endswith(ending) and part != ending[1:]:
                return _REDUCED.get(unit, unit) if reduced else unit
    return ""


class Metrics(dict[str, Any]):
    """The metrics of a run by name: a dictionary with their units.

    Lists are arrays, words are str, and None means no value.

    >>> import flexsc
    >>> run = flexsc.Scenario.example("relay-fixed").with_("duration", 600.0).simulate()
    >>> run.metrics["switchings"], run.metrics.unit("cycle_period_s")
    (81, 's')
    """

    def __init__(self, values: dict[str, Any], scenario: Scenario) -> None:
        super().__init__(values)
        self._scenario = scenario
        self._meanings: dict[str, dict[str, str]] | None = None

    def __eq__(self, other: object) -> bool:
        import numpy as np

        if not isinstance(other, Mapping):
            return NotImplemented
        return self.keys() == other.keys() and all(np.array_equal(self[name], other[name]) for name in self)

    def _meaning(self, name: str) -> dict[str, str]:
        if name not in self:
            raise KeyError(f"no metric {name!r}; there are {', '.join(self)}")
        if self._meanings is None:
            self._meanings = meanings(self._scenario)
        return self._meanings[name]

    def unit(self, name: str) -> str:
        """Return the unit of a metric; empty for a count, a ratio or a word.

        Raises:
            KeyError: The run has no such metric.
        """
        return self._meaning(name)["unit"]

    def doc(self, name: str) -> str:
        """Return the meaning of a metric.

        Raises:
            KeyError: The run has no such metric.
        """
        return self._meaning(name)["doc"]

    def __repr__(self) -> str:
        def line(name: str, value: Any) -> str:
            unit = self.unit(name)
            return f"  {name}: {value}" + (f" {unit}" if unit and value is not None else "")

        lines = "\n".join(line(name, value) for name, value in self.items())
        return f"<flexsc.Metrics of {self._scenario.name}:\n{lines}>"
