"""Rotations by a load that is distributed over the body, for `load.csv`.

Own mass and stiffness matrices in generalised coordinates, own frequencies for the series, and the motion
by matrix exponentials of the coordinates together with the harmonics of the command; the exact chain by
DOP853. A load is a vector of generalised forces that all vary as the command, and the command is its torque
about the axis.

`python3 load_oracle.py` writes the table: case, quantity, time (s), value.
"""

import csv
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import block_diag, eigh, expm

ANGLE, TIME, END = np.pi / 2, 12.0, 20.0
INSTANTS = [1.5, 3.0, 4.5, 6.0, 7.5, 9.0, 10.5, 12.0, 14.0, 17.0, 20.0]
SIGMA = 2 * np.pi / TIME
LENGTH, HINGES, ROOT, HUB = 2.5, [3000.0, 2000.0, 2000.0, 2000.0], 0.5, 166.67


def panels():
    """Matrices of the hub and both panels in [theta, v_1..v_4], by summing over Gauss points of the mass."""
    mass, stiffness = np.zeros((5, 5)), np.zeros((5, 5))
    mass[0, 0] = HUB
    points, weights = np.polynomial.legendre.leggauss(4)

    def add(m, x, parts):
        row = np.zeros(5)
        row[0] = x
        for k, part in parts:
            if k:
                row[k] += part
        mass[:] += 2 * m * np.outer(row, row)

    for k in range(1, 5):
        inner = ROOT + LENGTH * (k - 1)
        for xi, weight in zip(0.5 * (points + 1), 0.5 * weights, strict=True):
            add(3.0 * LENGTH * weight, inner + LENGTH * xi, [(k - 1, 1 - xi), (k, xi)])
        add(5.0, inner + LENGTH, [(k, 1.0)])
        bend = section(k) - (section(k - 1) if k > 1 else 0)
        stiffness += 2 * HINGES[k - 1] * np.outer(bend, bend)
    return mass, stiffness


def section(k):
    """Weights of the angle of a section relative to the hub."""
    row = np.zeros(5)
    row[k] = 1 / LENGTH
    if k > 1:
        row[k - 1] = -1 / LENGTH
    return row


def on_panels(hub, sections):
    """Generalised forces of a torque on the hub and on each section of both panels."""
    forces = np.zeros(5)
    forces[0] = hub
    for k, torque in enumerate(sections, 1):
        turned = section(k)
        turned[0] = 1.0
        forces += 2 * torque * turned
    return forces


def beams():
    """A hub and two equal arms of two masses on springs, in their absolute displacements a1, a2, b1, b2:
    two of the modes do not turn the hub."""
    mass = np.diag([40.0, 6.0, 4.0, 6.0, 4.0])
    places = [2.0, 4.0, -2.0, -4.0]
    stiffness = np.zeros((5, 5))
    for first, tip in ((1, 2), (3, 4)):
        for c, (a, xa), (b, xb) in (
            (90.0, (None, 0.0), (first, places[first - 1])),
            (60.0, (first, places[first - 1]), (tip, places[tip - 1])),
        ):
            row = np.zeros(5)
            row[b] += 1
            if a:
                row[a] -= 1
            row[0] -= xb - xa
            stiffness += c * np.outer(row, row)
    return mass, stiffness, np.array([1.0, *places])


def twins():
    """A hub and two arms: the antisymmetric displacement v, and the symmetric s, apart from the hub."""
    mass = np.array([[50.0, 8.0, 0.0], [8.0, 4.0, 0.0], [0.0, 0.0, 4.0]])
    return mass, np.diag([0.0, 30.0, 42.0]), np.array([1.0, 0.0, 0.0])


def frequencies(mass, stiffness):
    return np.sqrt(np.abs(eigh(stiffness, mass, eigvals_only=True)))[1:]


