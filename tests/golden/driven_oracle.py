"""A spacecraft whose panels are turned by drives: driven.toml and driven.csv.

    pip install numpy scipy
    python3 tests/golden/driven_oracle.py tests/golden

The body is that of two_panels.py; the centres of the panels are beside the drives' axes, so that drives move
the centre of mass. Momenta are derivatives of T. H' = T - w x H, pi' = -O^2 eta - D eta' + dT/d eta + f, by
DOP853 with a relative tolerance of 1e-13, from each change of what acts to the next. One drive turns at a
constant rate from the start, the other begins and ends along a trapezium.

driven.csv has a line each half second: t, Q (4), w (3), |H| with the wheel, the free frequencies (4), the
energy of the modes 1/2 (eta' S eta' + eta O^2 eta) with S of the free hub, the energy of all but the wheel,
and the place of the first point (3). The work of the drives is that of their torque Q = d/dt dT/d alpha' -
dT/d alpha; the balance with it is asserted here.
"""

import sys

import numpy as np
from scipy.linalg import eigh
from two_panels import (
    DURATION,
    ETA,
    H_WHEEL,
    MASS,
    O2,
    RATE,
    D,
    appendage,
    derivative,
    integrated,
    linear,
    mean_axes,
    quaternion,
    quaternion_rate,
    spacecraft,
    wheels,
)

TORQUE, FORCE, AT = np.array([0.0, 0.02, 0]), np.array([0.3, 0.1, -0.2]), np.array([0.4, 0.3, 0.2])
FORCED = (6.0, 9.0)


def drives(t):
    a = [0.3 + 0.05 * t, 0.0]
    rate, acc = [0.05, 0.0], [0.0, 0.0]
    if t >= 5:  # rate 0.08, from 5 s, until 20 s, acceleration 0.04: ramps of 2 s
        s = min(t, 7) - 5
        a[1] += 0.02 * s * s
        rate[1], acc[1] = 0.04 * s, 0.04 if t < 7 else 0.0
    if t >= 7:
        a[1] += 0.08 * (min(t, 20) - 7)
    if t >= 20:
        s = min(t, 22) - 20
        a[1] += 0.08 * s - 0.02 * s * s
        rate[1], acc[1] = 0.08 - 0.04 * s, -0.04 if t < 22 else 0.0
    return np.array(a), np.array(rate), np.array(acc)


def split(t, y):
    """w, eta' and what else is of use, from momenta."""
    angles, rate, _ = drives(t)
    m0, changes, c, dc = linear(angles)
    eta, pi, big_h = y[7:11], y[11:15], y[4:7]
    m = m0 + sum(e * d for e, d in zip(eta, changes, strict=False))
    free = [0, 1, 2, 5, 6, 7, 8]
    given = m[np.ix_(free, [3, 4])] @ rate
    z = np.linalg.solve(m[np.ix_(free, free)], np.concatenate([big_h - H_WHEEL, pi]) - given)
    full = np.concatenate([z[:3], rate, z[3:]])
    return full, m, changes, c, dc, angles


def slope(angles, eta, full, k):
    """dT/d alpha of a drive, at fixed z."""

    def t_at(s):
        a = angles.copy()
        a[k] += s
        m0, changes, _, _ = linear(a)
        return 0.5 * full @ (m0 + sum(e * d for e, d in zip(eta, changes, strict=False))) @ full

    return derivative(t_at)


def rates(t, y, forced, work=False):
    full, m, changes, c, dc, angles = split(t, y)
    w, eta, speeds = full[:3], y[7:11], full[5:]
    force = FORCE if forced else np.zeros(3)
    arm = AT - c - dc @ eta
    torque = TORQUE + np.cross(arm, force)
    q = y[:4]
    h = torque - np.cross(w, y[4:7])
    pull = np.array([0.5 * full @ d @ full for d in changes])
    pi = -O2 * eta - D * speeds + pull - dc.T @ force
    inertial = rotated(q, force / MASS)
    out = [quaternion_rate(q, w), h, speeds, pi, y[18:21], inertial]
    if work:
        _, rate, acc = drives(t)
        p = m[3:5] @ full
        # Work of the drives, d(alpha' p) apart: -alpha'' p - alpha' dT/d alpha; of what acts; of damping.
        own = sum(-acc[k] * p[k] - rate[k] * slope(angles, eta, full, k) for k in range(2))
        # A force on the hub works by how its place moves against the centre of mass.
        slid = centre_rate(angles, rate, eta)
        moved = np.cross(w, arm) - slid - dc @ speeds
        # Drives hold against a force that would turn them: they move the centre of mass under it.
        own += force @ slid
        acts = TORQUE @ w + force @ moved
        out.append([own, acts - speeds @ (D * speeds)])
    else:
        out.append([0.0, 0.0])
    return np.concatenate(out)


