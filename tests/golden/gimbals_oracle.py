"""Gimbals that turn at given rates on a spacecraft: gimbals.toml, gimbals.csv, gimbals_rigid.csv.

    pip install numpy scipy
    python3 tests/golden/gimbals_oracle.py tests/golden

The body is that of two_panels.py, with its panels at the angles 0.3 and 0 and without wheels. Four rotors of
momentum h sit in gimbals of a pyramid of cant 0.9 rad; their momentum in the body, sum h (s cos d + t sin d),
is a function of time alone, for the gimbal rates d' are given: failures that add to the rates of an open
loop. H = dT/dw + sum h, H' = -w x H, pi' = -O^2 eta - D eta' + dT/d eta, by DOP853 with a relative tolerance
of 3e-14 from each change of a rate to the next.

gimbals.csv has a line each half second: t, Q (4), w (3), |H|, the energy of the modes, the energy of all but
the rotors, the work of the gimbals' motors and the loss by damping since the start. A motor turns its
gimbal about g = s x t against the torque w x h of the body's turning: its work is the integral of
-h d' (w . t(d)). The balance is asserted here. gimbals_rigid.csv is the same of the hub alone, Euler's
equations: t, Q, w, |H|, energy.
"""

import sys

import numpy as np
from two_panels import (
    DURATION,
    ETA,
    HUB_INERTIA,
    O2,
    RATE,
    WHEEL_INERTIA,
    D,
    appendage,
    integrated,
    linear,
    mean_axes,
    quaternion,
    quaternion_rate,
    spacecraft,
    written,
)

MOMENTUM, CANT = 4.0, 0.9
ANGLES = np.array([0.3, 0.0])
STARTS = np.array([0.2, -0.4, 0.1, 0.7])
# Gimbal (from 0), from, to, rate.
TURNS = [
    (0, 0.0, 12.0, 0.31),
    (1, 2.0, 9.0, -0.8),
    (1, 15.0, 31.0, 0.4),
    (2, 4.0, 5.0, 1.5),
    (2, 5.0, 20.0, -0.25),
    (3, 7.0, 35.0, 0.11),
    (0, 22.0, 38.0, -0.47),
]
FACES = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)]
SPIN = np.array([[-y, x, 0.0] for x, y in FACES])
ACROSS = np.array([[-np.cos(CANT) * x, -np.cos(CANT) * y, np.sin(CANT)] for x, y in FACES])


def gimbals(t):
    """Angles and rates just before t, of rates that change there."""
    angles, rates = STARTS.copy(), np.zeros(4)
    for k, begin, end, rate in TURNS:
        angles[k] += rate * max(min(t, end) - begin, 0.0)
        if begin < t <= end:
            rates[k] += rate
    return angles, rates


def rotors(t):
    """Momentum of the rotors, and the directions in which gimbals change it."""
    angles, _ = gimbals(t)
    sin, cos = np.sin(angles)[:, None], np.cos(angles)[:, None]
    return MOMENTUM * (SPIN * cos + ACROSS * sin).sum(0), ACROSS * cos - SPIN * sin


