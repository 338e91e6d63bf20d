"""Problems that others set, computed here by explicit equations of their own: outside.csv.

    pip install mpmath scipy
    python3 tests/golden/outside_oracle.py > tests/golden/outside.csv

It writes the boom's matrices to outside/ as well.

Nothing of it is shared with the engine: clamped modes and the hub's rate instead of free modes and momentum,
modified Rodrigues parameters instead of quaternions, absolute angles of rigid panels instead of modes, and
an explicit method of order 8 with a relative tolerance of 1e-13. A line is a problem, what it is, when, and
the number.

- di-gennaro: a rigid hub with four clamped modes, of which the public study by Di Gennaro's form has
  inertia and coupling; a PD law on modified Rodrigues parameters with a limit, held for 1 s.
- di-gennaro-faults: the same with another inertia, modes 10 % stiffer, a disturbance, and actuators that give
  half from 10 s on and add 0.3 + 0.05 sin t N m from 50 s on; without noise.
- di-gennaro-noise: the same with the study's white noise on what the law reads, over 10 runs, seen at the
  samples.
- di-gennaro-study: the same with torques that hold the value of each step's end from its start on, failures
  too: so the study must have it, for with it its numbers come out (its largest p 2.02e-2, w 8.43e-4, rms of
  eta 1.37e-2 and of the torque 1.042 after 160 s, and the peaks of w 8.05e-2 and of eta 0.132).
- panels: a hub with two hinged panels in the plane, which is Basilisk's test of its hinged panels by its
  Lagrangian, with the whole kinematics of three rigid bodies; the second angle is counter-clockwise.
- pulse: a body with a mode that couples to translation and rotation, under a torque and an acceleration of
  half a second.
- boom: a beam of 2.82 kg/m and 3.372 m, pinned at one end, with a tip mass of 5.2 beams
  (DETC2007-35511): the roots of its frequency equation in 40 digits. The paper gives the ratio as 5.18, and
  its own roots are those of 5.2; its fourth, 12.599055300, is of neither.
"""

import csv
import sys
from pathlib import Path

import numpy as np
from mpmath import cos, cosh, findroot, mp, mpf, sin, sinh
from scipy.integrate import solve_ivp
from scipy.linalg import expm

mp.dps = 40
rows = csv.writer(sys.stdout, lineterminator="\n")
rows.writerow(["problem", "what", "time", "value"])


def tell(problem, what, time, value):
    rows.writerow([problem, what, repr(float(time)), repr(float(value))])


def integrated(rate, span, state):
    """The state at the end of a span."""
    run = solve_ivp(rate, span, state, method="DOP853", rtol=1e-13, atol=1e-18)
    return run.y[:, -1]


def kinematics(p, w):
    """The rate of modified Rodrigues parameters."""
    return 0.25 * ((1 - p @ p) * w + 2 * np.cross(p, w) + 2 * p * (p @ w))


def di_gennaro_body(inertia, scale):
    """The rate of a state p, w, eta, chi under a torque, for modes that are `scale` of the study's."""
    delta = scale * np.array(
        [
            [6.45637, 1.27814, 2.15629],
            [-1.25819, 0.91756, -1.67264],
            [1.11687, 2.48901, -0.83674],
            [1.23637, -2.65810, -1.12530],
        ]
    )
    omega = scale * np.array([0.7681, 1.1038, 1.8733, 2.5496])
    ratio = scale * np.array([0.0056, 0.0086, 0.0128, 0.0252])
    stiffness, damping = omega**2, 2 * ratio * omega
    inverse = np.linalg.inv(inertia - delta.T @ delta)

    def rate(x, u):
        p, w, eta, chi = x[:3], x[3:6], x[6:10], x[10:]
        elastic = stiffness * eta + damping * (chi - delta @ w)
        left = (inertia - delta.T @ delta) @ w + delta.T @ chi
        turn = inverse @ (-np.cross(w, left) + delta.T @ elastic + u)
        return np.concatenate([kinematics(p, w), turn, chi - delta @ w, -elastic])

    return rate


def di_gennaro_tell(problem, time, x):
    for axis, name in enumerate("xyz"):
        tell(problem, f"p_{name}", time, x[axis])
        tell(problem, f"w_{name}", time, x[3 + axis])
    for mode in range(4):
        tell(problem, f"eta_{mode + 1}", time, x[6 + mode])


def di_gennaro():
    rate = di_gennaro_body(np.array([[120.0, 3, 4], [3, 100, 10], [4, 10, 120]]), 1.0)
    x = np.concatenate([[0.3, 0.1, -0.2], np.zeros(11)])
    for second in range(10):
        u = np.clip(-30 * x[:3] - 60 * x[3:6], -1, 1)
        x = integrated(lambda t, x, u=u: rate(x, u), (second, second + 1), x)
    di_gennaro_tell("di-gennaro", 10, x)


