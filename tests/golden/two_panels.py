"""A spacecraft with two panels of point masses, for driven_oracle.py, gimbals_oracle.py
and swung_oracle.py: its data, its kinetic energy, its integration from one change of what acts to the next,
and its scenario.

The panels are lattices of point masses with two clamped modes each, shapes that are orthonormal by mass. The
data of scenarios are sums over the points. The oracles know the points alone: with the place of each as a
function of the panels' angles and the modes, the kinetic energy about the centre of mass is 1/2 z' M z with
z = (w, alpha', eta'). M(alpha, eta) is kept to first order in eta in the blocks of w and alpha', to zeroth in
those of eta', as the model has it; the first order is a difference quotient of a parabola, and so exact.
"""

import numpy as np
from scipy.integrate import solve_ivp

HUB_MASS, HUB_CENTRE = 200.0, np.array([0.05, -0.02, 0.1])
HUB_INERTIA = np.array([[90.0, 6, -4], [6, 100, 5], [-4, 5, 80]])
O2_DAMPING = [(0.9, 0.01), (3.1, 0.02), (1.0, 0.01), (2.7, 0.02)]
RATE = np.array([0.01, -0.02, 0.015])
# Of three wheels across each other, which M leaves out; one of them spins.
WHEEL_INERTIA = 0.05
WHEEL_AXIS, WHEEL_SPEED = np.array([0.0, 0, 1]), 60.0
H_WHEEL = WHEEL_INERTIA * (WHEEL_SPEED * WHEEL_AXIS + RATE)
# Duration, and the period of the rows (s).
DURATION, ROW = 40.0, 0.5
ETA = np.array([0.02, -0.01, 0.015, 0.01])
AXIS = np.array([0.0, 1, 0])


def cross(v):
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def about(axis, angle):
    a = cross(axis)
    return np.eye(3) + np.sin(angle) * a + (1 - np.cos(angle)) * a @ a


class Panel:
    def __init__(self, root, axes, seed):
        self.root, self.axes, self.axis = np.array(root), axes, AXIS
        x, y = np.meshgrid(np.linspace(-0.4, 0.6, 3), np.linspace(0.4, 3.4, 6))
        z = 0.1 + 0.05 * np.sin(3 * x + y + seed)
        self.r = np.stack([x.ravel(), y.ravel(), z.ravel()], 1)
        self.m = 1.0 + 0.3 * np.cos(np.arange(len(self.r)) + seed)
        flap = np.stack([0.1 * self.r[:, 1] ** 2, 0 * self.r[:, 0], self.r[:, 1] ** 2], 1)
        twist = np.stack(
            [0.3 * self.r[:, 1] * self.r[:, 2], 0.2 * self.r[:, 0], self.r[:, 0] * self.r[:, 1]], 1
        )
        shapes = []
        for shape in (flap, twist):
            for other in shapes:
                shape = shape - other * self.dot(shape, other)
            shapes.append(shape / np.sqrt(self.dot(shape, shape)))
        self.shapes = shapes

    def dot(self, a, b):
        return np.sum(self.m[:, None] * a * b)

    def place(self, angle, eta):
        bent = self.r + sum(e * s for e, s in zip(eta, self.shapes, strict=False))
        turned = self.axes @ about(self.axis, angle)
        return (
            self.root + bent @ turned.T,
            np.cross(self.axes @ self.axis, bent @ turned.T),
            [s @ turned.T for s in self.shapes],
        )


PANELS = [
    Panel([0.1, 0.6, 0.2], np.eye(3), 0.0),
    Panel([0, -0.6, 0.2], about(np.array([0.0, 0, 1]), np.pi), 1.0),
]
ALL = np.concatenate([p.m for p in PANELS])
MASS = HUB_MASS + ALL.sum()
O2 = np.array([w * w for w, _ in O2_DAMPING])
D = np.array([2 * z * w for w, z in O2_DAMPING])


def mass_matrix(angles, eta):
    """M of z = (w, alpha', eta') about the centre of mass, the centre c, dc/d(alpha, eta) and the places."""
    places, columns = [], []
    for k, panel in enumerate(PANELS):
        p, turn, shapes = panel.place(angles[k], eta[2 * k : 2 * k + 2])
        column = np.zeros((len(p), 3, 6), dtype=p.dtype)
        column[:, :, k] = turn
        for j, shape in enumerate(shapes):
            column[:, :, 2 + 2 * k + j] = shape
        places.append(p)
        columns.append(column)
    p, inner = np.concatenate(places), np.concatenate(columns)
    centre = (HUB_MASS * HUB_CENTRE + ALL @ p) / MASS
    column = np.zeros((len(p), 3, 9), dtype=p.dtype)
    # w x p
    column[:, 0, 1], column[:, 0, 2] = p[:, 2], -p[:, 1]
    column[:, 1, 0], column[:, 1, 2] = -p[:, 2], p[:, 0]
    column[:, 2, 0], column[:, 2, 1] = p[:, 1], -p[:, 0]
    column[:, :, 3:] = inner
    hub = np.zeros((3, 9), dtype=p.dtype)
    hub[:, :3] = -cross(HUB_CENTRE)
    mean = (HUB_MASS * hub + np.einsum("i,ijk->jk", ALL, column)) / MASS
    m = np.einsum("i,ija,ijb->ab", ALL, column, column) + HUB_MASS * hub.T @ hub - MASS * mean.T @ mean
    m[:3, :3] += HUB_INERTIA - WHEEL_INERTIA * np.eye(3)
    return m, centre, mean[:, 3:] + 0, p


