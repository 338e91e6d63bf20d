"""Golden numbers of tests/craft.rs, by mpmath in 50 digits: this program writes `craft.csv`.

The reference spacecraft: a hub, two equal panels whose modes are given clamped, four wheels. Its free modes
are those of the whole problem K x = W^2 M x with x = (velocity of O, rate of the hub, clamped modes), which
has six rigid modes and knows no centre of mass: not the way of the program. The numbers are of wheels that
turn freely ("open") and of locked ones.
"""

import csv
from pathlib import Path

import mpmath as mp

mp.mp.dps = 50
F = mp.mpf

HUB = 600, ["0.05", "-0.02", "0.10"], [[250, 6, -4], [6, 300, 5], [-4, 5, 220]]
# Of both panels: x along the chord, y outwards, z normal.
MASS, CENTRE, INERTIA = 30, [0, "2.5", 0], ["62.5", "5.625", "68.125"]
TRANSLATION = [[0, 0, "4.2887"], [0, 0, 0], [0, 0, "2.3767"], ["4.2887", 0, 0]]
ROTATION = [["15.577", 0, 0], [0, "2.1353", 0], ["2.4866", 0, 0], [0, 0, "-15.577"]]
PANELS = [([0, 1, "0.2"], 0, 25), ([0, -1, "0.2"], 180, -25)]
FREQUENCIES = ["1.10", "4.30", "6.90", "48.0", "1.13", "4.36", "7.05", "50.0"]
DAMPING = F("0.005")
WHEEL, CANT = F("0.04"), 35
# A point of the hub, and one at the tip of the first panel with its displacement in the panel's modes.
HUB_POINT, TIP = ["0.8", "0.5", 0], ["0.3", "5", 0]
TIP_SHAPES = [[0, 0, "0.7"], [0, 0, "-0.1"], [0, 0, "-0.65"], ["0.7", 0, 0]]
TIP_ROTATIONS = [["0.19", 0, 0], [0, "0.4", 0], ["-0.6", 0, 0], [0, 0, "-0.19"]]


def vector(values):
    return mp.matrix([F(value) for value in values])


def cross(a):
    return mp.matrix([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


def turn(axis, degrees):
    c, s = mp.cos(mp.radians(degrees)), mp.sin(mp.radians(degrees))
    if axis == "y":
        return mp.matrix([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    return mp.matrix([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def plate(rotation):
    """First moments of a thin plate in the plane z = 0 that stretches along y."""
    x, y, z = rotation
    return mp.matrix([[0, 0, -y], [-z, 0, x], [0, 0, 0]])


def spacecraft(locked):
    hub, centre = F(HUB[0]), vector(HUB[1])
    mass, static = hub, hub * centre
    tensor = mp.matrix(HUB[2]) - hub * cross(centre) ** 2
    if not locked:
        for degrees in (45, 135, 225, 315):
            b, g = mp.radians(CANT), mp.radians(degrees)
            axis = mp.matrix([mp.cos(b) * mp.cos(g), mp.cos(b) * mp.sin(g), mp.sin(b)])
            tensor -= WHEEL * axis * axis.T
    columns, moments = [], []
    for root, about_z, about_y in PANELS:
        c, root = turn("z", about_z) * turn("y", about_y), vector(root)
        at = root + c * vector(CENTRE)
        mass, static = mass + MASS, static + MASS * at
        tensor += c * mp.diag([F(value) for value in INERTIA]) * c.T - MASS * cross(at) ** 2
        for t, r in zip(TRANSLATION, ROTATION, strict=True):
            t, r = c * vector(t), vector(r)
            columns.append((t, c * r + cross(root) * t))
            moments.append(c * plate(r) * c.T + root * t.T)
    n = len(columns)
    whole = mp.zeros(6 + n)
    whole[0:3, 0:3], whole[3:6, 3:6] = mass * mp.eye(3), tensor
    whole[0:3, 3:6], whole[3:6, 0:3] = -cross(static), cross(static)
    for i, (t, r) in enumerate(columns):
        whole[6 + i, 6 + i] = 1
        for k in range(3):
            whole[k, 6 + i] = whole[6 + i, k] = t[k]
            whole[3 + k, 6 + i] = whole[6 + i, 3 + k] = r[k]
    about = [moment - (static / mass) * t.T for moment, (t, _) in zip(moments, columns, strict=True)]
    return mass, static / mass, tensor + mass * cross(static / mass) ** 2, whole, about


def modes(locked):
    mass, centre, tensor, whole, moments = spacecraft(locked)
    stiffness = mp.diag([F(0)] * 6 + [F(w) ** 2 for w in FREQUENCIES])
    inverse = mp.inverse(mp.cholesky(whole))
    squares, vectors = mp.eigsy(inverse * stiffness * inverse.T)
    free = []
    for k in range(6, 6 + len(FREQUENCIES)):
        x = inverse.T * vectors[:, k]
        largest = max(x[6:], key=abs)
        free.append((mp.sqrt(squares[k]), x * mp.sign(largest)))
    order = len(free)

    def shared(x, y):
        return sum(x[6 + i] * F(w) * y[6 + i] for i, w in enumerate(FREQUENCIES))

    damping = [[2 * DAMPING * shared(x, y) for _, y in free] for _, x in free]
    kappa = max(
        abs(damping[i][j]) * max(free[i][0], free[j][0]) / abs(free[i][0] ** 2 - free[j][0] ** 2)
        for i in range(order)
        for j in range(order)
        if i != j
    )
    root, about_z, about_y = PANELS[0]
    c = turn("z", about_z) * turn("y", about_y)
    tip = vector(root) + c * vector(TIP)
    rows = []
    for i, (w, x) in enumerate(free):
        v, rate, y = x[0:3], x[3:6], x[6:]
        first = mp.zeros(3)
        for value, moment in zip(y, moments, strict=True):
            trace = moment[0, 0] + moment[1, 1] + moment[2, 2]
            first += value * (2 * trace * mp.eye(3) - moment - moment.T)
        hub = v + cross(rate) * vector(HUB_POINT)
        end, turned = v + cross(rate) * tip, mp.matrix(rate)
        for value, shape, rotation in zip(y, TIP_SHAPES, TIP_ROTATIONS, strict=False):
            end += value * (c * vector(shape))
            turned += value * (c * vector(rotation))
        rows.append([w, *rate, *first, damping[i][i] / (2 * w), *hub, *end, *turned, kappa])
    return rows, mass, centre, tensor


def main():
    header = ["wheels", "mode", "frequency", "phi_x", "phi_y", "phi_z"]
    header += [f"j_{row}{column}" for row in "xyz" for column in "xyz"] + ["damping"]
    header += [f"{name}_{axis}" for name in ("hub", "tip", "tip_turn") for axis in "xyz"] + ["kappa"]
    with Path(__file__).with_name("craft.csv").open("w", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(header)
        for name, locked in (("open", False), ("locked", True)):
            found, mass, centre, tensor = modes(locked)
            print(name, mp.nstr(mass, 16), mp.nstr(centre.T, 16), mp.nstr(tensor, 16))
            for i, row in enumerate(found):
                rows.writerow([name, i, *(mp.nstr(value, 20, min_fixed=0, max_fixed=0) for value in row)])


if __name__ == "__main__":
    main()
