"""Objectives of an adaptation over its windows, by SciPy's matrix exponential and quadrature.

A body with one mode and a PD law through a wheel; after each window the gain k_p grows by a tenth. The motion
between two samples is linear; integrals are by Gauss-Legendre quadrature between the zeros of the integrand.

    python3 objective_oracle.py      # prints objective.csv: window, objective, value
"""

from itertools import pairwise

import numpy as np
from scipy.linalg import expm
from scipy.optimize import brentq

INERTIA, FREQUENCY, DAMPING, GAIN = 10.0, 0.8, 0.01, 0.5
K_P, K_D, PERIOD, STEP = 0.8, 1.5, 0.5, 0.1
WHEEL, ROTOR, SPEED = 1.5, 0.05, 3.0
WINDOW, WINDOWS = 7.3, 4
NODES, WEIGHTS = np.polynomial.legendre.leggauss(40)

# Rigid angle and rate, displacement and rate of the mode, and the constant moment.
A = np.zeros((5, 5))
A[0, 1] = A[2, 3] = A[1, 4] = 1.0
A[3] = [0.0, 0.0, -(FREQUENCY**2), -2.0 * DAMPING * FREQUENCY, GAIN]


def integral(of, h):
    """The integral over a piece of h seconds of what may change its sign."""
    grid = np.linspace(0.0, h, 33)
    values = [of(t) for t in grid]
    edges = [0.0, h]
    for t0, t1, v0, v1 in zip(grid, grid[1:], values, values[1:], strict=False):
        if v0 * v1 < 0.0:
            edges.append(brentq(of, t0, t1, xtol=1e-15))
    edges.sort()
    total = 0.0
    for a, b in pairwise(edges):
        t = 0.5 * (a + b) + 0.5 * (b - a) * NODES
        total += 0.5 * (b - a) * np.dot(WEIGHTS, [abs(of(x)) for x in t])
    return total


def main():
    z = np.array([0.01, 0.0, 0.0, 0.0, 0.0])
    z[4] = 0.0
    k_p, now, sample = K_P, 0.0, 0
    torque = 0.0
    for window in range(WINDOWS):
        end = WINDOW * (window + 1)
        sums = dict.fromkeys(["mean", "square", "rate", "elastic", "torque", "power"], 0.0)
        peak = 0.0
        while now < end - 1e-12:
            if abs(now - sample * PERIOD) < 1e-12:
                torque = WHEEL * (-k_p * (z[0] + z[2]) - K_D * (z[1] + z[3]))
                sample += 1
            upto = min(end, sample * PERIOD)
            h, begin = upto - now, z.copy()
            begin[4] = torque / INERTIA

            def at(t, begin=begin):
                return expm(A * t) @ begin

            def angle(t):
                state = at(t)
                return state[0] + state[2]

            def power(t, held=torque):
                return held * (SPEED - INERTIA * at(t)[1] / ROTOR)

            sums["mean"] += integral(angle, h)
            sums["square"] += integral(lambda t: angle(t) ** 2, h)
            sums["rate"] += integral(lambda t: (at(t)[1] + at(t)[3]) ** 2, h)
            sums["elastic"] += integral(lambda t: at(t)[2] ** 2, h)
            sums["torque"] += abs(torque) * h
            sums["power"] += integral(power, h)
            fine = np.linspace(0.0, h, 200)
            peak = max(peak, max(abs(angle(t)) for t in fine))
            z, now = at(h), upto
        values = {
            "pointing_error_mean": sums["mean"] / WINDOW,
            "pointing_error_rms": np.sqrt(sums["square"] / WINDOW),
            "pointing_error_peak": peak,
            "rate_error_rms": np.sqrt(sums["rate"] / WINDOW),
            "elastic_rms": np.sqrt(sums["elastic"] / WINDOW),
            "torque_mean": sums["torque"] / WINDOW,
            "wheel_power_mean": sums["power"] / WINDOW,
        }
        for name, value in values.items():
            print(f"{window},{name},{value:.15e}")
        k_p += STEP


if __name__ == "__main__":
    main()
