"""An attitude filter that knows two elastic modes, or identifies their frequencies: swinging-in.csv,
swinging-out.csv and swinging-identified.csv.

    pip install numpy scipy
    python3 tests/golden/swinging_oracle.py tests/golden

Readings are made up: a hub that turns, two modes driven by a torque that changes between samples, a gyro
whose mount the modes turn by g beyond the hub, a tracker on one that they turn by s, noise. The filter
lives at exposures, k = 4, 8, ..; what it says between is predicted from there, so that nothing is late to
it: a measurement arrives two samples after its exposure. Transitions are exponentials of the flow of one
step, the covariance that noise adds is its integral by Gauss-Legendre quadrature with 24 nodes, and torques
act through an exponential of the modes with the torque as a state.

swinging-in.csv: k, torque from 0.1 s after sample k on (3), gyro reading of the interval that ends at k
(3), tracker (4). swinging-out.csv: k, Q (4), b (3), q and q'/W of each mode (4), standard deviations of all
ten errors, NIS of the last exposure.

swinging-identified.csv: the same readings, by a filter that begins with frequencies 20 % too high and
10 % too low. The errors of ln W make twelve; the derivatives of the modes by them are complex steps
through the exponentials, and what they do to the attitude is a quadrature over the turn. After NIS follow
the two frequencies.
"""

import sys

import numpy as np
from scipy.linalg import expm

D, COUNT = 0.25, 240
W, ZETA = np.array([1.7, 5.1]), np.array([0.005, 0.01])
HUB = np.array([[0.03, -0.01, 0.004], [0.002, 0.05, -0.02]])
GYRO = np.array([[0.01, 0.02, -0.005], [0.0, 0.015, 0.01]])
MOUNT = np.array([[-0.04, 0.01, 0.02], [0.03, -0.02, 0.05]])
SV, SU, FORCE = 3e-6, 1e-8, 2e-4
TRACKER = np.diag([2.4e-5**2, 2.4e-5**2, 1.5e-4**2])
P0 = np.diag([1e-6] * 3 + [1e-10] * 3 + [4e-6, 1e-6] * 2)
# Of a filter that identifies: the frequencies it begins with, their deviation and walk (1/sqrt(s)).
GUESS, DEVIATION, WALK = np.array([1.2, 0.9]) * W, 0.15, 1e-4


def cross(v):
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def times(a, b):
    return np.array([a[0] * b[0] - a[1:] @ b[1:], *(a[0] * b[1:] + b[0] * a[1:] + np.cross(a[1:], b[1:]))])


def back(a):
    return np.array([a[0], *-a[1:]])


def turn(v):
    n = np.linalg.norm(v)
    return np.array([np.cos(n / 2), *(np.sinc(n / (2 * np.pi)) / 2 * v)])


def beyond(a, b):
    d = times(back(a), b)
    n = np.linalg.norm(d[1:])
    return 2 * np.arctan2(n, abs(d[0])) / n * d[1:] * np.sign(d[0])


def modes(w):
    """The flow of q, q'/W and the three torques, which stay."""
    a = np.zeros((7, 7), w.dtype)
    for i in range(2):
        a[2 * i, 2 * i + 1] = w[i]
        a[2 * i + 1, 2 * i] = -w[i]
        a[2 * i + 1, 2 * i + 1] = -2 * ZETA[i] * w[i]
        a[2 * i + 1, 4:] = HUB[i] / w[i]
    return a


def swung(x, first, second, w=W):
    """Through a step whose torque changes after 0.1 s."""
    for torque, lasts in ((first, 0.1), (second, D - 0.1)):
        x = (expm(modes(w) * lasts) @ np.concatenate([x, torque]))[:4]
    return x


def grown(x, first, second, w):
    """What a unit of each ln W makes of the modes after a step."""
    step = 1e-30
    return np.array([swung(x, first, second, w * np.exp(1j * step * e)).imag / step for e in np.eye(2)]).T


def follows(turned):
    """By how much the end of a turn follows a change of it."""
    nodes, weights = np.polynomial.legendre.leggauss(24)
    each = (0.5 * m * expm(-0.5 * (n + 1) * cross(turned)) for n, m in zip(nodes, weights, strict=False))
    return sum(each)


def spread(rate, w=W):
    flow = np.zeros((10, 10))
    flow[:3, :3] = -cross(rate)
    flow[:3, 3:6] = -np.eye(3)
    flow[6:, 6:] = modes(w)[:4, :4]
    for i in range(2):
        flow[:3, 7 + 2 * i] = -GYRO[i] * w[i]
    noise = np.diag([SV**2] * 3 + [SU**2] * 3 + [0, (FORCE / w[0]) ** 2, 0, (FORCE / w[1]) ** 2])
    nodes, weights = np.polynomial.legendre.leggauss(24)
    added = np.zeros((10, 10))
    for node, weight in zip(nodes, weights, strict=False):
        e = expm(flow * (0.5 * D * (node + 1)))
        added += 0.5 * D * weight * e @ noise @ e.T
    return expm(flow * D), added


