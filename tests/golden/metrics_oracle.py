"""Metrics of a rotation by dense search with SciPy: what tests/exact.rs compares with.

The body of the test under its sampled PD law, from sample to sample by the matrix exponential of the whole
system in physical coordinates. Extremes: 4000 points in each piece, then Brent's method on the derivative.
Integrals: Gauss-Legendre between the zeros of the error. Nothing of the program is used:
python tests/golden/metrics_oracle.py
"""

from itertools import pairwise

import numpy as np
from scipy.linalg import expm
from scipy.optimize import brentq

INERTIA, PERIOD, END, LATE = 500.0, 0.5, 40.0, 35.0
W, K, ZETA = [0.7, 2.3], [0.3, 0.12], [0.004, 0.01]
KP, KD, BAND = 40.0, 260.0, 2e-3
START = np.array([0.02, -0.001, 1e-3, 0.0, 0.0, 2e-3])  # rigid angle and rate, then each mode's
PUSH = (20.0, 21.3, 1.5)  # from, to (s), N m
POINTS = 4000

A = np.zeros((6, 6))
B = np.zeros(6)
A[0, 1], B[1] = 1.0, 1.0
for i, (w, k, zeta) in enumerate(zip(W, K, ZETA, strict=True)):
    x, v = 2 + 2 * i, 3 + 2 * i
    A[x, v], A[v, x], A[v, v], B[v] = 1.0, -w * w, -2 * zeta * w, k
ANGLE = np.array([1.0, 0, 1, 0, 1, 0])
TIP = np.array([1.5, 0, 4.0, 0, -2.5, 0])


def flow(h, u):
    """Transition over h, and what the reduced moment u adds."""
    m = np.zeros((7, 7))
    m[:6, :6], m[:6, 6] = A * h, B * u * h
    e = expm(m)
    return e[:6, :6], e[:6, 6]


def main():
    edges = sorted({*np.arange(0, END + 1e-9, PERIOD), *PUSH[:2]})
    z, torque, peak = START.copy(), 0.0, 0.0
    pieces = []
    for a, b in pairwise(edges):
        if abs(a / PERIOD - round(a / PERIOD)) < 1e-9:
            torque = -KP * (ANGLE @ z) - KD * (ANGLE @ (A @ z))
        peak = max(peak, abs(torque))
        push = PUSH[2] if PUSH[0] - 1e-9 <= a < PUSH[1] - 1e-9 else 0.0
        u = (torque + push) / INERTIA
        pieces.append((a, b, z.copy(), u))
        e, f = flow(b - a, u)
        z = e @ z + f
    extremes = {"angle": [], "late": [], "tip": [], "tip late": []}
    itae = 0.0
    outside = 0.0
    last = 0.0
    nodes, weights = np.polynomial.legendre.leggauss(16)
    for a, b, z0, u in pieces:

        def state(h, z0=z0, u=u):
            e, f = flow(h, u)
            return e @ z0 + f

        step = (b - a) / POINTS
        e, f = flow(step, u)
        states = [z0]
        for _ in range(POINTS):
            states.append(e @ states[-1] + f)
        states = np.array(states)
        for name, row in (("angle", ANGLE), ("tip", TIP)):
            # The moment has no part in either rate.
            values, rates = states @ row, states @ (row @ A)
            found = [(a, values[0]), (b, values[-1])]
            for i in np.nonzero(rates[:-1] * rates[1:] < 0)[0]:
                h = brentq(
                    lambda h, row=row, state=state: row @ (A @ state(h)),
                    i * step,
                    (i + 1) * step,
                    xtol=1e-15,
                    rtol=1e-15,
                )
                found.append((a + h, row @ state(h)))
            extremes[name] += [v for _, v in found]
            if a >= LATE:
                extremes["late" if name == "angle" else "tip late"] += [v for _, v in found]
        values = states @ ANGLE

        def crossings(level, values=values, state=state, step=step):
            y = values - level

            def off(h):
                return ANGLE @ state(h) - level  # noqa: B023

            return [
                brentq(off, i * step, (i + 1) * step, xtol=1e-15, rtol=1e-15)
                for i in np.nonzero(y[:-1] * y[1:] < 0)[0]
            ]

        cuts = [0.0, *crossings(0.0), b - a]
        for c, d in pairwise(cuts):
            h = 0.5 * (c + d) + 0.5 * (d - c) * nodes
            itae += (
                0.5
                * (d - c)
                * sum(w * (a + t) * abs(ANGLE @ state(t)) for w, t in zip(weights, h, strict=True))
            )
        cuts = [0.0, *sorted(crossings(BAND) + crossings(-BAND)), b - a]
        for c, d in pairwise(cuts):
            if abs(ANGLE @ state(0.5 * (c + d))) > BAND:
                outside += d - c
                last = a + d

    def most(name):
        return max(abs(v) for v in extremes[name])

    def swing(name):
        return 0.5 * (max(extremes[name]) - min(extremes[name]))

    print(f"peak_torque_nm {peak:.15e}")
    print(f"angle_error_peak_rad {most('angle'):.15e}")
    print(f"angle_error_late_rad {most('late'):.15e}")
    print(f"output_peaks {most('tip'):.15e}")
    print(f"output_swings {swing('tip'):.15e}")
    print(f"output_swings_late {swing('tip late'):.15e}")
    print(f"itae {itae:.15e}")
    print(f"time_outside_s {outside:.15e}")
    print(f"settling_time_s {last:.15e}")


main()
