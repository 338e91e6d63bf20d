"""Tuning of keys of a law for the largest least modulus margin over the plants of a scenario."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from flexsc import _native as engine

if TYPE_CHECKING:
    from flexsc._open_loop import Break
    from flexsc._scenario import Scenario


@dataclass(frozen=True)
class TunedPlant:
    """Margins of a plant before and after tuning.

    >>> tuned = flexsc.Scenario.example("earth-observer").tune({"law.attitude.damping": (0.4, 1.5)})
    >>> plant = tuned.plants[0]
    >>> plant.values
    {}
    """

    values: dict[str, float]
    """Values of the uncertain keys; none for the nominal plant, which is the first.

    >>> list(plant.values)
    []
    """
    margin_before: float
    """Modulus margin of all signals together with the keys of the scenario.

    >>> round(plant.margin_before, 4)
    0.5744
    """
    margin: float
    """Modulus margin with the tuned keys.

    >>> round(plant.margin, 4)
    0.7425
    """
    frequency_before: float
    """Frequency (rad/s) at which the margin was attained with the keys of the scenario.

    >>> round(plant.frequency_before, 3)
    7.682
    """
    frequency: float
    """Frequency (rad/s) at which the margin is attained with the tuned keys.

    >>> round(plant.frequency, 3)
    7.665
    """
    spectral_radius: float
    """Largest magnitude of a pole of the closed loop with the tuned keys.

    >>> round(plant.spectral_radius, 4)
    0.9983
    """


@dataclass(frozen=True)
class TunedScenario:
    """Tuned scenario, with the margins of its plants before and after.

    >>> tuned = flexsc.Scenario.example("earth-observer").tune({"law.attitude.damping": (0.4, 1.5)})
    >>> list(tuned.keys), tuned.scenario.tune({"law.attitude.damping": (0.4, 1.5)}).keys == tuned.keys
    (['law.attitude.damping'], True)
    """

    scenario: Scenario
    """The scenario with the tuned keys.

    >>> tuned.scenario.name
    'earth-observer'
    """
    keys: dict[str, float]
    """Value of each tuned key.

    >>> list(tuned.keys)
    ['law.attitude.damping']
    """
    keys_before: dict[str, float]
    """Value of each tuned key in the scenario that was tuned.

    >>> list(tuned.keys_before)
    ['law.attitude.damping']
    """
    least_margin_before: float
    """Least modulus margin of all plants with the keys of the scenario.

    >>> round(tuned.least_margin_before, 4)
    0.5744
    """
    least_margin: float
    """Least modulus margin of all plants with the tuned keys.

    >>> round(tuned.least_margin, 4)
    0.7425
    """
    plants: tuple[TunedPlant, ...]
    """The plants: the nominal one, then the corners of the uncertain keys.

    >>> len(tuned.plants)
    1
    """
    steps: int
    """Number of steps of the search.

    >>> tuned.steps > 8
    True
    """


TunedScenario.__module__ = TunedPlant.__module__ = "flexsc"


def tune(
    scenario: Scenario,
    ranges: Mapping[str, tuple[float, float]],
    loop: Break,
    bandwidth: float | None,
    corners: bool,
) -> TunedScenario:
    """Return the scenario with the keys that maximise the least modulus margin."""
    keys = [(key, (float(low), float(high))) for key, (low, high) in ranges.items()]
    table, text = engine.tuned_json(scenario._native, keys, loop, bandwidth, not corners)
    found = json.loads(table)
    return TunedScenario(
        scenario=type(scenario).parse(text, scenario.name),
        keys={each["key"]: each["after"] for each in found["keys"]},
        keys_before={each["key"]: each["before"] for each in found["keys"]},
        least_margin_before=found["least_margin_before"],
        least_margin=found["least_margin"],
        plants=tuple(_plant(each) for each in found["plants"]),
        steps=found["steps"],
    )


def _plant(found: dict[str, Any]) -> TunedPlant:
    before, after = found["before"], found["after"]
    return TunedPlant(
        values=found["values"],
        margin_before=before["margin"],
        margin=after["margin"],
        frequency_before=before["frequency_rad_s"],
        frequency=after["frequency_rad_s"],
        spectral_radius=after["spectral_radius"],
    )
