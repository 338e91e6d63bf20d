"""Integrals of |c + W exp(-i w t)| over [0, h] by quadrature in 30 digits: a check of the series.

python3 tests/golden/swing_oracle.py > tests/golden/swing.csv     # needs mpmath
"""

import random

from mpmath import mp, mpf, quad

mp.dps = 30
# Ratios of the smaller to the larger of |c| and |W|: every branch of the code, and its ends.
RATIOS = [0.0, 1e-9, 0.02, 0.0999, 0.1, 0.25, 0.5, 0.75, 0.8999, 0.9, 0.95, 0.99, 0.9979, 0.998, 0.9995, 1.0]


def integral(c, re, im, w, h):
    def envelope(t):
        turned = mp.mpc(re, im) * mp.expj(-w * t)
        return mp.hypot(c + turned.real, turned.imag)

    # Panels of a quarter of a radian, and finer ones about where the envelope nearly vanishes.
    nearest = [(mp.arg(mp.mpc(re, im) * mp.sign(c)) + mp.pi * (2 * k + 1)) / w for k in range(-3, 60)]
    ends = [h * k / 400 for k in range(401)]
    for at in nearest:
        ends += [at] + [at + s * mpf(2) ** -k / w for k in range(2, 30) for s in (-1, 1)]
    ends = sorted({t for t in ends if 0 <= t <= h})
    return quad(envelope, ends)


def main():
    draws = random.Random(15)
    print("c,re,im,frequency,h,integral")
    for index, ratio in enumerate(RATIOS * 3):
        large = draws.uniform(0.5, 2.0)
        c, radius = (large, ratio * large) if index % 2 else (ratio * large, large)
        angle, w = draws.uniform(-3.0, 3.0), draws.uniform(0.2, 2.0)
        h = draws.choice([0.3, 4.0, 37.0]) * draws.uniform(0.5, 1.0)
        c *= draws.choice([-1, 1])
        numbers = [float(x) for x in (c, radius * mp.cos(angle), radius * mp.sin(angle), w, h)]
        row = [repr(x) for x in numbers] + [mp.nstr(integral(*map(mpf, numbers)), 20)]
        print(",".join(row))


if __name__ == "__main__":
    main()