def faulty_torque(since, t, u):
    """What the actuators of the study's second case give after a sample, and its disturbance."""
    given = (0.5 if since >= 10 else 1.0) * u + (0.3 + 0.05 * np.sin(t) if since >= 50 else 0.0)
    return given + 0.2e-3 * np.array(
        [
            3 * np.cos(t) + 4 * np.sin(0.3 * t) - 10,
            -1.5 * np.sin(0.2 * t) + 3 * np.cos(0.5 * t) + 15,
            3 * np.sin(t) - 8 * np.sin(0.4 * t) + 10,
        ]
    )


FAULTS = np.array([[120.0, 6, 7], [6, 100, 10], [7, 10, 120]])


def di_gennaro_faults():
    rate = di_gennaro_body(FAULTS, 1.1)
    x = np.concatenate([[0.3, 0.1, -0.2], np.zeros(11)])
    for since in range(100):
        u = np.clip(-30 * x[:3] - 60 * x[3:6], -1, 1)
        x = integrated(
            lambda t, x, since=since, u=u: rate(x, faulty_torque(since, t, u)), (since, since + 1), x
        )
        if since + 1 in (10, 40, 100):
            di_gennaro_tell("di-gennaro-faults", since + 1, x)


def di_gennaro_noise(problem, torque, runs=10, end=300):
    """The study's numbers with its white noise over some runs: mean and standard deviation."""
    rate, found = di_gennaro_body(FAULTS, 1.1), []
    for run in range(runs):
        draws, all_of = np.random.default_rng(run), []
        x = np.concatenate([[0.3, 0.1, -0.2], np.zeros(11)])
        for since in range(end):
            p = x[:3] + 8e-5 * draws.standard_normal(3)
            w = x[3:6] + 5e-5 * draws.standard_normal(3)
            u = np.clip(-30 * p - 60 * w, -1, 1)
            all_of.append([since, abs(x[:3]).max(), abs(x[3:6]).max(), *x[6:10], *u])
            step = solve_ivp(
                lambda t, x, since=since, u=u: rate(x, torque(since, t, u)),
                (since, since + 1),
                x,
                rtol=1e-8,
                atol=1e-10,
            )
            x = step.y[:, -1]
        all_of = np.array(all_of)
        late = all_of[all_of[:, 0] > 160]
        of_modes, of_torque = (late[:, 3:7] ** 2).sum(1), (late[:, 7:] ** 2).sum(1)
        peaks = [all_of[:, 2].max(), abs(all_of[:, 3:7]).max()]
        late_most = [late[:, 1].max(), late[:, 2].max()]
        found.append([*late_most, np.sqrt(of_modes.mean()), np.sqrt(of_torque.mean()), *peaks])
    names = ["p_late", "w_late", "eta_rms_late", "torque_rms_late", "w_peak", "eta_peak"]
    for name, mean, deviation in zip(names, np.mean(found, 0), np.std(found, 0), strict=True):
        tell(problem, name, end, mean)
        tell(problem, f"{name}_sd", end, deviation)


def panels():
    hub, hub_inertia, mass, inertia, arm = 750.0, 600.0, 100.0, 50.0, 1.5
    k, c = 5000.0, 75.0
    sides = [(np.array([0.5, 1.0]), 0.0), (np.array([-0.5, 1.0]), np.pi)]

    def turned(angle, v):
        return np.array(
            [np.cos(angle) * v[0] - np.sin(angle) * v[1], np.sin(angle) * v[0] + np.cos(angle) * v[1]]
        )

    def across(v):
        return np.array([-v[1], v[0]])

    def rate(_, state, force, at):
        q, v = state[:5], state[5:]
        m, f = np.zeros((5, 5)), np.zeros(5)
        m[0, 0] = m[1, 1] = hub
        m[2, 2] = hub_inertia
        push = turned(q[2], force)
        f[:2] += push
        f[2] += at[0] * force[1] - at[1] * force[0]
        for side, (hinge, facing) in enumerate(sides):
            root, out = turned(q[2], hinge), turned(q[2] + facing + q[3 + side], np.array([arm, 0.0]))
            spin = v[2] + v[3 + side]
            # Velocity of the panel's centre: J v; what of its acceleration has no v'.
            j = np.zeros((3, 5))
            j[0, 0] = j[1, 1] = 1.0
            j[:2, 2] = across(root) + across(out)
            j[:2, 3 + side] = across(out)
            j[2, 2] = j[2, 3 + side] = 1.0
            bias = -root * v[2] ** 2 - out * spin**2
            weights = np.diag([mass, mass, inertia])
            m += j.T @ weights @ j
            f -= j.T @ weights @ np.array([bias[0], bias[1], 0.0])
            f[3 + side] -= k * q[3 + side] + c * v[3 + side]
        return np.concatenate([v, np.linalg.solve(m, f)])

    pushes = [
        (0.0, 5.0, [0.2, 0.7], [0.05, 0.0]),
        (5.0, 11.0, [0.0, 0.0], [0.0, 0.0]),
        (11.0, 18.0, [0.0, 1.0], [-0.03, 0.0]),
    ]
    state, now = np.zeros(10), 0.0
    for time in (2.5, 5.0, 7.5, 11.0, 12.5):
        _, _, force, at = next(push for push in pushes if push[0] <= now < push[1])
        force, at = np.array(force), np.array(at)
        state = integrated(lambda t, x, force=force, at=at: rate(t, x, force, at), (now, time), state)
        now = time
        if time in (2.5, 7.5, 12.5):
            for index, name in enumerate(["x", "y", "theta", "theta1", "theta2"]):
                tell("panels", name, time, state[index])


