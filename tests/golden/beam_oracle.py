"""Frequencies of a hub with a beam and a tip mass, free in the plane: those of tests/calculix.rs.

    pip install mpmath
    python3 tests/golden/beam_oracle.py

The beam of fe/beam.inp, 4 m of aluminium of 0.01 by 0.02 m with 1.5 kg at its tip, is clamped 0.5 m from the
centre of a hub of 40 kg: the roots of Euler and Bernoulli's frequency equation, the hub's translation and
rotation in the conditions at the root. Bending along y sees 6 kg m² of the hub, along z 5.
"""

from mpmath import cos, cosh, det, findroot, matrix, mp, mpf, nstr, sin, sinh

mp.dps = 30
MODULUS, DENSITY, LENGTH, TIP, MASS, ARM = (mpf(x) for x in ("7e10", "2700", "4", "1.5", "40", "0.5"))
SIDES = mpf("0.01"), mpf("0.02")


def equation(inertia, thick, wide):
    """The determinant of the boundary conditions over the frequency (rad/s), scaled."""
    rigidity, each = MODULUS * wide * thick**3 / 12, DENSITY * wide * thick

    def value(w):
        k = (each * w * w / rigidity) ** mpf("0.25")

        def shape(x, order):
            c, s, ch, sh = cos(k * x), sin(k * x), cosh(k * x), sinh(k * x)
            rows = ([c, s, ch, sh], [-s, c, sh, ch], [-c, -s, ch, sh], [s, -c, sh, ch])
            return [k**order * entry for entry in rows[order]]

        y, slope, moment, shear = (shape(mpf(0), order) for order in range(4))
        hub = [MASS * w * w * (a - ARM * b) for a, b in zip(y, slope, strict=True)]
        conditions = [
            [rigidity * a - b for a, b in zip(shear, hub, strict=True)],
            [
                -rigidity * a + ARM * b - w * w * inertia * c
                for a, b, c in zip(moment, hub, slope, strict=True)
            ],
            shape(LENGTH, 2),
            [
                -rigidity * a - w * w * TIP * b
                for a, b in zip(shape(LENGTH, 3), shape(LENGTH, 0), strict=True)
            ],
        ]
        return det(matrix(conditions)) / cosh(k * LENGTH) / (rigidity * k) ** 2

    return value


def roots(value, count):
    found, w = [], mpf("0.3")
    last = value(w)
    while len(found) < count:
        above = w * mpf("1.02")
        now = value(above)
        if last * now < 0:
            found.append(findroot(value, (w, above), solver="anderson", tol=1e-20))
        w, last = above, now
    return found


thin, wide = SIDES
print("along y:", ", ".join(nstr(w, 12) for w in roots(equation(mpf(6), thin, wide), 4)))
print("along z:", ", ".join(nstr(w, 12) for w in roots(equation(mpf(5), wide, thin), 3)))
