"""Golden numbers of tests/axes.rs, by NumPy and SciPy: this program writes `axes.csv`.

Three axes that small rates leave alone: about each a body with the same four modes, of which it is turned
by its own; a sampled angle without noise, a Kalman filter, a PD law on the filter's hub, and a wheel that
answers 0.1 s late. The motion is SciPy's matrix exponential.
"""

import csv
from pathlib import Path

import numpy as np
from scipy.linalg import expm

PERIOD, DELAY = 0.5, 0.1
FREQUENCIES = np.array([0.9, 1.3, 0.7, 2.3])
DAMPING = np.array([0.005, 0.0, 0.01, 0.0])
# Rotation at the hub for a unit of each mode (rad/(m sqrt(kg))), and the axis.
ROTATIONS = [(0.06, 0), (0.05, 1), (0.04, 2), (0.03, 0)]
INERTIAS, K_P, K_D = [80.0, 120.0, 200.0], [3.2, 4.8, 8.0], [22.0, 34.0, 56.0]
LAW_PERIODS = [0.5, 1.0, 0.5]
# Angle (rad), rate (rad/s), and of each mode displacement and rate (m sqrt(kg), and by s).
ANGLES, RATES = [1.0, -0.7, 0.5], [0.05, 0.02, -0.04]
MODES = [(2.0, 1.0), (-1.0, 2.0), (3.0, -1.0), (1.0, -2.0)]
# Torque (N m), from and to (s), about each axis.
DISTURBANCES = [(1.0, 10.0, 30.0), (0.0, 0.0, 0.0), (-1.5, 5.0, 60.0)]
ANGLE_NOISE, MOMENT_NOISE = 1e-4, 1e-8
SPREAD = [1e-3, 1e-3, 2e-3, 6e-4]
TIMES = [10.0, 20.0, 40.0, 60.0]


def angles(axis):
    inertia = INERTIAS[axis]
    order = 2 + 2 * len(FREQUENCIES)
    system, push, start = np.zeros((order, order)), np.zeros(order), np.zeros(order)
    spread = np.array(SPREAD[:2] + SPREAD[2:] * len(FREQUENCIES))
    system[0, 1] = push[1] = 1.0
    start[:2] = ANGLES[axis], RATES[axis]
    turned = np.array([r if about == axis else 0.0 for r, about in ROTATIONS])
    gains = inertia * turned**2
    best = np.argmax(gains / FREQUENCIES**2)
    for i, (w, damping) in enumerate(zip(FREQUENCIES, DAMPING, strict=True)):
        x = 2 + 2 * i
        system[x, x + 1], system[x + 1, x], system[x + 1, x + 1] = 1.0, -w * w, -2.0 * damping * w
        push[x + 1] = gains[i]
        start[x : x + 2] = turned[i] * np.array(MODES[i])
        if i != best:
            spread[x : x + 2] *= 0.1

    def held(span):
        whole = np.zeros((order + 1, order + 1))
        whole[:order, :order], whole[:order, order] = system * span, push * span
        whole = expm(whole)
        return whole[:order, :order], whole[:order, order]

    seen = np.array([1.0, 0.0] * (order // 2))
    late, rest, (carry, shove) = held(DELAY), held(PERIOD - DELAY), held(PERIOD)
    z, mean, covariance = start.copy(), start.copy(), np.diag(spread**2)
    torque, start, end = DISTURBANCES[axis]
    out, last, moment = [], 0.0, 0.0
    for k in range(round(TIMES[-1] / PERIOD) + 1):
        t = k * PERIOD
        if k > 0:
            acts = torque / inertia if start <= t - PERIOD < end else 0.0
            for (move, shift), given in ((late, last), (rest, moment)):
                z = move @ z + shift * (given + acts)
            given = (DELAY * last + (PERIOD - DELAY) * moment) / PERIOD
            mean = carry @ mean + shove * given
            covariance = carry @ covariance @ carry.T + MOMENT_NOISE * PERIOD * np.outer(push, push)
        gain = covariance @ seen / (seen @ covariance @ seen + ANGLE_NOISE**2)
        left = np.eye(order) - np.outer(gain, seen)
        mean = mean + gain * (seen @ z - seen @ mean)
        covariance = left @ covariance @ left.T + ANGLE_NOISE**2 * np.outer(gain, gain)
        last = moment
        if t % LAW_PERIODS[axis] == 0.0:
            moment = -(K_P[axis] * (seen @ mean) + K_D[axis] * (np.roll(seen, 1) @ mean)) / inertia
        if t in TIMES:
            out.append(seen @ z)
    return out


def write():
    with Path(__file__).with_name("axes.csv").open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["axis", "time_s", "angle_rad"])
        for axis in range(3):
            rows = zip(TIMES, angles(axis), strict=True)
            table.writerows([axis, t, f"{x:.15e}"] for t, x in rows)


if __name__ == "__main__":
    write()
