"""The free modes of the reference spacecraft to 40 digits: turning/modes.csv.

    pip install mpmath
    python3 tests/golden/turning_oracle.py > tests/golden/turning/modes.csv

A hub with four wheels and two panels of four clamped modes each, whose data are the decimals below. About
the centre of mass the mass matrix is [[J, delta], [delta', E]], with E = 1 - dt' dt/m of the hub's
translation; eliminating the rotation leaves S = E - delta' J^-1 delta, and O^2 y = W^2 S y are the free
modes. A line each: J by rows; then of each mode W, phi (3), the rotation of the tracker's bench beyond the
hub's (3), the modal force of jet 1 beside what its torque gives, J1 by rows (9) and its row of the damping
matrix (8).

turning/b.csv, c.csv, c2.csv, d.csv and e.csv are not made here. They come from two codes that share nothing:
free modes and the total momentum by Gauss-Legendre steps, and clamped modes and the hub's rate by an explicit
method of order 8 with relative tolerance 2e-14, which agree as far as tests/turning.rs asks. Pulses of 2 s
from rest (b), tumbling without and with first moments (c and c2), and a slew by wheels without and with
friction (d and e).
"""

from mpmath import cos, diag, eigsy, matrix, mp, mpf, pi, sin, sqrt, zeros

mp.dps = 40


def m(rows):
    return matrix([[mpf(x) for x in row] for row in rows])


def cross(v):
    return matrix([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def about_y(degrees):
    a = mpf(degrees) * pi / 180
    return matrix([[cos(a), 0, sin(a)], [0, 1, 0], [-sin(a), 0, cos(a)]])


def column(of, i):
    return matrix([of[0, i], of[1, i], of[2, i]])


one = diag([mpf(1)] * 3)
hub_mass, hub_centre = mpf(600), m([["0.05"], ["-0.02"], ["0.1"]])
hub_inertia = m([[250, 6, -4], [6, 300, 5], [-4, 5, 220]])
panel_mass, panel_centre = mpf(30), m([[0], ["2.5"], [0]])
panel_inertia = m([["62.5", 0, 0], [0, "5.625", 0], [0, 0, "68.125"]])
translation = m([[0, 0, 0, "4.2887"], [0, 0, 0, 0], ["4.2887", 0, "2.3767", 0]])
rotation = m([["15.577", 0, "2.4866", 0], [0, "2.1353", 0, 0], [0, 0, 0, "-15.577"]])
clamped = [mpf(w) for w in ("1.10", "4.30", "6.90", "48.0", "1.13", "4.36", "7.05", "50.0")]
zeta, spin = mpf("0.005"), mpf("0.04")
half_turn = m([[-1, 0, 0], [0, -1, 0], [0, 0, 1]])
panels = [(m([[0], [1], ["0.2"]]), about_y(25)), (m([[0], [-1], ["0.2"]]), half_turn * about_y(-25))]
bench = zeros(3, 8)
for row, at, value in ((0, 0, "2e-4"), (0, 2, "1e-4"), (1, 1, "3e-4"), (1, 5, "1e-4"), (2, 3, "5e-4")):
    bench[row, at] = mpf(value)

mass = hub_mass + 2 * panel_mass
static = hub_mass * hub_centre
for root, turn in panels:
    static += panel_mass * (root + turn * panel_centre)
centre = static / mass


def parallel(kg, arm):
    return -kg * cross(arm) * cross(arm)


inertia = hub_inertia + parallel(hub_mass, hub_centre - centre)
dt, first = zeros(3, 8), []
for p, (root, turn) in enumerate(panels):
    inertia += turn * panel_inertia * turn.T + parallel(panel_mass, root + turn * panel_centre - centre)
    for i in range(4):
        t, r = column(translation, i), column(rotation, i)
        # A thin panel that stretches along y.
        n = matrix([[0, 0, -r[1]], [-r[2], 0, r[0]], [0, 0, 0]])
        t = turn * t
        for k in range(3):
            dt[k, 4 * p + i] = t[k]
        first.append(turn * n * turn.T + (root - centre) * t.T)
for k in range(4):
    b, g = 35 * pi / 180, (45 + 90 * k) * pi / 180
    axis = matrix([cos(b) * cos(g), cos(b) * sin(g), sin(b)])
    inertia -= spin * axis * axis.T

delta = zeros(3, 8)
for i, n in enumerate(first):
    for k in range(3):
        a, b = (k + 1) % 3, (k + 2) % 3
        delta[k, i] = n[a, b] - n[b, a]
moments = [2 * (n[0, 0] + n[1, 1] + n[2, 2]) * one - n - n.T for n in first]
inverse = inertia**-1
left = diag([mpf(1)] * 8) - dt.T * dt / mass - delta.T * inverse * delta
slow = diag([1 / w for w in clamped])
values, vectors = eigsy(slow * left * slow)
order = sorted(range(8), key=lambda i: -values[i])
modes, frequencies = zeros(8, 8), []
for k, i in enumerate(order):
    w = 1 / sqrt(values[i])
    y = slow * vectors[:, i] * w
    largest = max(range(8), key=lambda j: abs(y[j]))
    if y[largest] < 0:
        y = -y
    frequencies.append(w)
    for j in range(8):
        modes[j, k] = y[j]
hub = -inverse * delta * modes
damping = modes.T * diag([2 * zeta * w for w in clamped]) * modes
seen = bench * modes
jet = m([[0], [0], [5]])
force = -modes.T * dt.T * jet / mass


def line(numbers):
    print(",".join(mp.nstr(x, 20, min_fixed=0, max_fixed=0) for x in numbers))


line([inertia[i, j] for i in range(3) for j in range(3)])
for k in range(8):
    changed = zeros(3, 3)
    for i in range(8):
        changed += modes[i, k] * moments[i]
    row = [frequencies[k]] + [hub[a, k] for a in range(3)] + [seen[a, k] for a in range(3)] + [force[k]]
    line(row + [changed[i, j] for i in range(3) for j in range(3)] + [damping[k, j] for j in range(8)])
