"""Tuning of keys of a law for a margin, a settling time or a pointing index over the plants of a scenario."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from flexsc._analysis import analysis
from flexsc._equality import Compared
from flexsc._read import read

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from flexsc._linear import Break
    from flexsc._scenario import Scenario


@dataclass(frozen=True, eq=False)
class TunedPlant(Compared):
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
    0.5773
    """
    margin: float
    """Modulus margin with the tuned keys.

    >>> round(plant.margin, 4)
    0.7437
    """
    frequency_before: float
    """Frequency (rad/s) at which the margin was attained with the keys of the scenario.

    >>> round(plant.frequency_before, 3)
    7.682
    """
    frequency: float
    """Frequency (rad/s) at which the margin is attained with the tuned keys.

    The largest margin is often attained at several frequencies; this is one of them.

    >>> round(plant.frequency, 3) in (0.124, 7.665)
    True
    """
    spectral_radius: float
    """Largest magnitude of a pole of the closed loop with the tuned keys.

    >>> round(plant.spectral_radius, 4)
    0.9983
    """


@dataclass(frozen=True, eq=False)
class TunedMeasure(Compared):
    """Quantity besides the margins that a tuning minimised or limited, with its largest value of all plants.

    >>> scenario = flexsc.Scenario.example("attitude-hold")
    >>> ranges = {"law.per_axis.roll.pd.k_d": (100.0, 900.0)}
    >>> measure = scenario.tune(ranges, objective="settling", keep=["margin>=0.5"]).measures["settling"]
    >>> measure.value < measure.before
    True
    """

    before: float
    """Largest value with the keys of the scenario; infinite if it has no bound.

    >>> measure.before > 10.0
    True
    """
    value: float
    """Largest value with the tuned keys; infinite if it has no bound.

    >>> measure.value > 1.0
    True
    """
    unit: str
    """Unit of the values and of the limit.

    >>> measure.unit
    's'
    """
    limit: float | None
    """Limit that was to be kept, if there was one.

    >>> measure.limit is None
    True
    """
    worst_plant: int
    """Index of the plant with the largest value.

    >>> measure.worst_plant
    0
    """


@dataclass(frozen=True, eq=False)
class TunedScenario(Compared):
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
    0.5773
    """
    least_margin: float
    """Least modulus margin of all plants with the tuned keys.

    >>> round(tuned.least_margin, 4)
    0.7437
    """
    measures: dict[str, TunedMeasure]
    """Quantities besides the margins that were minimised or limited, by their names.

    >>> tuned.measures
    {}
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

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the modulus margin of each plant before and after tuning.

        Args:
            ax: The axes; if omitted, those of a new figure.

        Returns:
            The axes: the plants, sorted by their margin before, against the margin.

        Raises:
            ImportError: Matplotlib is not installed.

        >>> import matplotlib; matplotlib.use("agg")
        >>> tuned.plot().get_ylabel()
        'modulus margin'
        """
        from flexsc._review_figures import tuned_margins

        return tuned_margins(self, ax)


TunedScenario.__module__ = TunedMeasure.__module__ = TunedPlant.__module__ = "flexsc"


def tune(
    scenario: Scenario,
    ranges: Mapping[str, tuple[float, float]],
    loop: Break,
    goal: tuple[str, Sequence[str]],
    bandwidth: float | None,
    corners: bool,
) -> TunedScenario:
    """Return the scenario with the keys that are best for the goal: an objective, and limits."""
    keys = [(key, (float(low), float(high))) for key, (low, high) in ranges.items()]
    objective, keep = goal
    if isinstance(keep, str):
        raise TypeError(f"keep: must be a sequence of texts, such as [{keep!r}], got a text")
    options = {"keys": keys, "opened": loop, "objective": objective, "keep": list(keep)}
    found = analysis("tune", scenario, **options, bandwidth=bandwidth, is_nominal=not corners)
    return read(
        TunedScenario,
        found,
        keys={each["key"]: each["after"] for each in found["keys"]},
        keys_before={each["key"]: each["before"] for each in found["keys"]},
        measures={each["name"]: _measure(each) for each in found["measures"]},
        plants=tuple(_plant(each) for each in found["plants"]),
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


def _measure(found: dict[str, Any]) -> TunedMeasure:
    before, value = (float("inf") if found[key] is None else found[key] for key in ("before", "after"))
    return TunedMeasure(before, value, found["unit"], found["limit"], found["worst_plant"])
