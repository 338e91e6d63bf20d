"""Worst case of a metric, a requirement or a stability margin over the uncertain keys."""

from __future__ import annotations

from dataclasses import dataclass
from math import nan
from typing import TYPE_CHECKING, Literal

from flexsc._analysis import analysis
from flexsc._equality import Compared
from flexsc._numpy import np, npt
from flexsc._read import read

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes

    from flexsc._linear import Break
    from flexsc._scenario import Scenario

Margin = Literal["modulus", "disk", "gain", "phase", "delay"]
"""Name of a stability margin."""


@dataclass(frozen=True, eq=False)
class WorstCase(Compared):
    """Worst point of the ranges of the uncertain keys that a search found.

    >>> scenario = flexsc.Scenario.example("slew-wheel-lqg")
    >>> worst = scenario.worst(requirement="stability", points=20)
    >>> worst
    WorstCase(quantity='stability', value=2.435e-05, nominal=2.154e-05)
    """

    quantity: str
    """Name of the metric, the requirement or the margin.

    >>> worst.quantity
    'stability'
    """
    unit: str
    """Unit of the values.

    >>> worst.unit
    'rad'
    """
    least: bool
    """Whether small values are bad.

    >>> worst.least
    False
    """
    value: float
    """Value at the worst point.

    >>> worst.value > worst.nominal
    True
    """
    nominal: float
    """Value with the keys of the scenario itself, or as near to them as their ranges are.

    >>> bool(worst.nominal == worst.values[0])
    True
    """
    keys: dict[str, float]
    """Value of each uncertain key at the worst point.

    >>> list(worst.keys)
    ['body.planar.modes[0].frequency', 'body.planar.modes[1].frequency']
    """
    ranges: dict[str, tuple[float, float]]
    """Range of each uncertain key.

    >>> all(low <= worst.keys[key] <= high for key, (low, high) in worst.ranges.items())
    True
    """
    points: npt.NDArray[np.float64]
    """The points that were assessed, one in each row, with the keys as columns.

    >>> worst.points.shape[1]
    2
    """
    values: npt.NDArray[np.float64]
    """Value at each point; NaN at a point without one.

    >>> bool(worst.values.max() == worst.value)
    True
    """
    without_value: int
    """Number of points without a value.

    >>> worst.without_value
    0
    """
    unstable: bool
    """Whether the quantity is a margin and the loop is not stable at the worst point.

    >>> worst.unstable
    False
    """
    scenario: Scenario
    """The scenario with the keys of the worst point, and without uncertain ones.

    >>> bool(worst.scenario.simulate().metrics["requirement_values"][1] == worst.value)
    True
    """

    def __repr__(self) -> str:
        """Return the quantity with its values."""
        return f"WorstCase(quantity={self.quantity!r}, value={self.value:.4g}, nominal={self.nominal:.4g})"

    def plot(self, axes: Sequence[Axes] | None = None) -> list[Axes]:
        """Draw the value at each point over each uncertain key, with the worst point in red.

        Args:
            axes: The axes, one for each key; if omitted, those of a new figure.

        Returns:
            The axes: the key against the quantity, in its unit.

        Raises:
            ValueError: The number of axes is not that of the keys.
            ImportError: Matplotlib is not installed.

        >>> import matplotlib; matplotlib.use("agg")
        >>> [ax.get_xlabel()[-13:] for ax in worst.plot()]
        ['[0].frequency', '[1].frequency']
        """
        from flexsc._review_figures import worst_points

        return worst_points(self, axes)


WorstCase.__module__ = "flexsc"


def worst_case(
    scenario: Scenario,
    metric: str | None,
    requirement: str | None,
    margin: Margin | None,
    loop: Break,
    least: bool,
    points: int,
    jobs: int,
) -> WorstCase:
    """Return the worst case of one quantity."""
    given = {"metric": metric, "requirement": requirement, "margin": margin}
    chosen = [(kind, name) for kind, name in given.items() if name is not None]
    if len(chosen) != 1:
        raise ValueError(f"give one of metric, requirement and margin, got {len(chosen)}")
    if least and metric is None:
        raise ValueError("least is for a metric: it is known of a requirement and of a margin")
    kind, name = chosen[0]
    options = {"kind": kind, "name": name, "opened": loop, "is_least": least}
    found = analysis("worst", scenario, **options, points=points, jobs=jobs)
    return read(
        WorstCase,
        found,
        value=nan if found["worst"] is None else found["worst"],
        ranges=dict(zip(found["keys"], map(tuple, found["ranges"]), strict=True)),
        points=np.array(found["rows"]),
    )