class Filter:
    def __init__(self, q):
        self.q, self.b, self.x, self.p, self.nis = q, np.zeros(3), np.zeros(4), P0.copy(), 0.0

    def copy(self):
        other = Filter(self.q)
        other.b, other.x, other.p, other.nis = self.b, self.x, self.p, self.nis
        return other

    def predict(self, y, first, second):
        x = swung(self.x, first, second)
        gone = (y - self.b) * D - GYRO.T @ (x - self.x)[::2]
        transition, added = spread(gone / D)
        self.q = times(self.q, turn(gone))
        self.q = self.q / np.linalg.norm(self.q)
        self.x, self.p = x, transition @ self.p @ transition.T + added

    def learn(self, e):
        """Nothing is left to take over."""

    def correct(self, z):
        off = beyond(times(self.q, turn(MOUNT.T @ self.x[::2])), z)
        h = np.zeros((3, len(self.p)))
        h[:, :3] = np.eye(3)
        h[:, 6:10:2] = MOUNT.T
        s = h @ self.p @ h.T + TRACKER
        k = np.linalg.solve(s, h @ self.p).T
        e = k @ off
        self.nis = off @ np.linalg.solve(s, off)
        self.q = times(self.q, turn(e[:3]))
        self.b, self.x = self.b + e[3:6], self.x + e[6:10]
        self.learn(e[10:])
        keep = np.eye(len(self.p)) - k @ h
        self.p = keep @ self.p @ keep.T + k @ TRACKER @ k.T


class Identifying(Filter):
    def __init__(self, q):
        super().__init__(q)
        self.w = GUESS.copy()
        self.p = np.zeros((12, 12))
        self.p[:10, :10] = P0
        self.p[10:, 10:] = np.eye(2) * DEVIATION**2

    def copy(self):
        other = Identifying(self.q)
        other.b, other.x, other.p, other.nis, other.w = self.b, self.x, self.p, self.nis, self.w
        return other

    def predict(self, y, first, second):
        x = swung(self.x, first, second, self.w)
        by = grown(self.x, first, second, self.w)
        gone = (y - self.b) * D - GYRO.T @ (x - self.x)[::2]
        inner, noise = spread(gone / D, self.w)
        transition, added = np.eye(12), np.zeros((12, 12))
        transition[:10, :10], added[:10, :10] = inner, noise
        transition[:3, 10:] = -follows(gone) @ GYRO.T @ by[::2]
        transition[6:10, 10:] = by
        added[10:, 10:] = np.eye(2) * WALK**2 * D
        self.q = times(self.q, turn(gone))
        self.q = self.q / np.linalg.norm(self.q)
        self.x, self.p = x, transition @ self.p @ transition.T + added

    def learn(self, e):
        self.w = self.w * np.exp(e)


def readings():
    rng = np.random.default_rng(7)
    q, x, b = (
        np.array([0.8, 0.36, -0.48, 0.0]),
        np.array([2e-3, 0, -1e-3, 1e-3]),
        np.array([1e-5, -2e-5, 5e-6]),
    )
    torque = np.zeros(3)
    rows = [[0, *torque, *np.zeros(3), *q]]
    for k in range(1, COUNT + 1):
        after = np.round(0.3 * np.sin([0.11 * k, 0.07 * k + 1, 0.05 * k + 2]), 3) * (k % 3 == 0) + torque * (
            k % 3 != 0
        )
        before, torque_now = torque, np.array(rows[-1][1:4])
        y, old = x, x
        y = swung(x, before, torque_now)
        x = y + np.array([0, FORCE / W[0], 0, FORCE / W[1]]) * np.sqrt(D) * rng.standard_normal(4)
        rigid = 0.002 * np.array([np.sin(0.02 * k), np.cos(0.03 * k), np.sin(0.01 * k + 1)]) * D
        gone = rigid + HUB.T @ (x - old)[::2]
        q = times(q, turn(gone))
        b = b + SU * np.sqrt(D) * rng.standard_normal(3)
        read = (gone + GYRO.T @ (x - old)[::2]) / D + b + SV / np.sqrt(D) * rng.standard_normal(3)
        z = times(times(q, turn(MOUNT.T @ x[::2])), turn(np.sqrt(np.diag(TRACKER)) * rng.standard_normal(3)))
        torque = torque_now
        rows.append([k, *after, *read, *z])
    return rows


def main(folder):
    rows = readings()
    with open(f"{folder}/swinging-in.csv", "w") as file:
        for row in rows:
            file.write(",".join(repr(float(value)) for value in row) + "\n")
    # What a reader of the file has.
    rows = [np.array([float(repr(float(value))) for value in row]) for row in rows]
    torque, y, z = [r[1:4] for r in rows], [r[4:7] for r in rows], [r[7:11] for r in rows]
    prior = times(np.array([0.8, 0.36, -0.48, 0.0]), turn(np.array([1e-3, -5e-4, 8e-4])))
    told(f"{folder}/swinging-out.csv", Filter(prior), (torque, y, z), lambda _: [])
    told(f"{folder}/swinging-identified.csv", Identifying(prior), (torque, y, z), lambda now: now.w)


def told(path, kept, read, more):
    torque, y, z = read
    at, out = 0, []
    for k in range(1, COUNT + 1):
        if k % 4 == 2 and k > 2:
            while at < k - 2:
                at += 1
                kept.predict(y[at], torque[max(at - 2, 0)] if at > 1 else np.zeros(3), torque[at - 1])
            kept.correct(z[at])
        now = kept.copy()
        for j in range(at + 1, k + 1):
            now.predict(y[j], torque[max(j - 2, 0)] if j > 1 else np.zeros(3), torque[j - 1])
        if k % 5 == 0 or k < 12:
            out.append([k, *now.q, *now.b, *now.x, *np.sqrt(np.diag(now.p)), kept.nis, *more(now)])
    with open(path, "w") as file:
        for row in out:
            file.write(",".join(f"{value:.15e}" for value in row) + "\n")


if __name__ == "__main__":
    main(sys.argv[1])
