"""Delay that all commands of PD loops about three axes tolerate together, and a mode that grows slowly.

The torque of a sample is held over the period T and acts late; its response over a period in closed
form, with 40 digits. The delay is where an eigenvalue of the loop transfer is -1: found over a dense
grid with the delay as a phase, then by Newton's method.

    python tests/golden/common_delay_oracle.py      # numbers of tests/settling_times.rs and tests/margins.rs
"""

import mpmath as mp
import numpy as np

mp.mp.dps = 40


def transfer(z, delay, inertia, gains, period, own_delay):
    """Loop transfer at z with a delay beside the loop's own."""
    late = own_delay + delay
    whole = mp.floor(late / period)
    rest = late - whole * period
    after = period - rest
    push = [after**2 / 2 + (period**2 - after**2) / 2 / z, after + rest / z]
    rate = push[1] / (z - 1)
    angle = (period * rate + push[0]) / (z - 1)
    inverse = mp.inverse(mp.matrix(inertia))
    rows = mp.matrix(3, 3)
    for i in range(3):
        for j in range(3):
            rows[i, j] = (gains[i][0] * angle + gains[i][1] * rate) * inverse[i, j] * z ** (-whole)
    return rows


def common_delay(inertia, gains, period, own_delay):
    period, own_delay = mp.mpf(period), mp.mpf(own_delay)
    starts, before = [], None
    for w in np.geomspace(1e-4, float(mp.pi / period) * 0.999, 4000):
        matrix = transfer(mp.expj(w * period), 0, inertia, gains, period, own_delay)
        values = np.sort_complex(np.linalg.eigvals(np.array(matrix.tolist(), dtype=complex)))
        values = values[np.argsort(np.abs(values))]
        if before is not None:
            for old, new in zip(before, values, strict=True):
                if (abs(old) > 1) != (abs(new) > 1):
                    lag = np.angle(-new) % (2 * np.pi)
                    starts.append((w, lag / w))
        before = values

    def off(w, delay):
        """Logarithm of the eigenvalue next to -1, over -1."""
        matrix = transfer(mp.expj(w * period), delay, inertia, gains, period, own_delay)
        values = mp.eig(matrix, left=False, right=False)
        value = min(values, key=lambda value: abs(value + 1))
        return mp.log(-value)

    found = []
    for w, delay in starts:
        x, h = [mp.mpf(w), mp.mpf(delay)], mp.mpf(10) ** -18
        for _ in range(12):
            here = off(*x)
            slopes = [(off(x[0] + h, x[1]) - here) / h, (off(x[0], x[1] + h) - here) / h]
            matrix = mp.matrix([[slope.real for slope in slopes], [slope.imag for slope in slopes]])
            change = mp.lu_solve(matrix, mp.matrix([-here.real, -here.imag]))
            x = [x[0] + change[0], x[1] + change[1]]
        found.append((x[1], x[0], delay))
    return min(found)


def slow_growth(frequency, gain, inertia, k_p, k_d, period):
    """Growth (1/s) of an undamped mode of the given gain in a PD loop on measured angle and rate."""
    w, h = mp.mpf(frequency), mp.mpf(period)
    c, s = mp.cos(w * h), mp.sin(w * h)
    k = mp.mpf(gain) / inertia
    a = mp.matrix([[1, h, 0, 0], [0, 1, 0, 0], [0, 0, c, s / w], [0, 0, -w * s, c]])
    b = mp.matrix([h**2 / 2 / inertia, h / inertia, k * (1 - c) / w**2, k * s / w])
    row = mp.matrix([[k_p, k_d, k_p, k_d]])
    values = mp.eig(a - b * row, left=False, right=False)
    return mp.log(max(abs(value) for value in values)) / h


if __name__ == "__main__":
    plain = np.diag([100, 80, 120]).tolist()
    for bandwidth, period in (("0.03", "0.1"), ("0.01", "0.1"), ("0.002", "0.01")):
        w = mp.mpf(bandwidth)
        gains = [(row[i] * w**2, mp.mpf("1.4") * row[i] * w) for i, row in enumerate(plain)]
        one = [[plain[0][0], 0, 0], [0, 1e9, 0], [0, 0, 1e9]]
        only = common_delay(one, [gains[0], (0, 0), (0, 0)], period, 0)
        print(bandwidth, period, [mp.nstr(x, 17) for x in only])
    tensor = [[100, 8, -5], [8, 80, 6], [-5, 6, 120]]
    gains = [(mp.mpf(kp), mp.mpf(kd)) for kp, kd in (("81", "126"), ("28.8", "67.2"), ("10.8", "50.4"))]
    for own in ("0", "0.2", "0.5"):
        print("coupled", own, [mp.nstr(x, 17) for x in common_delay(tensor, gains, "0.5", own)])
    print("growth", mp.nstr(slow_growth(50, "-3e-5", 100, 4, 28, "1e-3"), 12))