class Flexible:
    """The body with its panels."""

    def __init__(self):
        m0, self.changes, *_ = linear(ANGLES)
        free = [0, 1, 2, 5, 6, 7, 8]
        self.m0 = m0[np.ix_(free, free)]
        self.m0[:3, :3] += WHEEL_INERTIA * np.eye(3)
        self.changes = [d[np.ix_(free, free)] for d in self.changes]
        delta, inertia = self.m0[:3, 3:], self.m0[:3, :3]
        self.stiff = self.m0[3:, 3:] - delta.T @ np.linalg.solve(inertia, delta)
        self.bent = mean_axes(self.m0, ETA, 3)

    def matrix(self, eta):
        return self.m0 + sum(e * d for e, d in zip(eta, self.changes, strict=True))

    def start(self):
        p = self.matrix(ETA) @ np.concatenate([RATE, np.zeros(4)])
        return np.concatenate([quaternion(self.bent), p[:3] + rotors(0.0)[0], ETA, p[3:], [0.0, 0.0]])

    def speeds(self, t, y):
        p = np.concatenate([y[4:7] - rotors(t)[0], y[11:15]])
        return np.linalg.solve(self.matrix(y[7:11]), p)

    def rates(self, t, y, turning):
        z = self.speeds(t, y)
        w, eta, slid, q = z[:3], y[7:11], z[3:], y[:4]
        pull = np.array([0.5 * z @ d @ z for d in self.changes])
        pi = -O2 * eta - D * slid + pull
        work = -MOMENTUM * turning @ (rotors(t)[1] @ w)
        return np.concatenate(
            [quaternion_rate(q, w), -np.cross(w, y[4:7]), slid, pi, [work, slid @ (D * slid)]]
        )

    def row(self, t, y):
        z, eta = self.speeds(t, y), y[7:11]
        spring = 0.5 * eta @ (O2 * eta)
        modal = 0.5 * z[3:] @ self.stiff @ z[3:] + spring
        energy = 0.5 * z @ self.matrix(eta) @ z + spring
        return [t, *y[:4], *z[:3], np.linalg.norm(y[4:7]), modal, energy, y[15], y[16]]


class Rigid:
    """The hub alone."""

    def start(self):
        return np.concatenate([[1.0, 0, 0, 0], RATE])

    def rates(self, t, y, turning):
        w, q = y[4:], y[:4]
        h, across = rotors(t)
        torque = -MOMENTUM * turning @ across - np.cross(w, HUB_INERTIA @ w + h)
        return np.concatenate([quaternion_rate(q, w), np.linalg.solve(HUB_INERTIA, torque)])

    def row(self, t, y):
        w = y[4:]
        momentum = HUB_INERTIA @ w + rotors(t)[0]
        return [t, *y, np.linalg.norm(momentum), 0.5 * w @ HUB_INERTIA @ w]


def fly(body):
    def between(_, end):
        turning = gimbals(end)[1]
        return lambda t, y: body.rates(t, y, turning)

    begun = body.start()
    ends = sorted({edge for _, a, b, _ in TURNS for edge in (a, b) if edge > 0} | {DURATION})
    states = integrated(between, begun, ends, rtol=3e-14, atol=1e-16)
    return [body.row(t, y) for t, y in [(0.0, begun), *states]]


def scenario():
    lines = [
        "# Gimbals that turn at given rates, on two panels of point masses: made by gimbals_oracle.py.",
        f"duration = {DURATION}",
        *spacecraft(),
        'points = [{ name = "bus" }]',
        "[law.open]",
        "[actuator.control_moment_gyros]",
        'arrangement = "pyramid"',
        f"cant = {CANT}",
        f"momentum = {MOMENTUM}",
        written(STARTS, "angles"),
        "faults = [",
        *[
            f"    {{ added = {{ gimbal = {k + 1}, from = {a}, to = {b}, constant = {rate} }} }},"
            for k, a, b, rate in TURNS
        ],
        "]",
        "[log]",
        "period = 0.5",
    ]
    turned = [
        "{ about = [0, 1, 0], by = 0.3 }",
        "{ about = [0, 0, 1], by = 3.141592653589793 }",
    ]
    for k, turn in enumerate(turned):
        lines += appendage(k, [f"turned = {turn}"])
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    folder = sys.argv[1]
    with open(f"{folder}/gimbals.toml", "w") as file:
        file.write(scenario())
    for name, body in (("gimbals", Flexible()), ("gimbals_rigid", Rigid())):
        rows = fly(body)
        with open(f"{folder}/{name}.csv", "w") as file:
            for values in rows:
                file.write(",".join(f"{value:.16e}" for value in values) + "\n")
        print(name, rows[-1], file=sys.stderr)
        lengths = [row[8] for row in rows]
        assert max(lengths) - min(lengths) < 1e-11
        if name == "gimbals":
            gap = max(abs(row[10] - rows[0][10] - row[11] + row[12]) for row in rows)
            print(f"work {rows[-1][11]}, gap {gap:.1e}", file=sys.stderr)
            assert gap < 1e-11
