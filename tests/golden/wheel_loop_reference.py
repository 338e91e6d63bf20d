"""Golden loops of the wheel study, by NumPy and SciPy alone: the rows of `open_loops.csv`, `margins.csv` and
`disk_margins.csv` for `wheel-fast-mode` and `wheel-slow-mode`, and for these bodies with the constants fitted
to the settling times (`fitted-fast-mode`, `fitted-slow-mode`).

The body and the wheel's back-EMF are one matrix, whose exponential over a period gives the samples of angle
and rate under a held command. The law is k_p y_k + k_d (y_k - y_(k-1)), the difference by the period or raw.
Margins are crossings of the loop's response with the negative real axis and with the unit circle.

`python3 wheel_loop_reference.py` renews the rows; open_loop_reference.py and disk_margin_reference.py take
them from here.
"""

from pathlib import Path

import numpy as np
from scipy.linalg import expm
from scipy.optimize import brentq, minimize_scalar

GOLDEN = Path(__file__).parent
GAINS = (1.44, 0.21, 0.165, 0.72)
FAST = (0.2, 0.5333333333, 0.6666666667, 1.333333333)
SLOW = (0.05, 0.1333333333, 0.1666666667, 0.3333333333)
FRACTIONS = (0.0031, 0.043, 0.31, 0.89)
# Frequencies (rad/s); k'_u (rad/s²), k'_omega (1/s), T0 (s), and if the difference is divided by the period.
LOOPS = {
    "wheel-fast-mode": (FAST, 3.3e-5, 1.295e-2, 4.5, True),
    "wheel-slow-mode": (SLOW, 3.3e-5, 1.295e-2, 4.5, True),
    "fitted-fast-mode": (FAST, 5e-4, 1e-4, 0.3, False),
    "fitted-slow-mode": (SLOW, 5e-4, 1e-4, 0.3, False),
}
K_P, K_D = 7.5, 275.0


class Loop:
    """A loop that is opened at its command: u returns as L u, and the closed loop has 1 + L."""

    def __init__(self, frequencies, gain, back_emf, period, divided):
        size = 2 + 2 * len(frequencies)
        self.angle, self.rate, share = np.zeros(size), np.zeros(size), np.zeros(size)
        self.angle[0::2], self.rate[1::2] = 1.0, 1.0
        share[1::2] = (1.0, *GAINS)
        free = np.zeros((size + 1, size + 1))
        free[:size, :size] = -back_emf * np.outer(share, self.rate)
        free[:size, size] = gain * share
        for k, w in enumerate((0.0, *frequencies)):
            free[2 * k, 2 * k + 1] += 1.0
            free[2 * k + 1, 2 * k] -= w * w
        held = expm(free * period)
        self.a, self.b, self.period = held[:size, :size], held[:size, size], period
        self.k_d = K_D / period if divided else K_D
        self.states = size + 1

    def response(self, theta):
        """L, and the ratio of the rate to the angle, at the angle theta of the unit circle."""
        z = np.exp(1j * theta)
        x = np.linalg.solve(z * np.eye(len(self.a)) - self.a, self.b)
        return (self.angle @ x) * (K_P + self.k_d * (1 - 1 / z)), (self.rate @ x) / (self.angle @ x)

    def loop(self, theta):
        return self.response(theta)[0]

    def radius(self):
        """Spectral radius of the closed loop, whose last state is the sample before."""
        n = len(self.a)
        whole = np.zeros((n + 1, n + 1))
        whole[:n, :n] = self.a - np.outer(self.b, (K_P + self.k_d) * self.angle)
        whole[:n, n], whole[n, :n] = self.k_d * self.b, self.angle
        return float(np.abs(np.linalg.eigvals(whole)).max())

    def grid(self):
        """Angles up to the Nyquist frequency, close to each other about the poles of the body."""
        poles = np.abs(np.angle(np.linalg.eigvals(self.a)))
        near = [p + s * d for p in poles for d in np.geomspace(1e-9, 1.0, 3000) for s in (-1, 1)]
        theta = np.concatenate([np.geomspace(1e-5, np.pi, 20000), near])
        return np.unique(theta[(theta > 1e-6) & (theta <= np.pi)])

    def margins(self):
        """Factors of the gain below and above, and the phase (rad), that put a pole on the unit circle."""
        theta = self.grid()
        values = np.array([self.loop(t) for t in theta])
        gains, phases = [], []
        for part, of in ((values.imag, "imag"), (np.abs(values) - 1, "abs")):
            for k in np.flatnonzero(np.sign(part[1:]) != np.sign(part[:-1])):

                def level(t, of=of):
                    return self.loop(t).imag if of == "imag" else abs(self.loop(t)) - 1

                at = brentq(level, theta[k], theta[k + 1], xtol=1e-15, rtol=1e-14)
                value = self.loop(at)
                if of == "abs":
                    phases.append(abs(np.angle(-value)))
                elif value.real < 0 and abs(value.imag) < 1e-6 * abs(value.real):
                    gains.append(-1 / value.real)
        end = self.loop(np.pi).real
        if end < 0:
            gains.append(-1 / end)
        below = max((g for g in gains if g < 1), default=0.0)
        above = min((g for g in gains if g > 1), default=float("inf"))
        return float(below), float(above), float(min(phases))

    def disk(self):
        """The modulus margin 1/|S| and the disk margin 1/|S - 1/2|."""

        def largest(of):
            theta = self.grid()
            sizes = np.array([of(t) for t in theta])
            best = sizes.max()
            for k in np.argsort(sizes[1:-1])[-5:] + 1:
                bounds, options = (theta[k - 1], theta[k + 1]), {"xatol": 1e-13}
                found = minimize_scalar(lambda t: -of(t), bounds=bounds, method="bounded", options=options)
                best = max(best, -found.fun)
            return float(best)

        return (
            1 / largest(lambda t: abs(1 / (1 + self.loop(t)))),
            1 / largest(lambda t: abs(1 / (1 + self.loop(t)) - 0.5)),
        )


def open_loop_rows():
    lines = []
    for name, values in LOOPS.items():
        loop = Loop(*values)
        head = f"{loop.states},{loop.period!r},{loop.radius()!r}"
        for opened in ("command", "torque", "measurement"):
            for fraction in FRACTIONS:
                angle, ratio = loop.response(fraction * np.pi)
                # The law reads the angle alone; the measured rate returns too.
                parts = [angle, angle * ratio] if opened == "measurement" else [angle]
                numbers = " ".join(f"{float(part)!r}" for value in parts for part in (value.real, value.imag))
                lines.append(f"{name},{opened},{head},{fraction},{numbers}")
    return lines


def margin_rows():
    loops = ((name, Loop(*values)) for name, values in LOOPS.items())
    return [",".join([name, "command", *map(repr, loop.margins())]) for name, loop in loops]


def disk_rows():
    rows = []
    for name, values in LOOPS.items():
        numbers = ",".join(map(repr, Loop(*values).disk()))
        rows += [f"{name},{of},{numbers}" for of in ("command", "all")]
    return rows


def main():
    for table, rows in (
        ("open_loops", open_loop_rows()),
        ("margins", margin_rows()),
        ("disk_margins", disk_rows()),
    ):
        path = GOLDEN / f"{table}.csv"
        others = [line for line in path.read_text("utf-8").splitlines() if line.split(",")[0] not in LOOPS]
        path.write_text("\n".join([*others, *rows]) + "\n", "utf-8")


if __name__ == "__main__":
    main()
