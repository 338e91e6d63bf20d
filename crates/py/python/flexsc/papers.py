"""Analyses of single papers, which the pages on active damping and on sampled loops explain.

>>> import flexsc
>>> values = flexsc.papers.rigid_cycles(flexsc.Scenario.example("relay-fixed"))
>>> round(values["cycles"][0]["period_s"], 2)
44.14
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from flexsc._analysis import analysis
from flexsc._damping import identify, observer_margin, observer_region, persistence, relay_damping
from flexsc._sampled_loop import gain_region, robust_gains, stability_map
from flexsc._values import checked

if TYPE_CHECKING:
    from flexsc._scenario import Scenario

__all__ = [
    "gain_region",
    "identify",
    "observer_margin",
    "observer_region",
    "persistence",
    "relay_damping",
    "rigid_cycles",
    "robust_gains",
    "stability_map",
]


def rigid_cycles(scenario: Scenario) -> dict[str, list[dict[str, Any]]]:
    """Return the limit cycles of the scenario's relay law on its body without modes, in closed form.

    Returns:
        `cycles`, the cycles that exist at the law's gain, and `resonances`, the gains at which an odd
        harmonic of the two-sided cycle coincides with a mode. Units are in the names.

    >>> import flexsc
    >>> values = flexsc.papers.rigid_cycles(flexsc.Scenario.example("relay-fixed"))
    >>> round(values["cycles"][0]["period_s"], 2)
    44.14
    """
    values: dict[str, list[dict[str, Any]]] = analysis("rigid_cycles", checked(scenario))
    return values
