"""Robustness of requirements over time on a damped wave beside an undamped one, t in [0, 600].

e(t) = 3e-3 exp(-t/40) cos(0.35 t + 0.4) + 2e-4 sin(2.13 t), by critical points in 30 digits (mpmath), for
`crates/control/src/robustness/tests.rs`. Run: python tests/golden/requirements_over_time.py
"""

import mpmath as mp
import numpy as np

mp.mp.dps = 30
DECAY, FAST, PHASE, LARGE = mp.mpf(1) / 40, mp.mpf("0.35"), mp.mpf("0.4"), mp.mpf("3e-3")
RIPPLE, SMALL = mp.mpf("2.13"), mp.mpf("2e-4")


def error(t):
    return LARGE * mp.exp(-DECAY * t) * mp.cos(FAST * t + PHASE) + SMALL * mp.sin(RIPPLE * t)


def rate(t):
    wave = -DECAY * mp.cos(FAST * t + PHASE) - FAST * mp.sin(FAST * t + PHASE)
    return LARGE * mp.exp(-DECAY * t) * wave + SMALL * RIPPLE * mp.cos(RIPPLE * t)


def roots(function, low, high):
    """Return the roots of a function that changes slowly over 1e-2 s."""
    grid = np.linspace(low, high, round((high - low) * 100) + 1)
    signs = np.sign([float(function(mp.mpf(t))) for t in grid])
    turns = np.flatnonzero(signs[:-1] * signs[1:] < 0)
    ends = [(mp.mpf(grid[i]), mp.mpf(grid[i + 1])) for i in turns]
    return [mp.findroot(function, pair, solver="anderson", tol=1e-50) for pair in ends]


EXTREMA = roots(rate, 0, 600)


def largest(low, high):
    """Return the largest size of the error between two times, and where it is."""
    times = [mp.mpf(low), mp.mpf(high), *(t for t in EXTREMA if low < t < high)]
    return max((abs(error(t)), t) for t in times)


def main() -> None:
    print("extrema", len(EXTREMA))
    size, at = largest(100, 600)
    print("always[100, 600] e < 5e-4:", mp.nstr(mp.mpf("5e-4") - size, 15), mp.nstr(at, 15))
    # The windows of the best start end with the run of starts: no later peak is smaller.
    size, at = largest(120, 180)
    print("eventually[0, 120] always[0, 60] e < 4e-4:", mp.nstr(mp.mpf("4e-4") - size, 14), mp.nstr(at, 12))
    size, at = largest(60, 90)
    print("eventually[0, 60] always[0, 30] e < 1e-3:", mp.nstr(mp.mpf("1e-3") - size, 15), mp.nstr(at, 12))
    print("e < 3e-3 until[0, 100] rate < 5e-4, scaled:", mp.nstr(1 - abs(error(0)) / LARGE, 15))
    for limit in ("6e-4", "2.5e-4"):
        crossings = roots(lambda t, limit=limit: abs(error(t)) - mp.mpf(limit), 0, 600)
        print("below", limit, "from", mp.nstr(crossings[-1], 16))
    above = roots(lambda t: abs(error(t)) - mp.mpf("2.2e-4"), 100, 600)
    total, begin, is_above = mp.mpf(0), mp.mpf(100), abs(error(100)) > mp.mpf("2.2e-4")
    for t in [*above, mp.mpf(600)]:
        total, begin, is_above = total + (t - begin if is_above else 0), t, not is_above
    print("share above 2.2e-4:", mp.nstr(total / 500, 15), "crossings", len(above))


if __name__ == "__main__":
    main()
