"""The common base of parts written in Python."""

from __future__ import annotations

import copy
from abc import ABC
from collections.abc import Mapping
from types import MappingProxyType
from typing import TypeVar

Self_ = TypeVar("Self_", bound="OwnPart")


class OwnPart(ABC):  # noqa: B024
    """The common base of all parts; each role adds its methods."""

    signals: Mapping[str, str | tuple[str, int] | type[str]] = MappingProxyType({})
    """Attributes that a full log has as columns, each with its unit, with (unit, size) for a sequence, or
    with `str` for words, such as the states of a law.

    >>> class Sliding(Law):
    ...     period = 0.25
    ...     signals = {"s": "rad/s", "gains": ("N m s/rad", 2)}
    ...     s, gains = 0.0, (4.0, 30.0)
    ...     def decide(self, event):
    ...         self.s = event.rate + 0.1 * event.angle
    ...         return Hold(-self.gains[1] * self.s)
    >>> scenario = flexsc.Scenario.example("attitude-hold").with_parts(law=Sliding())
    >>> list(scenario.with_("duration", 1.0).simulate(log="full")["own_law"])
    ['time_s', 'axis', 's', 'gains0', 'gains1']
    """

    def copy(self: Self_) -> Self_:
        """Make a part in the same state that shares nothing with this one, with `copy.deepcopy`.

        >>> class Shared(Law):
        ...     samples = []
        ...     def decide(self, event):
        ...         return Hold(0.0, after=1.0)
        ...     def copy(self):
        ...         return self                                                # all runs have this object
        >>> Shared().copy().samples is Shared.samples
        True
        """
        return copy.deepcopy(self)
