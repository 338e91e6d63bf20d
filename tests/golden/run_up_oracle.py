"""A wheel that runs up through a panel's mode, integrated by SciPy: turning/run-up.csv.

    pip install numpy scipy
    python3 tests/golden/run_up_oracle.py > tests/golden/turning/run-up.csv

The reference spacecraft of craft_oracle.py with its four wheels. The first is out of balance, 7.2e-9 kg m
and 3.0e-10 kg m^2, at (.3, .3, -.4); it speeds up by 1 rad/s^2 from 40 rad/s. The wheels' momenta cancel and
so do their torques, so that the body moves by the imbalance alone, by 1e-9 rad, and linear equations do:
those of 6 + 8 coordinates, translation and rotation of the hub and the clamped modes, with the full mass
matrix. Free modes and the reduction about the centre of mass are not used. (Of 1000 times as much, the
wheel's speed sways by 1e-8 of itself, and what that makes of the torque's mean is seen after a second.)
Explicit Runge-Kutta of order 8, relative tolerance 1e-12.

A line each: time, the hub's rate (3), the speed of the wheel.

turning/f.csv, steady amplitudes of the rate over the speed of that wheel, is not made here: it is from the
full 6 + 8 problem and from free modes, which agree to 1.8e-12. turning/e.csv, a slew by wheels with friction,
is from the two codes of turning_oracle.py.
"""

import numpy as np
from scipy.integrate import solve_ivp


def cross(v):
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def about_y(degrees):
    a = np.radians(degrees)
    return np.array([[np.cos(a), 0, np.sin(a)], [0, 1, 0], [-np.sin(a), 0, np.cos(a)]])


HUB_MASS, HUB_CENTRE = 600.0, np.array([0.05, -0.02, 0.10])
HUB_INERTIA = np.array([[250.0, 6, -4], [6, 300, 5], [-4, 5, 220]])
PANEL_MASS, PANEL_CENTRE = 30.0, np.array([0, 2.5, 0])
PANEL_INERTIA = np.diag([62.5, 5.625, 68.125])
TRANSLATION = np.array([[0, 0, 0, 4.2887], [0, 0, 0, 0], [4.2887, 0, 2.3767, 0]])
ROTATION = np.array([[15.577, 0, 2.4866, 0], [0, 2.1353, 0, 0], [0, 0, 0, -15.577]])
CLAMPED = np.array([1.10, 4.30, 6.90, 48.0, 1.13, 4.36, 7.05, 50.0])
ZETA, SPIN = 0.005, 0.04
PANELS = [
    (np.array([0, 1, 0.2]), about_y(25)),
    (np.array([0, -1, 0.2]), np.diag([-1.0, -1, 1]) @ about_y(-25)),
]
STATIC, DYNAMIC, PLACE = 7.2e-9, 3.0e-10, np.array([0.3, 0.3, -0.4])

b = np.radians(35)
AXES = [
    np.array([np.cos(b) * np.cos(g), np.cos(b) * np.sin(g), np.sin(b)])
    for g in np.radians([45, 135, 225, 315])
]
axis = AXES[0]
e1 = np.cross([0, 0, 1], axis)
e1 /= np.linalg.norm(e1)
e2 = np.cross(axis, e1)

# The mass matrix about the origin of the hub.
mass = HUB_MASS + 2 * PANEL_MASS
static = HUB_MASS * HUB_CENTRE
inertia = HUB_INERTIA - HUB_MASS * cross(HUB_CENTRE) @ cross(HUB_CENTRE)
inertia -= sum(SPIN * np.outer(a, a) for a in AXES)
dt, dr = np.zeros((3, 8)), np.zeros((3, 8))
for panel, (root, turn) in enumerate(PANELS):
    at = root + turn @ PANEL_CENTRE
    static = static + PANEL_MASS * at
    inertia = inertia + turn @ PANEL_INERTIA @ turn.T - PANEL_MASS * cross(at) @ cross(at)
    t, r = turn @ TRANSLATION, turn @ ROTATION
    dt[:, 4 * panel : 4 * panel + 4] = t
    dr[:, 4 * panel : 4 * panel + 4] = r + cross(root) @ t
full = np.block(
    [[mass * np.eye(3), -cross(static), dt], [cross(static), inertia, dr], [dt.T, dr.T, np.eye(8)]]
)
solved = np.linalg.inv(full)


def rate(_, x):
    v, momentum, angle = x[:14], x[22], x[23]
    eta = x[14:22]
    speed = momentum / SPIN - axis @ v[3:6]
    c, s = np.cos(angle), np.sin(angle)
    radial = (e1 * c + e2 * s) * speed**2
    force, torque = STATIC * radial, DYNAMIC * radial
    push = np.concatenate(
        [force, np.cross(PLACE, force) + torque, -(CLAMPED**2) * eta - 2 * ZETA * CLAMPED * v[6:]]
    )
    return np.concatenate([solved @ push, v[6:], [SPIN * 1.0, speed]])


times = np.arange(1, 81) * 0.25
x0 = np.zeros(24)
x0[22] = SPIN * 40.0
solution = solve_ivp(rate, (0, 20), x0, method="DOP853", t_eval=times, rtol=1e-12, atol=1e-22, max_step=2e-3)
for t, x in zip(solution.t, solution.y.T, strict=True):
    print(",".join([f"{t:g}", *(f"{w:.10e}" for w in x[3:6]), f"{x[22] / SPIN - axis @ x[3:6]:.12f}"]))
