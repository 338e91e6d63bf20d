"""Golden numbers of tests/loops.rs, by NumPy and SciPy: `python3 tests/golden/loop_oracle.py` prints them.

The settling times within a sample come from samples of the held motion 100 times as dense.
"""

import numpy as np
from scipy.linalg import expm

GAINS = np.array([1.44, 0.21, 0.165, 0.72])
FREQUENCIES = np.array([0.3, 0.8, 1.0, 2.0])
K_P, K_D = 7.5, 275.0


def held(frequencies, back_emf, authority, period):
    system, push, felt = np.zeros((10, 10)), np.zeros(10), np.zeros(10)
    push[1], push[3::2], felt[1::2], system[0, 1] = 1.0, GAINS, 1.0, 1.0
    for i, w in enumerate(frequencies):
        system[2 + 2 * i, 3 + 2 * i], system[3 + 2 * i, 2 + 2 * i] = 1.0, -(w**2)
    system -= back_emf * np.outer(push, felt)
    whole = np.zeros((11, 11))
    whole[:10, :10], whole[:10, 10] = system * period, authority * push * period
    whole = expm(whole)
    return whole[:10, :10], whole[:10, 10]


def closed(frequency, gain, period=0.3):
    """The fitted set, the raw difference: matrix of the loop and the row of y."""
    free, forced = held(FREQUENCIES * frequency / 0.3, 1e-4, 5e-4, period)
    fed = np.zeros(10)
    fed[::2] = 1.0
    fed[2] += gain
    matrix = np.zeros((11, 11))
    matrix[:10, :10] = free - np.outer(forced, (K_P + K_D) * fed)
    matrix[:10, 10] = K_D * forced
    matrix[10, :10] = fed
    return matrix, fed


def radius(matrix):
    return abs(np.linalg.eigvals(matrix)).max()


def angles(frequency, gain, count):
    matrix, _ = closed(frequency, gain)
    state = np.zeros(11)
    state[0], state[10] = 0.06, 0.06
    out = np.empty(count)
    for k in range(count):
        out[k] = state[:10:2].sum()
        state = matrix @ state
    return out


def crossing(frequency, gain, horizon):
    """The last time at which the motion between the samples is outside 3 mrad."""
    _, fed = closed(frequency, gain)
    fine, push = held(FREQUENCIES * frequency / 0.3, 1e-4, 5e-4, 0.003)
    state, last, out = np.r_[0.06, np.zeros(9)], 0.06, 0.0
    for k in range(int(horizon / 0.3)):
        y = fed @ state
        command, last = -(K_P * y + K_D * (y - last)), y
        for i in range(100):
            if abs(state[::2].sum()) > 0.003:
                out = 0.3 * k + 0.003 * i
            state = fine @ state + push * command
    return out


def settles(frequency, gain, horizon=600.0):
    outside = np.nonzero(abs(angles(frequency, gain, int(horizon / 0.3) + 1)) > 0.003)[0]
    return 0.3 * outside[-1]


def late(frequency, period):
    """The exact rate, one sample late, back-EMF 0.02 1/s, authority 1e-4; the first mode alone changes."""
    free, forced = held(np.r_[frequency, FREQUENCIES[1:]], 0.02, 1e-4, period)
    fed = np.tile([K_P, K_D], 5)
    matrix = np.zeros((11, 11))
    matrix[:10, :10], matrix[:10, 10], matrix[10, :10] = free, forced, -fed
    return radius(matrix)


if __name__ == "__main__":
    for w, gain in [(0.3, 0), (0.3, 1.2), (0.2, 0), (0.1, 0), (0.05, 0), (0.1, 1.2), (0.1, -0.5)]:
        x = angles(w, gain, 6000)[[100, 200, 400, 600]]
        print(f"w {w} gain {gain}: radius {radius(closed(w, gain)[0]):.10f}, x {x}")
        print(f"    settles in {settles(w, gain, 2000):.1f} s")
    for w in (0.15, 0.12):
        print(f"w {w}: {settles(w, 0):.1f} s")
    print("watched for less:", settles(0.05, 0, 1500), settles(0.1, 1.2, 600))
    print("between the samples:", crossing(0.2, 0, 400), crossing(0.05, 0, 1500), crossing(0.05, 0, 2000))
    grid = np.round(np.arange(-2.0, 6.001, 0.05), 2)
    for w in (0.1, 0.15, 0.2, 0.25, 0.3, 0.35):
        does = [g for g in grid if settles(w, g) <= 200.0 and radius(closed(w, g)[0]) < 1.0]
        runs = np.split(does, np.nonzero(np.diff(does) > 0.051)[0] + 1)
        longest = max(runs, key=len)
        print(f"w {w}: gains", (longest[0], longest[-1]) if len(longest) else None)
    band = [w for w in np.arange(0.05, 0.2001, 0.005) if late(w, 14.0) >= 1.0]
    print(f"unstable: {band[0]:.3f} to {band[-1]:.3f}, {len(band)} of the grid")
    for w, scaled in [(0.05, 1), (0.1, 1), (0.15, 1), (0.2, 1), (0.3, 1), (0.1, 0)]:
        modes = FREQUENCIES * w / 0.3 if scaled else np.r_[w, FREQUENCIES[1:]]
        for n in range(1, 60):
            free, forced = held(modes, 1e-4, 5e-4, 0.05 * n)
            fed = np.tile([1.0, 0.0], 5)
            matrix = np.zeros((11, 11))
            matrix[:10, :10] = free - np.outer(forced, (K_P + K_D) * fed)
            matrix[:10, 10], matrix[10, :10] = K_D * forced, fed
            if radius(matrix) >= 1.0:
                print(f"w {w}, {'all' if scaled else 'first alone'}: stable up to {0.05 * (n - 1):.2f} s")
                break
