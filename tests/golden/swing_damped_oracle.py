"""Integrals of |c + W exp(-(s + i w) t)| over [0, h] by quadrature in 30 digits, for the quadrature in lanes.

python3 tests/golden/swing_damped_oracle.py > tests/golden/swing_damped.csv     # needs mpmath
"""

import random

from mpmath import mp, mpf, quad

mp.dps = 24
# Ratios of |W| at the start to |c|: on both sides of every branch of the code.
RATIOS = [
    0.0,
    1e-6,
    0.01,
    0.05,
    0.0999,
    0.11,
    0.3,
    0.6,
    0.85,
    1.0,
    1.01,
    1.2,
    1.9,
    4.0,
    9.0,
    11.0,
    30.0,
    1e3,
    1e9,
]


def integral(c, z, s, w, h):
    def envelope(t):
        return abs(c + z * mp.exp(-mp.mpc(s, w) * t))

    # Where the phasor vanishes, beside the real times: panels as fine as it is near.
    rate = mp.mpc(s, w)
    ends = [h * mpf(k) / 100 for k in range(101)]
    if z != 0 and c != 0:
        for k in range(-40, 300):
            at = ((mp.log(-z / c) + 2j * mp.pi * k) / rate).real
            if -1 / w < at < h + 1 / w:
                ends += [at] + [at + side * mpf(2) ** -n / w for n in range(1, 26) for side in (-1, 1)]
    ends = sorted({t for t in ends if 0 <= t <= h})
    return quad(envelope, ends, maxdegree=5)


def main() -> None:
    draws = random.Random(15)
    print("c_re,c_im,re,im,decay,frequency,h,integral")
    for zeta in [1e-12, 1e-6, 1e-3, 0.005, 0.05, 0.4, 0.95]:
        for ratio in RATIOS:
            w = draws.uniform(0.3, 4.0)
            s, v = zeta * w, w * float(mp.sqrt(1 - mpf(zeta) ** 2))
            turns = draws.choice([0.05, 0.7, 3.0, 9.0, 25.0])
            size = draws.uniform(0.1, 2.0)
            c = mp.mpc(float(size), float(size * s / v)) * draws.choice([-1, 1])
            z = abs(c) * mpf(ratio) * mp.expj(draws.uniform(-3.2, 3.2))
            z = mp.mpc(float(z.real), float(z.imag))
            h = turns / v
            exact = integral(c, z, mpf(s), mpf(v), mpf(h))
            cells = [float(x) for x in (c.real, c.imag, z.real, z.imag, s, v, h, exact)]
            print(",".join(repr(x) for x in cells))


main()
