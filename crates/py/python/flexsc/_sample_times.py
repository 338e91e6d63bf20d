"""Times at which the motion of runs is kept, and the rows at them."""

from __future__ import annotations

from functools import cached_property
from typing import Any

from flexsc._numpy import np, npt
from flexsc._values import arrays

_MOST_VALUES = 200_000_000
"""Largest number of values that the samples of a call keep in memory."""
# Times (s) that are nearer are those of one sample.
_SAME_TIME = 1e-9


class SampleTimes:
    """Times (s) in the order in which they were asked, and as a run passes them.

    Raises:
        ValueError: A time is not within the run.
    """

    def __init__(self, times: npt.ArrayLike, end: float, what: str = "duration") -> None:
        self.asked = np.array(times, dtype=np.float64)
        if self.asked.ndim != 1:
            raise ValueError(f"times must be of shape (times,), got {self.asked.shape}")
        within = (self.asked >= 0.0) & (self.asked <= end)
        if not within.all():
            wrong = self.asked[~within][0].item()
            raise ValueError(f"times must be from 0 to the {what}, {end:g} s, got {wrong:g}")

    @cached_property
    def _order(self) -> npt.NDArray[np.intp]:
        return np.argsort(self.asked, kind="stable")

    @cached_property
    def grown(self) -> list[float]:
        """The times as a run passes them, once their number is known to be small enough."""
        times: list[float] = self.asked[self._order].tolist()
        return times

    def check_size(self, sizes: dict[str, int], runs: int = 1) -> None:
        """Check that the samples of runs fit in memory, from the number of values in each by topic.

        Raises:
            ValueError: There are more than 200 000 000 values.
        """
        each, times = sum(sizes.values()), len(self.asked)
        count = runs * times * each
        if count > _MOST_VALUES:
            raise ValueError(
                f"at must keep at most {_MOST_VALUES} values in memory, got {count} (runs: {runs}, "
                f"times: {times}, values of a run at a time: {each}): give fewer times, runs or topics"
            )

    def rows(self, topics: dict[str, dict[str, Any]]) -> dict[str, dict[str, npt.NDArray[Any]]]:
        """Return the columns of topics with a row for each time, in the order in which they were asked.

        A part that acts in one mode of operation has no values at other times.
        """
        seen = {name: self._spread(arrays(columns)) for name, columns in topics.items()}
        for columns in seen.values():
            # The times of most calls grow.
            if (self._order[1:] < self._order[:-1]).any():
                back = np.argsort(self._order, kind="stable")
                columns.update({name: values[back] for name, values in columns.items()})
            columns["time_s"] = self.asked.copy()
        return seen

    def _spread(self, columns: dict[str, npt.NDArray[Any]]) -> dict[str, npt.NDArray[Any]]:
        """Return columns of the times at which they have rows as columns of all times."""
        there, grown = columns["time_s"], np.array(self.grown)
        if len(there) == len(grown):
            return columns
        near = np.searchsorted(there, grown - _SAME_TIME)
        has_row = near < len(there)
        has_row[has_row] = np.abs(there[near[has_row]] - grown[has_row]) < _SAME_TIME
        spread = {}
        for name, values in columns.items():
            spread[name] = missing((len(grown), *values.shape[1:]), values.dtype)
            spread[name][has_row] = values
        return spread


def missing(shape: tuple[int, ...], dtype: np.dtype[Any]) -> npt.NDArray[Any]:
    """Return an array that stands for no values: NaN for numbers and counts, empty texts."""
    return np.full(shape, np.nan) if dtype.kind in "fiu" else np.zeros(shape, dtype)
