"""Margins of opened loops."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from flexsc import _native as engine
from flexsc._read import Data

if TYPE_CHECKING:
    from flexsc._linear import Linear


@dataclass(frozen=True, eq=False, repr=False)
class CommonMargins(Data):
    """Margins of the commands of a loop together: how far they may be off before the closed loop is unstable.

    They end where a pole of the closed loop is at the limit of stability.

    >>> flexsc.Scenario.example("rotation-robust").linearise(loop="command").common_margins().gain_below
    0.0
    """

    gain_below: float
    """Smallest factor below 1 down to which the loop is stable; 0 if it is at all.

    >>> margins = flexsc.Scenario.example("rotation-robust").linearise(loop="command").common_margins()
    >>> margins.gain_below
    0.0
    """
    gain_above: float
    """Largest factor above 1 up to which it is stable; infinite if it is at all.

    >>> margins = flexsc.Scenario.example("rotation-robust").linearise(loop="command").common_margins()
    >>> margins.gain_above > 2.0                                        # more than 6 dB
    True
    """
    phase: float
    """Largest phase (rad) up to which it is stable, of either sign; pi if it is at all.

    >>> margins = flexsc.Scenario.example("rotation-robust").linearise(loop="command").common_margins()
    >>> margins.phase > 0.5                                             # rad
    True
    """


def common_margins(opened: Linear, inputs: Sequence[str] | None) -> CommonMargins:
    """Return the margins of an opened loop."""
    if not opened.inputs or opened.b.shape[1] != opened.c.shape[0]:
        raise ValueError("only an opened loop, with as many outputs as inputs, has margins")
    names = [signal.name for signal in opened.inputs]
    # Without the numbers of their samples in a period.
    commands = [name.rstrip("0123456789").removesuffix("_") for name in names]
    chosen = names if inputs is None else inputs
    for name in chosen:
        if name not in names and name not in commands:
            raise KeyError(f"no command {name!r}; there are {', '.join(dict.fromkeys(commands))}")
    off = [k for k, name in enumerate(names) if name in chosen or commands[k] in chosen]
    matrices = (opened.a, opened.b, opened.c, opened.d)
    return CommonMargins(*engine.common_margins(matrices, opened.period, list(dict.fromkeys(commands)), off))
