"""Margins of opened loops, by the poles of loops that are off."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import pi
from typing import TYPE_CHECKING

from flexsc import _native as engine
from flexsc._equality import Compared

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from flexsc._linear import Linear

_LARGEST = 1e4


@dataclass(frozen=True, eq=False)
class Margins(Compared):
    """Margins of a loop: how far the commands may be off before the closed loop is unstable.

    They end where a motion decays by less than 1e-8 of itself in a second, and so are smaller than the true
    ones. Where one does not decay at the nominal gain, as an undamped mode, they may be as much larger.

    >>> flexsc.Scenario.example("rotation-robust").linearise(loop="command").margins().gain_below
    0.0
    """

    gain_below: float
    """Smallest factor below 1 down to which the loop is stable; 0 if it is at all down to 1e-4.

    >>> margins = flexsc.Scenario.example("rotation-robust").linearise(loop="command").margins()
    >>> margins.gain_below
    0.0
    """
    gain_above: float
    """Largest factor above 1 up to which it is stable; infinite if it is at all up to 10 000.

    >>> margins = flexsc.Scenario.example("rotation-robust").linearise(loop="command").margins()
    >>> margins.gain_above > 2.0                                        # more than 6 dB
    True
    """
    phase: float
    """Largest phase (rad) up to which it is stable, of either sign; pi if it is at all.

    >>> margins = flexsc.Scenario.example("rotation-robust").linearise(loop="command").margins()
    >>> margins.phase > 0.5                                             # rad
    True
    """


Margins.__module__ = "flexsc"


def margins(opened: Linear, inputs: Sequence[str] | None) -> Margins:
    """Return the margins of an opened loop."""
    import numpy as np

    if opened.b.shape[1] != opened.c.shape[0]:
        raise ValueError("only an opened loop, with as many outputs as inputs, has margins")
    off = _chosen(opened, inputs)

    def poles(factor: complex) -> npt.NDArray[np.complex128]:
        back = np.linalg.inv(np.eye(len(off)) + opened.d * np.where(off, factor, 1.0))
        closed = opened.a - opened.b * np.where(off, factor, 1.0) @ back @ opened.c
        return np.linalg.eigvals(closed).astype(np.complex128)

    def beyond(factor: complex) -> float:
        found = poles(factor)
        return float(found.real.max() if opened.period is None else np.abs(found).max() - 1.0)

    # One limit in time, also for a loop without a period.
    steady = engine.steady_change(opened.period or 1.0)
    nominal = beyond(1.0)
    if nominal > steady:
        raise ValueError(_unstable_text(poles(1.0), opened.period))
    # A pole that the loop leaves on the limit, such as an undamped mode, stays there.
    limit = -steady if nominal < -2.0 * steady else steady

    def unstable(factor: complex) -> bool:
        return beyond(factor) > limit

    down = _first(lambda power: unstable(10.0**-power), 4.0)
    up = _first(lambda power: unstable(10.0**power), np.log10(_LARGEST))
    turns = [_first(lambda phase, way=way: unstable(np.exp(1j * way * phase)), pi) for way in (1, -1)]  # type: ignore[misc]
    return Margins(
        0.0 if down is None else float(10.0**-down),
        float("inf") if up is None else float(10.0**up),
        min((float(turn) for turn in turns if turn is not None), default=pi),
    )


def _unstable_text(poles: npt.NDArray[np.complex128], period: float | None) -> str:
    """The error of a loop that is not stable: its worst pole and the frequency of that pole."""
    import numpy as np

    if period is None:
        worst = poles[np.argmax(poles.real)]
        where = f"a pole at {worst.real:.5g} {worst.imag:+.5g}i rad/s"
    else:
        worst = poles[np.argmax(np.abs(poles))]
        frequency = abs(np.angle(worst)) / period
        where = f"the spectral radius {abs(worst):.5g}, of a pole at {frequency:.4g} rad/s"
    return f"the closed loop is not stable and has no margins: it has {where}"


def _chosen(opened: Linear, inputs: Sequence[str] | None) -> npt.NDArray[np.bool_]:
    """Which of the commands are off."""
    import numpy as np

    names = [signal.name for signal in opened.inputs]
    if inputs is None:
        return np.ones(len(names), dtype=np.bool_)
    numbered = [name.rstrip("0123456789").removesuffix("_") for name in names]
    for name in inputs:
        if name not in names and name not in numbered:
            raise KeyError(f"no command {name!r}; there are {', '.join(dict.fromkeys(numbered))}")
    return np.array(
        [name in inputs or number in inputs for name, number in zip(names, numbered, strict=True)]
    )


def _first(unstable: Callable[[float], bool], largest: float) -> float | None:
    """The last value below the first that is unstable, from 0 on; none if there is none."""
    import numpy as np

    stable = 0.0
    for value in np.linspace(0.0, largest, 401)[1:]:
        if unstable(value):
            beyond = float(value)
            while beyond - stable > 1e-12 * largest:
                middle = 0.5 * (stable + beyond)
                stable, beyond = (stable, middle) if unstable(middle) else (middle, beyond)
            return stable
        stable = float(value)
    return None
