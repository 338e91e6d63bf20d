"""Exact sampling of a linear system whose inputs are held and late."""

from __future__ import annotations

from math import floor
from typing import TYPE_CHECKING, NamedTuple

from flexsc import _native as engine

if TYPE_CHECKING:
    from flexsc._blocks import Matrix


class Sampled(NamedTuple):
    """x[k+1] = a x[k] + b u[k], whose last states are the inputs of `waiting` samples, the latest first."""

    a: Matrix
    b: Matrix
    waiting: int


def whole_and_part(period: float, delay: float) -> tuple[int, float]:
    """Return the whole periods of a delay, and the rest (s)."""
    # A delay of whole periods is one, whatever its last bits.
    late = floor(delay / period + 1e-9)
    part = max(delay - late * period, 0.0)
    return late, part if part > 1e-9 * period else 0.0


def sampled(a: Matrix, b: Matrix, period: float, delay: float) -> Sampled:
    """Return x' = a x + b u at samples `period` (s) apart, with inputs that act `delay` (s) late."""
    import numpy as np

    order, count = b.shape
    late, part = whole_and_part(period, delay)
    flow, now = held(a, b, period)
    forced = [now]
    if part > 0.0:
        rest, new = held(a, b, period - part)
        forced = [new, rest @ held(a, b, part)[1]]
    waiting = late + len(forced) - 1
    size = order + count * waiting
    big, into = np.zeros((size, size)), np.zeros((size, count))
    big[:order, :order] = flow
    for k, column in enumerate(forced):
        back = late + k
        if back == 0:
            into[:order] = column
        else:
            at = order + count * (back - 1)
            big[:order, at : at + count] = column
    if waiting:
        into[order : order + count] = np.eye(count)
        for k in range(1, waiting):
            at = order + count * k
            big[at : at + count, at - count : at] = np.eye(count)
    return Sampled(big, into, waiting)


def held(a: Matrix, b: Matrix, h: float) -> tuple[Matrix, Matrix]:
    """Return the motion over a time (s): of the state, and by inputs that are held."""
    import numpy as np

    order, count = b.shape
    whole = np.zeros((order + count, order + count))
    whole[:order, :order], whole[:order, order:] = a * h, b * h
    whole = engine.exponential(whole)
    return whole[:order, :order], whole[:order, order:]
