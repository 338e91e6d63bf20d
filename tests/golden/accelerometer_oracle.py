"""What accelerometers measure, by Newton and Euler for a hub and a mass that slides in it: accelerometer.csv.

    pip install numpy scipy
    python3 tests/golden/accelerometer_oracle.py > tests/golden/accelerometer.csv

A rigid hub of 200 kg, whose centre of mass is the origin, and 5 kg on a spring and a damper that slide along
the hub's z at (0, 2, 0). The hub spins at 0.1 rad/s about z; from 1 to 2 s a force of (0.3, 0, 1) N pushes at
(0.5, 0, 0). Unknowns are the accelerations of origin, rotation and mass in the hub's axes, of the whole
kinematics; no free mode and no centre of mass of the whole is used. Explicit Runge-Kutta of order 8, relative
tolerance 1e-12.

A line each: time, the specific force at (0.5, 0.3, 0.2) of the hub (3), and at the mass (3), in m/s^2.
"""

import csv
import sys

import numpy as np
from scipy.integrate import solve_ivp

HUB, MASS, SPIN = 200.0, 5.0, 0.1
INERTIA = np.array([[90.0, 4, -2], [4, 70, 1], [-2, 1, 60]])
OMEGA, ZETA = 1.3, 0.02
PUSHED, BENCH, ALONG = np.array([0.5, 0, 0]), np.array([0.5, 0.3, 0.2]), np.array([0.0, 0, 1])


def hat(v):
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def accelerations(x, force):
    """Of the hub's origin (3), of its rotation (3) and of the mass in the hub, in the hub's axes."""
    w, z, speed = x[:3], x[3], x[4]
    r = np.array([0, 2.0, z])
    # The mass: a - [r] w' + z'' + rest.
    rest = np.cross(w, np.cross(w, r)) + 2 * np.cross(w, ALONG * speed)
    a, b = np.zeros((7, 7)), np.zeros(7)
    of_mass = np.hstack([np.eye(3), -hat(r), ALONG[:, None]])
    a[:3, :3] = HUB * np.eye(3)
    a[:3] += MASS * of_mass
    b[:3] = force - MASS * rest
    a[3:6, 3:6] = INERTIA
    a[3:6] += MASS * hat(r) @ of_mass
    b[3:6] = np.cross(PUSHED, force) - np.cross(w, INERTIA @ w) - MASS * np.cross(r, rest)
    a[6] = ALONG @ of_mass
    b[6] = -(OMEGA**2) * z - 2 * ZETA * OMEGA * speed - ALONG @ rest
    found = np.linalg.solve(a, b)
    return found, of_mass @ found + rest


def rate(x, force):
    found, _ = accelerations(x, force)
    return np.concatenate([found[3:6], [x[4], found[6]]])


rows = csv.writer(sys.stdout, lineterminator="\n")
rows.writerow(["time", *[f"{where}_{axis}" for where in ("bench", "mass") for axis in "xyz"]])
x, now = np.array([0.0, 0, SPIN, 0, 0]), 0.0
for time in (1.0, 1.5, 2.0, 3.0, 7.0, 12.0):
    push = np.array([0.3, 0, 1.0]) if 1 <= now < 2 else np.zeros(3)
    run = solve_ivp(lambda t, x, f=push: rate(x, f), (now, time), x, method="DOP853", rtol=1e-12, atol=1e-16)
    x, now = run.y[:, -1], time
    # Of an instant at which the force changes, what follows.
    push = np.array([0.3, 0, 1.0]) if 1 <= now < 2 else np.zeros(3)
    found, at_mass = accelerations(x, push)
    w = x[:3]
    bench = found[:3] + np.cross(found[3:6], BENCH) + np.cross(w, np.cross(w, BENCH))
    rows.writerow([repr(float(v)) for v in (time, *bench, *at_mass)])
