"""Exponentials in 40 digits: argument, nearest double, and the distance of the exact value in its last place.

python3 tests/golden/decay_oracle.py > tests/golden/decay.csv     # needs mpmath
"""

import math
import random

from mpmath import mp, mpf

mp.dps = 40


def main() -> None:
    draws = random.Random(15)
    arguments = [draws.uniform(-1.0, 1.0) for _ in range(800)]
    arguments += [draws.uniform(-20.0, 0.0) for _ in range(200)]
    arguments += [draws.uniform(-708.0, 0.0) for _ in range(200)]
    arguments += [-(10.0 ** draws.uniform(-18.0, 0.0)) for _ in range(200)]
    # Beside odd multiples of ln(2)/2, where the reduction changes.
    for k in [-1021, -512, -33, -17, -16, -15, -2, -1, 0]:
        at = (k + 0.5) * math.log(2)
        arguments += [math.nextafter(at, -1000.0), at, math.nextafter(at, 1000.0)]
    print("x,nearest,rest")
    for x in arguments:
        exact = mp.exp(mpf(x))
        nearest = float(exact)
        unit = mpf(math.nextafter(nearest, math.inf)) - mpf(nearest)
        print(f"{x!r},{nearest!r},{float((exact - mpf(nearest)) / unit):.4f}")


main()
