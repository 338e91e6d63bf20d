"""Golden numbers of tests/state_space.rs, by NumPy and SciPy: this program writes `state_space.toml` and
`state_space.csv`.

A body with two modes, a sampled angle without noise, and compensators by their matrices: a linear quadratic
regulator on a Kalman filter, by SciPy's Riccati equations; and a PD law with a lag in continuous time, by
SciPy's `cont2discrete`. From sample to sample the motion is SciPy's matrix exponential.
"""

import csv
from pathlib import Path

import numpy as np
from scipy.linalg import expm, solve_discrete_are
from scipy.signal import cont2discrete

INERTIA, PERIOD = 120.0, 0.5
# Frequency (rad/s), gain, damping ratio of each mode.
MODES = [(0.9, 0.5, 0.005), (2.3, 0.2, 0.0)]
START = np.array([0.02, -1e-3, 1e-3, 2e-3, -4e-4, 1e-3])
# N m, between two times (s) that are instants of the law.
DISTURBANCE, FROM, TO = 0.05, 20.0, 50.0
TIMES = [10.0, 30.0, 60.0, 120.0]
SEEN = np.array([[1.0, 0.0] * 3])
# Of the lag: gains (N m/rad, N m s/rad) and time constant (s).
K_P, K_D, LAG = 4.0, 40.0, 0.8


def held():
    """Transition of (rigid angle, rate, first mode, its rate, ...) over a period, and what a torque adds."""
    a, g = np.zeros((6, 6)), np.zeros((6, 1))
    a[0, 1] = g[1, 0] = 1.0
    for i, (w, gain, damping) in enumerate(MODES):
        x = 2 + 2 * i
        a[x, x + 1], a[x + 1, x], a[x + 1, x + 1], g[x + 1, 0] = 1.0, -w * w, -2.0 * damping * w, gain
    whole = np.zeros((7, 7))
    whole[:6, :6], whole[:6, 6:] = a * PERIOD, g * PERIOD / INERTIA
    whole = expm(whole)
    return whole[:6, :6], whole[:6, 6:]


def regulator():
    """u = -K x of a filter that reads angles: its states are the prediction of x."""
    f, g = held()
    weight = np.diag([1.0, 30.0, 1.0, 1.0, 1.0, 1.0])
    cost = 1e-5 * np.eye(1)
    riccati = solve_discrete_are(f, g, weight, cost)
    k = np.linalg.solve(g.T @ riccati @ g + cost, g.T @ riccati @ f)
    noise = 1e-6 * g @ g.T + 1e-12 * np.eye(6)
    measured = 1e-8 * np.eye(1)
    covariance = solve_discrete_are(f.T, SEEN.T, noise, measured)
    gain = covariance @ SEEN.T @ np.linalg.inv(SEEN @ covariance @ SEEN.T + measured)
    # x+ = (F - G K)(x + L (y - C x)); the error e is -y, and u = -K (x + L (y - C x)).
    kept = np.eye(6) - gain @ SEEN
    closed = f - g @ k
    return closed @ kept, -closed @ gain, -k @ kept, k @ gain


def lag():
    """k_p + k_d s/(1 + s t) of the error, in continuous time."""
    a, b = np.array([[-1.0 / LAG]]), np.array([[1.0 / LAG]])
    return a, b, np.array([[-K_D / LAG]]), np.array([[K_P + K_D / LAG]])


def run(a, b, c, d):
    f, g = held()
    z, x, out = START[:, None].copy(), np.zeros((a.shape[0], 1)), {}
    for k in range(round(TIMES[-1] / PERIOD) + 1):
        t = k * PERIOD
        if t in TIMES:
            out[t] = (SEEN @ z).item()
        e = -SEEN @ z
        u, x = c @ x + d @ e, a @ x + b @ e
        acts = DISTURBANCE if FROM <= t < TO else 0.0
        z = f @ z + g * (u + acts)
    return [out[t] for t in TIMES]


def text(matrix):
    return "[" + ", ".join("[" + ", ".join(repr(float(x)) for x in row) + "]" for row in matrix) + "]"


def write():
    here = Path(__file__)
    design = regulator()
    rows = zip("abcd", design, strict=True)
    here.with_name("state_space.toml").write_text("".join(f"{name} = {text(m)}\n" for name, m in rows))
    loops = {"regulator": design}
    for name, method in {"held": "zoh", "tustin": "bilinear"}.items():
        loops[name] = cont2discrete(lag(), PERIOD, method)[:4]
    with here.with_name("state_space.csv").open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["loop", "time_s", "angle_rad"])
        for name, matrices in loops.items():
            table.writerows([name, t, f"{x:.15e}"] for t, x in zip(TIMES, run(*matrices), strict=True))


if __name__ == "__main__":
    write()
