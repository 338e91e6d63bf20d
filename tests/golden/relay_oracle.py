"""Independent solution of the relay-controlled spacecraft: 40-digit arithmetic, decimal literals.

Run as `python relay_oracle.py`; writes relay-switchings-<k_t>.csv beside itself: the time of each switching
and the state of the law that begins, and for the first 120 the state of the body (y is a mode's rate over its
frequency). It shares no code with flexsc: crossings are found by sampling every 0.02 s and Newton steps.
"""

import math
import sys
from pathlib import Path

from mpmath import mp, mpf

mp.dps = 40

W = [mpf("0.44"), mpf("0.755")]
K = [mpf("0.0213"), mpf("0.0216")]
EPS, GAM = mpf("5e-4"), mpf("1e-4")
STRONG, WEAK = mpf("4e-5"), mpf("1e-6")
NEXT = {"RACC": "RBRK", "RBRK": "W+", "LACC": "LBRK", "LBRK": "W-"}
MOMENT = {
    "W0": WEAK,
    "RACC": -STRONG,
    "RBRK": STRONG,
    "W+": WEAK,
    "LACC": STRONG,
    "LBRK": -STRONG,
    "W-": -WEAK,
}


def flow(state, m, h):
    xb, vb, modes = state
    new = []
    for (x, y), w, k in zip(modes, W, K, strict=False):
        c = k * m / w**2
        cos, sin = mp.cos(w * h), mp.sin(w * h)
        new.append((c + (x - c) * cos + y * sin, y * cos - (x - c) * sin))
    return xb + h * (vb + m * h / 2), vb + m * h, new


def angle(state):
    return state[0] + sum(x for x, _ in state[2])


def rate(state):
    return state[1] + sum(w * y for w, (_, y) in zip(W, state[2], strict=False))


def fast_angle(state, m):
    """The angle as a function of h, in doubles: enough to bracket a crossing."""
    xb, vb, m = float(state[0]), float(state[1]), float(m)
    parts = [
        (float(k) * m / float(w) ** 2, float(x), float(y), float(w))
        for (x, y), w, k in zip(state[2], W, K, strict=False)
    ]

    def x(h):
        return (
            xb
            + h * (vb + m * h / 2)
            + sum(c + (p - c) * math.cos(w * h) + y * math.sin(w * h) for c, p, y, w in parts)
        )

    return x


def levels(name):
    if name == "RACC":
        return [(-1, EPS - GAM, "RBRK")]
    if name == "LACC":
        return [(1, -EPS + GAM, "LBRK")]
    return [(1, EPS, "RACC"), (-1, -EPS, "LACC")]


def crossing(state, name):
    m = MOMENT[name]
    x = fast_angle(state, m)
    h, step = 0.0, 0.02
    while True:
        h += step
        value = x(h)
        for side, level, to in levels(name):
            if side * (value - float(level)) >= 0:
                root = mpf(h)
                for _ in range(60):
                    there = flow(state, m, root)
                    move = (angle(there) - level) / rate(there)
                    root -= move
                    if abs(move) < mpf(10) ** -34:
                        return root, to
                raise RuntimeError("Newton did not converge")


def run(kt, end):
    state = (mpf("4.5e-4"), mpf("2.2e-5"), [(mpf("2.75e-6"), mpf(0)), (mpf(0), mpf(0))])
    name, t, push = "W0", mpf(0), mpf(0)
    while True:
        if name in ("RBRK", "LBRK"):
            h, to = kt * push, NEXT[name]
        else:
            h, to = crossing(state, name)
        push = h  # only a brake reads it, and a brake follows a push
        t += h
        if t > end:
            return
        state = flow(state, MOMENT[name], h)
        name = to
        yield t, name, state


def line(index, t, to, state):
    digits = [t] if index >= 120 else [t, state[0], state[1], *(part for mode in state[2] for part in mode)]
    cells = [mp.nstr(value, 20, strip_zeros=False) for value in digits]
    return ",".join([cells[0], to, *cells[1:]])


if __name__ == "__main__":
    for kt in sys.argv[1:] or ["0.31", "0.3389"]:
        lines = [line(index, *row) for index, row in enumerate(run(mpf(kt), mpf(20000)))]
        path = Path(__file__).with_name(f"relay-switchings-{kt}.csv")
        path.write_text("time_s,state,xb,vb,x1,y1,x2,y2\n" + "\n".join(lines) + "\n")
        print(path, len(lines))
