"""Attitudes with an axis along the magnetic field, with rates and accelerations, to 40 digits.

    pip install mpmath
    python3 tests/golden/field_references.py

The field is summed in spherical coordinates from the potential, V = a sum (a/r)^(n+1) (g cos + h sin) P, and
differentiated numerically; the attitude is differentiated numerically in time. Coefficients: IGRF-14 of 2025,
read from the table in crates/spacecraft. Orbit, Sun and angle of Greenwich are those of the unit tests in
crates/control/src/law/direction_pair.rs.
"""

import re
from pathlib import Path

from mpmath import atan2, cos, diff, findroot, matrix, mp, mpf, sin, sqrt

mp.dps = 40
TABLE = Path(__file__).parents[2] / "crates/spacecraft/src/environment/igrf_14.rs"
NUMBERS = re.findall(r"\[\[([^\]]*)\], \[([^\]]*)\]\]", TABLE.read_text())
PAIRS = [[mpf(row.split(",")[5].strip().replace("_", "")) for row in pair] for pair in NUMBERS]
MU, A, E, INCLINATION, NODE, PERIGEE, M0 = [
    mpf(x) for x in ("3.986004418e14", "6.978e6", ".01", "1.7", ".4", ".3", ".2")
]


def legendre(n, m, x):
    """Return P(n, m) of x, Schmidt semi-normalised, from the finite sum of its definition."""
    total = mpf(0)
    for k in range((n - m) // 2 + 1):
        top = mp.factorial(2 * n - 2 * k)
        low = mpf(2) ** n * mp.factorial(k) * mp.factorial(n - k) * mp.factorial(n - m - 2 * k)
        total += (-1) ** k * top / low * x ** (n - m - 2 * k)
    scale = sqrt((2 - (m == 0)) * mp.factorial(n - m) / mp.factorial(n + m))
    return scale * (1 - x * x) ** (mpf(m) / 2) * total


def potential(x, y, z, degree):
    """Return the potential (nT m) in the planet's axes."""
    a, r = mpf(6371200), sqrt(x * x + y * y + z * z)
    longitude, up = atan2(y, x), z / r
    total, rows = mpf(0), iter(PAIRS)
    for n in range(1, degree + 1):
        for m in range(n + 1):
            g, h = next(rows)
            total += (
                (a / r) ** (n + 1) * (g * cos(m * longitude) + h * sin(m * longitude)) * legendre(n, m, up)
            )
    return a * total


def position(t):
    """Return the position in inertial axes."""
    mean = M0 + sqrt(MU / A**3) * t
    e = findroot(lambda e: e - E * sin(e) - mean, mean)
    x, y = A * (cos(e) - E), A * sqrt(1 - E * E) * sin(e)
    u, v = x * cos(PERIGEE) - y * sin(PERIGEE), x * sin(PERIGEE) + y * cos(PERIGEE)
    return [
        u * cos(NODE) - v * cos(INCLINATION) * sin(NODE),
        u * sin(NODE) + v * cos(INCLINATION) * cos(NODE),
        v * sin(INCLINATION),
    ]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    length = sqrt(sum(x * x for x in a))
    return [x / length for x in a]


def nadir(t):
    return unit([-x for x in position(t)])


def normal(_):
    return [sin(NODE) * sin(INCLINATION), -cos(NODE) * sin(INCLINATION), cos(INCLINATION)]


def sun(_):
    return unit([mpf(".9"), mpf(".4"), mpf(".17")])


def orbit(direction):
    """Return a direction of the local axes as a function of time."""

    def at(t):
        z, y = nadir(t), [-x for x in normal(t)]
        x = cross(y, z)
        return unit(
            [sum(d * axis[k] for d, axis in zip(direction, (x, y, z), strict=True)) for k in range(3)]
        )

    return at


def field(degree):
    """Return the direction of the field as a function of time."""

    def at(t):
        turn = mpf("1.1") + mpf("7.292115e-5") * t
        x, y, z = position(t)
        place = (cos(turn) * x + sin(turn) * y, cos(turn) * y - sin(turn) * x, z)
        own = [
            -diff(lambda *p: potential(*p, degree), place, order)
            for order in ((1, 0, 0), (0, 1, 0), (0, 0, 1))
        ]
        return unit(
            [cos(turn) * own[0] - sin(turn) * own[1], sin(turn) * own[0] + cos(turn) * own[1], own[2]]
        )

    return at


def axes(first, second):
    n = unit(cross(first, second))
    return matrix([[first[k], n[k], cross(first, n)[k]] for k in range(3)])


def attitude(pair, t):
    """Return the matrix from body to inertial axes."""
    (b1, d1), (b2, d2) = pair
    return axes(d1(t), d2(t)) * axes(unit(b1), unit(b2)).T


def rate(pair, t):
    """Return the rate in body axes by the difference of order 8."""
    h = mpf("0.5")
    weights = [mpf(4) / 5, -mpf(1) / 5, mpf(4) / 105, -mpf(1) / 280]
    change = matrix(3, 3)
    for k, weight in enumerate(weights, 1):
        change += (attitude(pair, t + k * h) - attitude(pair, t - k * h)) * (weight / h)
    spin = attitude(pair, t).T * change
    return [(spin[2, 1] - spin[1, 2]) / 2, (spin[0, 2] - spin[2, 0]) / 2, (spin[1, 0] - spin[0, 1]) / 2]


def quaternion(r):
    """Return w, x, y, z of a rotation matrix, with the largest of them by a square root."""
    trace = r[0, 0] + r[1, 1] + r[2, 2]
    squares = [trace] + [2 * r[k, k] - trace for k in range(3)]
    largest = max(range(4), key=lambda k: squares[k])
    root = sqrt(1 + squares[largest]) / 2
    skew = [r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]]
    if largest == 0:
        return [root] + [part / (4 * root) for part in skew]
    k = largest - 1
    parts = [(r[k, j] + r[j, k]) / (4 * root) if j != k else root for j in range(3)]
    return [skew[k] / (4 * root), *parts]


def acceleration(pair, t):
    h = mpf(2)
    weights = [mpf(3) / 4, -mpf(3) / 20, mpf(1) / 60]
    total = [mpf(0)] * 3
    for k, weight in enumerate(weights, 1):
        ahead, behind = rate(pair, t + k * h), rate(pair, t - k * h)
        total = [s + (a - b) * weight / h for s, a, b in zip(total, ahead, behind, strict=True)]
    return total


def main():
    z, x = [mpf(0), mpf(0), mpf(1)], [mpf(1), mpf(0), mpf(0)]
    pairs = {
        "field and Sun": ((z, field(13)), (x, sun)),
        "nadir and field of degree 1": ((z, nadir), (x, field(1))),
        "orbit [0.3, 0.1, 1] and field of degree 4": (
            (z, orbit([mpf(".3"), mpf(".1"), mpf(1)])),
            (x, field(4)),
        ),
    }
    for name, pair in pairs.items():
        for t in (600, 1500):
            q = quaternion(attitude(pair, mpf(t)))
            print(name, t)
            for values in (q, rate(pair, mpf(t)), acceleration(pair, mpf(t))):
                print("   ", ", ".join(mp.nstr(value, 13) for value in values))


if __name__ == "__main__":
    main()
