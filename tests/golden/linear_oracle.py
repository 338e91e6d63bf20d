"""Crests of coupled plants to 40 digits: linear/f_crests.csv.

    pip install mpmath
    python3 tests/golden/linear_oracle.py > tests/golden/linear/f_crests.csv

Plants (a) and (b) of tests/plants.rs with coefficients as doubles, from drawn states. A crest of the angle
that nothing before it exceeds has a level laid beside it, d above or below, rounded to a double. Told is the
time at which the angle first reaches the level within the horizon, half a second after the crest; empty if it
never does. The matrix exponential is mpmath's, by Taylor's series; it knows no poles.
"""

import random

from mpmath import expm, matrix, mp, mpf

mp.dps = 50
W, K = (0.44, 0.755), (0.0213, 0.0216)


def plant(dashpot):
    """The matrix of (x_r, v_r, x_1, v_1, x_2, v_2, u), with coefficients rounded to doubles."""
    a = matrix(7)
    for i in range(3):
        gain = 1.0 if i == 0 else K[i - 1]
        a[2 * i, 2 * i + 1] = 1
        for j in range(3):
            a[2 * i + 1, 2 * j + 1] = mpf(-2e-4 * gain)
        if i:
            a[2 * i + 1, 2 * i] = mpf(-W[i - 1] * W[i - 1])
        a[2 * i + 1, 6] = mpf(gain)
    if dashpot:
        for (i, j), value in {(3, 3): -0.0061, (3, 5): 0.005964, (5, 5): -0.0061, (5, 3): 0.006048}.items():
            a[i, j] = mpf(float(a[i, j]) + value)
    return a


def sight(a, x):
    """Angle, rate and acceleration."""
    v = a * x
    b = a * v
    return tuple(s[0] + s[2] + s[4] for s in (x, v, b))


def crest(a, start):
    """The first crest after a second that nothing before it reaches, and what is seen there."""
    step = mpf(1) / 20
    over = expm(a * step, method="taylor")
    x, t, best = start, mpf(0), sight(a, start)[0]
    before = sight(a, x)
    while t < 40:
        x, t = over * x, t + step
        now = sight(a, x)
        if before[1] > 0 >= now[1] and t > 1 and max(before[0], now[0]) > best + mpf("1e-7"):
            top = t
            for _ in range(8):
                y, v, b = sight(a, expm(a * top, method="taylor") * start)
                top -= v / b
            y, v, b = sight(a, expm(a * top, method="taylor") * start)
            return top, y, b
        best = max(best, before[0])
        before = now
    return None


def reached(a, start, level, top, y, b):
    """When the angle first reaches a level just below the crest."""
    t = top - mp.sqrt(2 * (y - level) / -b)
    for _ in range(60):
        now, v, _ = sight(a, expm(a * t, method="taylor") * start)
        if v == 0 or abs(now - level) < mpf(10) ** -44:
            break
        t -= (now - level) / v
    return t


def main():
    draw = random.Random(6)
    print("arc,d,level,u,x_r,v_r,x_1,v_1,x_2,v_2,horizon,trip")
    arc = 0
    while arc < 16:
        scale = 1e-5
        state = [draw.uniform(3e-4, 4e-4), draw.uniform(-1e-6, 1e-6)]
        state += [scale * draw.uniform(-3, 3) for _ in range(4)]
        u = -draw.uniform(5e-8, 3e-7)
        a = plant(arc % 2)
        start = matrix([mpf(s) for s in state] + [mpf(u)])
        found = crest(a, start)
        if found is None:
            continue
        top, y, b = found
        for d in (
            "1e-8",
            "1e-12",
            "1e-14",
            "1e-16",
            "1e-17",
            "0",
            "-1e-17",
            "-1e-16",
            "-1e-14",
            "-1e-12",
            "-1e-10",
        ):
            level = float(y + mpf(d))
            trip = mp.nstr(reached(a, start, mpf(level), top, y, b), 30) if level <= y else ""
            numbers = ",".join(repr(s) for s in state)
            print(f"{arc},{d},{level!r},{u!r},{numbers},{float(top + mpf(0.5))!r},{trip}")
        arc += 1


main()