def pulse():
    x, y, z = np.radians([5.0, 4.0, -6.0])
    turn = expm(np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]]))
    inertia = turn @ np.diag([1.0, 2, 3]) @ turn.T
    phi, delta, zeta, w_n = np.array([0.0, 1, 0]), np.array([0.0, 0, 1]), 0.001, 2 * np.pi * 0.05
    inverse = np.linalg.inv(inertia - np.outer(delta, delta))
    torque = acceleration = 0.1 * np.ones(3)

    def rate(_, state):
        p, w, n, v = state[:3], state[3:6], state[6], state[7]
        # J w' + delta n'' + w x (J w + delta n') = torque, n'' + delta w' + .. = -phi a.
        own = -2 * zeta * w_n * v - w_n**2 * n - phi @ acceleration
        momentum = inertia @ w + delta * v
        turning = inverse @ (torque - np.cross(w, momentum) - delta * own)
        return np.concatenate([kinematics(p, w), turning, [v, own - delta @ turning]])

    state = integrated(rate, (0, 0.5), np.zeros(8))
    names = ["p_x", "p_y", "p_z", "w_x", "w_y", "w_z", "n", "n_rate"]
    for name, value in zip(names, state, strict=True):
        tell("pulse", name, 7.5, value)
    for row in range(3):
        for column in range(3):
            tell("pulse", f"j_{'xyz'[row]}{'xyz'[column]}", 0, inertia[row, column])


def boom():
    # Pinned at 0, a mass of r beams at 1: EI v'''(1) = -r m L^2 w^2 v(1) with v = a sin + b sinh.
    r, rigidity = mpf("5.2"), mpf("5.974")
    length = mpf("3.372")

    def equation(mu):
        # v = sinh(mu) sin(mu x) + sin(mu) sinh(mu x) has no moment at the tip.
        shear = mu**3 * (-sinh(mu) * cos(mu) + sin(mu) * cosh(mu))
        return shear + r * mu**4 * 2 * sin(mu) * sinh(mu)

    for mode, guess in enumerate(["3.17", "6.30", "9.43", "12.57", "15.71"]):
        mu = findroot(equation, mpf(guess))
        tell("boom", f"mu_{mode + 1}", 0, mu)
        tell("boom", f"omega_{mode + 1}", 0, mu**2 * rigidity / length**2)


def ritz(order=20):
    """The boom's matrices: the hub's angle, and shapes with Legendre polynomials as second derivatives."""
    length, each, rigidity = mpf("3.372"), mpf("2.82"), mpf("5.974") ** 2 * mpf("2.82")
    ratio = mpf("5.2")
    shapes = [[mpf(0), mpf(1)]]
    bent = []
    before, now = [mpf(1)], [mpf(-1), mpf(2)]
    for degree in range(order):
        bent.append(before)
        shapes.append([mpf(0), mpf(0)] + [c / ((k + 1) * (k + 2)) for k, c in enumerate(before)])
        following = [mpf(0)] * (degree + 3)
        for k, c in enumerate(now):
            following[k] -= (2 * degree + 3) * c / (degree + 2)
            following[k + 1] += 2 * (2 * degree + 3) * c / (degree + 2)
        for k, c in enumerate(before):
            following[k] -= (degree + 1) * c / (degree + 2)
        before, now = now, following

    def product(a, b):
        return sum(x * y / (i + j + 1) for i, x in enumerate(a) for j, y in enumerate(b))

    size = order + 1
    mass = [[each * length**3 * (product(a, b) + ratio * sum(a) * sum(b)) for b in shapes] for a in shapes]
    stiffness = [[mpf(0)] * size for _ in range(size)]
    for index, shape in enumerate(bent):
        stiffness[index + 1][index + 1] = rigidity / length * product(shape, shape)
    return mass, stiffness


def write(name, matrix):
    with open(Path(__file__).parent / "outside" / name, "w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([repr(float(x)) for x in row] for row in matrix)


di_gennaro()
di_gennaro_faults()
di_gennaro_noise("di-gennaro-noise", faulty_torque)
di_gennaro_noise("di-gennaro-study", lambda since, t, u: faulty_torque(since + 1, since + 1, u))
panels()
pulse()
boom()
mass, stiffness = ritz()
write("boom-mass.csv", mass)
write("boom-stiffness.csv", stiffness)