def linear(angles):
    """M at eta = 0, its derivatives in the blocks of w and alpha', c and dc/d eta."""
    m0, c, mean, _ = mass_matrix(angles, np.zeros(4))
    changes = []
    for i in range(4):
        e = np.zeros(4)
        e[i] = 1.0
        d = 0.5 * (mass_matrix(angles, e)[0] - mass_matrix(angles, -e)[0])
        d[5:, :] = 0
        d[:, 5:] = 0
        changes.append(d)
    return m0, changes, c, mean[:, 2:]


def derivative(of, step=1e-3):
    """The derivative of a function of a scalar at 0, by a difference of order 6."""
    parts = [(1, 45 / 60), (2, -9 / 60), (3, 1 / 60)]
    return sum(w * (of(s * step) - of(-s * step)) for s, w in parts) / step


def integrated(rates_between, y, ends, rtol, atol):
    """The instants of the rows after the start with the states there, by DOP853.

    `rates_between(begin, end)` is y' between two neighbours of the instants 0 and `ends`, which are among
    the rows.
    """
    t, states = 0.0, []
    for end in ends:
        marks = [s for s in np.arange(ROW, DURATION + 0.1, ROW) if t < s <= end]
        rates = rates_between(t, end)
        known = solve_ivp(rates, (t, end), y, method="DOP853", rtol=rtol, atol=atol, t_eval=marks)
        assert known.success
        states += [(s, known.y[:, i]) for i, s in enumerate(marks)]
        y, t = known.y[:, -1], end
    return states


def mean_axes(m0, eta, first):
    """The turn of the hub to the mean axes, which modes at `eta` do not turn.

    The attitude of a scenario is that of the mean axes.
    M has the modes from the index `first` on.
    """
    return -np.linalg.solve(m0[:3, :3], m0[:3, first:] @ eta)


def quaternion(turn):
    """The attitude after a turn about a vector by its length."""
    angle = np.linalg.norm(turn)
    return [np.cos(0.5 * angle), *(np.sin(0.5 * angle) / angle * turn)]


def quaternion_rate(q, w):
    """How the attitude of a body changes that turns at w."""
    return 0.5 * np.array([-q[1:] @ w, *(q[0] * w + np.cross(q[1:], w))])


def written(of, name):
    return f"{name} = " + repr(of.tolist() if hasattr(of, "tolist") else of)


def spacecraft():
    """The hub in a scenario."""
    return [
        "[spacecraft]",
        written(HUB_MASS, "mass"),
        written(HUB_CENTRE, "centre"),
        written(HUB_INERTIA, "inertia"),
        written(RATE, "rate"),
        "whole_damping = true",
    ]


def wheels():
    """The wheels in a scenario."""
    return [
        "[actuator.wheels]",
        f"axes = [{WHEEL_AXIS.tolist()}, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]",
        f"inertia = {WHEEL_INERTIA}",
        f"speeds = [{WHEEL_SPEED}, 0.0, 0.0]",
        "torque = 0.1",
    ]


def appendage(k, mounted):
    """A panel in a scenario, with lines that say how it is mounted."""
    panel = PANELS[k]
    mass = panel.m.sum()
    centre = panel.m @ panel.r / mass
    arm = panel.r - centre
    inertia = sum(m * (a @ a * np.eye(3) - np.outer(a, a)) for m, a in zip(panel.m, arm, strict=True))
    lines = [
        "[[appendage]]",
        f'name = "panel {k + 1}"',
        written(float(mass), "mass"),
        written(centre, "centre"),
        written(0.5 * (inertia + inertia.T), "inertia"),
        written(panel.root, "at"),
        *mounted,
        "modes = [",
    ]
    for j, shape in enumerate(panel.shapes):
        w, z = O2_DAMPING[2 * k + j]
        t = panel.m @ shape
        n = (panel.m[:, None] * panel.r).T @ shape
        lines.append(
            f"    {{ frequency = {w}, damping = {z}, translation = {t.tolist()}, moments = {n.tolist()}, "
            f"displacement = {ETA[2 * k + j]} }},"
        )
    return [*lines, "]"]