def centre_rate(angles, rate, eta):
    """How fast drives move the centre of mass in the hub."""

    def centre(s):
        _, _, c, d = linear(angles + s * rate)
        return c + d @ eta

    return derivative(centre)


def rotated(q, v):
    u = q[1:]
    return v + 2 * np.cross(u, np.cross(u, v) + q[0] * v)


def start():
    """The modes are displaced and at rest, and the body turns."""
    angles, rate, _ = drives(0.0)
    m0, changes, _, _ = linear(angles)
    m = m0 + sum(e * d for e, d in zip(ETA, changes, strict=False))
    p = m @ np.concatenate([RATE, rate, np.zeros(4)])
    bent = mean_axes(m0, ETA, 5)
    return np.concatenate([quaternion(bent), p[:3] + H_WHEEL, ETA, p[5:], np.zeros(3), np.zeros(3), [0, 0]])


def row(t, y, first):
    full, m, _, c, dc, angles = split(t, y)
    m0 = linear(angles)[0]
    body = m0[:3, :3]
    delta, e = m0[:3, 5:], m0[5:, 5:]
    s = e - delta.T @ np.linalg.solve(body, delta)
    modal = 0.5 * (full[5:] @ s @ full[5:] + y[7:11] @ (O2 * y[7:11]))
    energy = 0.5 * full @ m @ full + 0.5 * y[7:11] @ (O2 * y[7:11])
    frequencies = np.sqrt(eigh(np.diag(O2), s, eigvals_only=True))
    place = y[15:18] + rotated(y[:4], AT - c - dc @ y[7:11]) - first
    values = [t, *y[:4], *full[:3], np.linalg.norm(y[4:7]), *frequencies, modal, energy, *place]
    return values, energy, (m[3:5] @ full) @ full[3:5]


def fly(work):
    begun = start()
    _, _, c, dc = linear(drives(0.0)[0])
    first = rotated(begun[:4], AT - c - dc @ ETA)

    def between(begin, end):
        forced = FORCED[0] <= begin < FORCED[1]
        # Just before the end, where rates would already change.
        return lambda t, y: rates(min(t, end - 1e-13), y, forced, work)

    ends = [5.0, 6.0, 7.0, 9.0, 20.0, 22.0, DURATION]
    rtol, atol = (1e-9, 1e-11) if work else (1e-13, 1e-15)
    states = [(0.0, begun), *integrated(between, begun, ends, rtol, atol)]
    rows = [row(t, y, first) for t, y in states]
    (_, e0, p0), (_, e1, p1) = rows[0], rows[-1]
    return [values for values, *_ in rows], states[-1][1], e1 - e0, p1 - p0


def scenario():
    lines = [
        "# Two panels of point masses that drives turn, beside their centres: made by driven_oracle.py.",
        f"duration = {DURATION}",
        *spacecraft(),
        f'points = [{{ name = "bus", position = {AT.tolist()} }}]',
    ]
    turns = ["rate = 0.05, angle = 0.3", "rate = 0.08, from = 5, until = 20, acceleration = 0.04"]
    for k, turn in enumerate(turns):
        how = [] if k == 0 else ["turned = { about = [0, 0, 1], by = 3.141592653589793 }"]
        lines += appendage(k, [*how, f"drive = {{ about = [0, 1, 0], {turn} }}"])
    lines += [
        "[[disturbance]]",
        'about = "pitch"',
        f"torque = {TORQUE[1]}",
        "[[disturbance]]",
        f"force = {FORCE.tolist()}",
        f"from = {FORCED[0]}",
        f"to = {FORCED[1]}",
        "[law.open]",
        *wheels(),
        "[log]",
        "period = 0.5",
    ]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    folder = sys.argv[1]
    with open(f"{folder}/driven.toml", "w") as file:
        file.write(scenario())
    rows, *_ = fly(False)
    with open(f"{folder}/driven.csv", "w") as file:
        for values in rows:
            file.write(",".join(f"{value:.16e}" for value in values) + "\n")
    # Once more with the work, for its balance.
    _, y, gained, kept = fly(True)
    gap = gained - (y[21] + kept + y[22])
    print(
        f"energy gained {gained}, work of the drives {y[21] + kept}, of the rest {y[22]}, gap {gap:.1e}",
        file=sys.stderr,
    )
    assert abs(gap) < 1e-8
