"""Demands of torque and the cheapest thrusts that give them, by SciPy's HiGHS: jets.csv.

    pip install numpy scipy
    python3 tests/golden/jets_oracle.py > tests/golden/jets.csv

Minimise c'x with B x = s b and 0 <= x <= u, where s <= 1 is as large as it can be: two programmes for
`linprog`, the largest s and then the least cost. Arrangements of thrusters: twelve in pairs on a box, eight
canted at the corners of another, six that just reach all axes, and twelve of random places and directions,
with torques alone (3 rows) and with the forces balanced (6 rows). Costs are the flows of thrusters of
different specific impulses.

A line each: rows, columns, B column by column, u, c, b, then s and the cost.
"""

import numpy as np
from scipy.optimize import linprog

draws = np.random.default_rng(20)


def columns(places, directions, forces):
    torques = [np.cross(p, d) for p, d in zip(places, directions, strict=True)]
    rows = [np.concatenate([t, d]) if forces else t for t, d in zip(torques, directions, strict=True)]
    return np.array(rows).T


def box():
    places, directions = [], []
    for axis in range(3):
        for side in (-1.0, 1.0):
            for way in (-1.0, 1.0):
                place, direction = np.zeros(3), np.zeros(3)
                place[axis], direction[(axis + 1) % 3] = side * (1 + 0.1 * axis), way
                places.append(place)
                directions.append(direction)
    return places, directions


def corners():
    places, directions = [], []
    for x in (-1.0, 1.0):
        for y in (-1.0, 1.0):
            for z in (-0.7, 0.7):
                places.append(np.array([x, y, z]))
                out = np.array([0.3 * x, -0.5 * y * z, 1.0 * x * y])
                directions.append(out / np.linalg.norm(out))
    return places, directions


def six():
    places = [np.array(p, float) for p in ([0, 1, 0], [0, 1, 0], [0, 0, 1], [0, 0, 1], [1, 0, 0], [1, 0, 0])]
    directions = [
        np.array(d, float) for d in ([0, 0, 1], [0, 0, -1], [1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0])
    ]
    return places, directions


def random():
    directions = draws.standard_normal((12, 3))
    return draws.standard_normal((12, 3)), directions / np.linalg.norm(directions, axis=1)[:, None]


def case(b_matrix, most, cost, b):
    n = b_matrix.shape[1]
    left = np.hstack([b_matrix, -b[:, None]])
    zero = np.zeros(len(b))
    options = {"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10}
    bounds = [(0, u) for u in most]
    first = linprog(np.eye(n + 1)[n] * -1, A_eq=left, b_eq=zero, bounds=[*bounds, (0, 1)], options=options)
    assert first.success
    part = first.x[n] if first.x[n] < 1 - 1e-9 else 1.0
    second = linprog(cost, A_eq=b_matrix, b_eq=part * b, bounds=bounds, options=options)
    if not second.success:
        part *= 1 - 1e-12
        second = linprog(cost, A_eq=b_matrix, b_eq=part * b, bounds=bounds, options=options)
    assert second.success
    return part, second.fun


print("# rows, columns, B, u, c, b, s, cost")
for arrangement in (box, corners, six, random, random):
    places, directions = arrangement()
    for forces in (False, True) if len(places) > 8 else (False,):
        b_matrix = columns(places, directions, forces)
        n = b_matrix.shape[1]
        most, cost = np.full(n, 0.5), np.full(n, 1.0) + 0.5 * (np.arange(n) % 3)
        for size in np.geomspace(0.01, 3.0, 30):
            b = np.zeros(len(b_matrix))
            b[:3] = size * draws.standard_normal(3)
            part, least = case(b_matrix, most, cost, b)
            told = [len(b), n, *b_matrix.T.ravel(), *most, *cost, *b, part, least]
            print(",".join(repr(float(v)) for v in told))
