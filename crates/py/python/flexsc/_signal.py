"""Signals of linear models."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Signal:
    """A state, input or output of a linear model: its name and its unit.

    >>> flexsc.Signal("angle", "rad").unit
    'rad'
    """

    name: str
    """Its name, such as `roll_rate`.

    >>> flexsc.Signal("angle", "rad").name
    'angle'
    """
    unit: str
    """Its unit, such as `rad/s`.

    >>> flexsc.Signal("rate", "rad/s").unit
    'rad/s'
    """


def positions(names: Sequence[str] | None, signals: tuple[Signal, ...]) -> list[int]:
    """Return where signals of these names are; of all signals without names.

    Raises:
        KeyError: There is no signal of a name.
    """
    known = [signal.name for signal in signals]
    if names is None:
        return list(range(len(known)))
    for name in names:
        if name not in known:
            raise KeyError(f"no signal {name!r}; there are {', '.join(known)}")
    return [known.index(name) for name in names]
