"""Pointing budgets: levels of the indices that the requirements of a scenario limit."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from flexsc._analysis import analysis
from flexsc._equality import Compared
from flexsc._read import read

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from flexsc._scenario import Scenario


@dataclass(frozen=True, eq=False)
class BudgetLevel(Compared):
    """Level of an index at a probability, computed in three ways.

    >>> budget = flexsc.Scenario.example("slew-wheel-lqg").budget(runs=2)
    >>> level = budget.indices[0].levels[0.955]["mixed"]
    >>> level.campaign > 0.0
    True
    """

    campaign: float
    """Order statistic of the runs.

    >>> round(level.campaign, 7)
    0.0002928
    """
    convolution: float | None
    """Level of the sum of the error sources by convolution; None for an index without sources.

    >>> round(level.convolution, 7)
    0.0002569
    """
    rule: float | None
    """Level by the rule of k sigma; None for an index without sources.

    >>> round(level.rule, 7)
    0.0002886
    """


@dataclass(frozen=True, eq=False)
class IndexBudget(Compared):
    """Budget of one pointing index.

    >>> budget = flexsc.Scenario.example("slew-wheel-lqg").budget(runs=2)
    >>> index = budget.indices[0]
    >>> sorted(index.levels)
    [0.683, 0.955, 0.997]
    """

    name: str
    """Name of the requirement.

    >>> index.name
    'arrival'
    """
    description: str
    """Index, quantity and window of the requirement.

    >>> index.description
    'APE of the pointing error, from 60 to 120 s, 90 % ensemble'
    """
    unit: str
    """Unit of the levels and of the limit.

    >>> index.unit
    'rad'
    """
    limit: float
    """Limit of the requirement.

    >>> round(index.limit, 7)
    0.0004848
    """
    levels: dict[float, dict[str, BudgetLevel]]
    """Levels by their probability and their interpretation: `temporal`, `ensemble` or `mixed`.

    >>> list(index.levels)
    [0.683, 0.955, 0.997]
    """
    linear_noise: float | None
    """Rms of the index under the noise of the linear loop about its target at rest; None without such a loop.

    >>> index.linear_noise is None or index.linear_noise > 0.0
    True
    """
    sources: dict[str, Any] | None
    """Error sources that the runs show: `bias`, its mean over the runs; `bias_spread`, its standard deviation
    from run to run; `largest_bias`; `amplitudes` of sines; `noise`, the rms of the random part. None for an
    index without sources.

    >>> list(index.sources)
    ['bias', 'bias_spread', 'largest_bias', 'amplitudes', 'noise']
    """

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the levels of the index by campaign, convolution and rule, with the limit.

        Args:
            ax: The axes; if omitted, those of a new figure.

        Returns:
            The axes: probability against the level, in the unit of the index.

        Raises:
            ImportError: Matplotlib is not installed.

        >>> import matplotlib; matplotlib.use("agg")
        >>> index.plot().get_xlabel()
        'probability'
        """
        from flexsc._review_figures import index_budget

        return index_budget(self, ax)


@dataclass(frozen=True, eq=False)
class PointingBudget(Compared):
    """Budgets of all pointing indices that a scenario limits, and the verdicts of its requirements.

    >>> budget = flexsc.Scenario.example("slew-wheel-lqg").budget(runs=2)
    >>> budget.runs, len(budget.indices) <= len(budget.requirements)
    (2, True)
    """

    runs: int
    """Number of runs of the campaign.

    >>> budget.runs
    2
    """
    indices: tuple[IndexBudget, ...]
    """Budget of each pointing index, in the order of the requirements.

    >>> len(budget.indices)
    2
    """
    requirements: tuple[dict[str, Any], ...]
    """Verdict of each requirement, as `flexsc budget --json` prints it: `name`, `verdict`, `value`, `limit`
    and the confidence of the campaign.

    >>> len(budget.requirements)
    2
    """


PointingBudget.__module__ = IndexBudget.__module__ = BudgetLevel.__module__ = "flexsc"


def pointing_budget(scenario: Scenario, runs: int, jobs: int) -> PointingBudget:
    """Return the pointing budget of a scenario's requirements."""
    if runs < 1:
        raise ValueError(f"runs must be 1 or more, got {runs}")
    found = analysis("budget", scenario, runs=runs, jobs=jobs)
    return read(PointingBudget, found, indices=tuple(_index(each) for each in found["budgets"]))


def _index(found: dict[str, Any]) -> IndexBudget:
    words = ("temporal", "ensemble", "mixed")
    levels = {row["level"]: {word: BudgetLevel(**row[word]) for word in words} for row in found["levels"]}
    return read(IndexBudget, found, levels=levels)