def series(kind, inertia, zeros, end_rate):
    """Constant and harmonics [frequency, cosine, sine] of the command, by the defining linear equations."""
    p = len(zeros)
    mean = inertia * end_rate / TIME
    travel = inertia * (ANGLE - 0.5 * end_rate * TIME)
    kappa = SIGMA * (np.arange(1, p + 2) - (0.0 if kind == "sine" else 0.5))
    rows, right = np.zeros((p + 1, p + 1)), np.zeros(p + 1)
    rows[0] = TIME / kappa if kind == "sine" else 2 / kappa**2
    right[0] = travel
    for j, w in enumerate(zeros, 1):
        rows[j] = (kappa if kind == "sine" else w) / (w**2 - kappa**2)
    odd = np.linalg.solve(rows, right)
    harmonics = [(f, 0.0, a) if kind == "sine" else (f, a, 0.0) for f, a in zip(kappa, odd, strict=True)]
    if mean:
        even = SIGMA * np.arange(1, p + 1)
        balance = np.array([[1 / (w**2 - k**2) for k in even] for w in zeros])
        c = np.linalg.solve(balance, [-mean / w**2 for w in zeros])
        harmonics += [(f, a, 0.0) for f, a in zip(even, c, strict=True)]
    return mean, harmonics, odd


def command(mean, harmonics, t):
    return mean + sum(c * np.cos(f * t) + s * np.sin(f * t) for f, c, s in harmonics)


def motion(mass, stiffness, forces, mean, harmonics, held=None):
    """States [q, q'] at the instants, under the command or its mean over each period of `held` seconds."""
    n = len(mass)
    free = np.zeros((2 * n, 2 * n))
    free[:n, n:] = np.eye(n)
    free[n:, :n] = -np.linalg.solve(mass, stiffness)
    push = np.concatenate([np.zeros(n), np.linalg.solve(mass, forces)])
    states, y, now = [], np.zeros(2 * n), 0.0
    if held:

        def integral(t):
            return mean * t + sum(c * np.sin(f * t) / f - s * np.cos(f * t) / f for f, c, s in harmonics)

        whole = np.zeros((2 * n + 1, 2 * n + 1))
        whole[: 2 * n, : 2 * n], whole[: 2 * n, -1] = free, push
        step = expm(whole * held)
        for k in range(round(END / held)):
            a, b = k * held, (k + 1) * held
            u = (integral(b) - integral(a)) / held if b < TIME + 1e-9 else 0.0
            y = (step @ np.append(y, u))[: 2 * n]
            if any(abs(b - t) < 1e-9 for t in INSTANTS):
                states.append(y)
        return states
    oscillators = [np.array([[0.0, f], [-f, 0.0]]) for f, _, _ in harmonics]
    whole = block_diag(free, np.zeros((1, 1)), *oscillators)
    whole[: 2 * n, 2 * n] = push * mean
    for k, (_, c, s) in enumerate(harmonics):
        # [cos, -sin] of each harmonic.
        whole[: 2 * n, 2 * n + 1 + 2 * k] = push * c
        whole[: 2 * n, 2 * n + 2 + 2 * k] = push * -s
    z = np.concatenate([y, [1.0], *([1.0, 0.0] for _ in harmonics)])
    for t in INSTANTS:
        if t <= TIME:
            z = expm(whole * (t - now)) @ z
            y = z[: 2 * n]
        else:
            y = expm(free * (t - now)) @ y
        now = t
        states.append(y)
    return states


def chain(mass, stiffness, torques, mean, harmonics):
    """States of the exact chain in absolute angles: Lagrange's equations with torques on hub and sections."""
    to_nodes = np.zeros((5, 5))
    to_nodes[0, 0] = 1
    for k in range(1, 5):
        to_nodes[k, 0] = -LENGTH * k
        to_nodes[k, 1 : k + 1] = LENGTH
    a, c = to_nodes.T @ mass @ to_nodes, to_nodes.T @ stiffness @ to_nodes

    def rate(t, y, on):
        psi, speed = y[:5], y[5:]
        turn = psi[:, None] - psi[None, :]
        push = torques * (command(mean, harmonics, t) if on else 0.0)
        force = push - c @ psi - (a * np.sin(turn)) @ speed**2
        return np.concatenate([speed, np.linalg.solve(a * np.cos(turn), force)])

    settings = {"method": "DOP853", "rtol": 3e-14, "atol": 1e-14}
    during = [t for t in INSTANTS if t <= TIME]
    after = [t for t in INSTANTS if t > TIME]
    first = solve_ivp(rate, (0, TIME), np.zeros(10), t_eval=during, args=(True,), **settings)
    then = solve_ivp(rate, (TIME, END), first.y[:, -1], t_eval=after, args=(False,), **settings)
    return [*first.y.T, *then.y.T]


def elastic_energy(mass, stiffness, rotation, state):
    """Energy of what is left without the rigid rotation of the same angular momentum."""
    n = len(mass)
    inertia = rotation @ mass @ rotation
    q, speed = (part - rotation * (rotation @ mass @ part) / inertia for part in (state[:n], state[n:]))
    return 0.5 * (speed @ mass @ speed + q @ stiffness @ q)


def rows():
    mass, stiffness = panels()
    hub_turns = np.array([1.0, 0, 0, 0, 0])
    angles = {f"section_{k}": section(k) for k in range(1, 5)}
    unit = np.eye(5)
    of_panels, of_arms = (mass, stiffness, hub_turns), beams()
    tips = {"tip_a": unit[2], "tip_b": unit[4]}
    both = {"v": np.eye(3)[1], "s": np.eye(3)[2]}
    # Matrices and rotation, load, series, suppressed modes, rate at the end, outputs, period of a hold.
    cases = {
        "tips": (*of_panels, on_panels(0, [0, 0, 0, 1]), "sine", 2, 0.0, angles, None),
        "shared": (*of_panels, on_panels(1, [0, 0, 0.25, 0.5]), "cosine", 1, 0.1, angles, None),
        "all-modes": (*of_panels, on_panels(-1, [0, 2, 0, 0.5]), "sine", 4, 0.0, angles, None),
        "held": (*of_panels, on_panels(0, [0, 0, 0, 1]), "sine", 1, 0.0, angles, 0.02),
        "one-arm": (*of_arms, 3.0 * unit[2] + 0.2 * unit[3], "sine", 2, 0.0, tips, None),
        "twins": (*twins(), np.array([1.0, 0.1, 0.05]), "cosine", 1, 0.0, both, None),
    }
    for name, (m, k, rotation, forces, kind, p, end_rate, outputs, held) in cases.items():
        per_torque = forces / (rotation @ forces)
        zeros = frequencies(m, k)[:p]
        mean, harmonics, odd = series(kind, rotation @ m @ rotation, zeros, end_rate)
        states = motion(m, k, per_torque, mean, harmonics, held)
        for number, coefficient in enumerate(odd):
            yield name, f"coefficient_{number}", TIME, coefficient
        end = INSTANTS.index(TIME)
        yield name, "energy", TIME, elastic_energy(m, k, rotation, states[end])
        n = len(m)
        for t, state in zip(INSTANTS, states, strict=True):
            yield name, "angle", t, state[0]
            yield name, "rate", t, state[n]
            for output, weights in outputs.items():
                yield name, output, t, weights @ state[:n]
    torques = np.array([0.5, 0, 0, 0.2, 0.6])
    mean, harmonics, _ = series("sine", mass[0, 0], frequencies(mass, stiffness)[:1], 0.0)
    for t, state in zip(
        INSTANTS, chain(mass, stiffness, torques / torques.sum(), mean, harmonics), strict=True
    ):
        yield "exact", "angle", t, state[0]
        yield "exact", "rate", t, state[5]
        for k in range(1, 5):
            yield "exact", f"section_{k}", t, state[k] - state[0]


if __name__ == "__main__":
    with Path(__file__).with_name("load.csv").open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["case", "quantity", "time_s", "value"])
        for case, quantity, t, value in rows():
            table.writerow([case, quantity, t, repr(float(value))])
