"""LQG law of scenarios/earth-observer-lqg.toml, by NumPy and SciPy.

The program prints its `[law.state_space]`. The plant is the linear model of scenarios/earth-observer.toml
with its rigid motion and the mode of 2.07 rad/s, which torques excite most, sampled with the law's
period. Its inputs are the accelerations that the engine multiplies by the inertia; its outputs are the
estimated angles and rates. The regulator is LQR, the observer a steady Kalman filter that uses the sample
of the instant.

    python tests/golden/observer_lqg.py
"""

from pathlib import Path

import flexsc
import numpy as np
from scipy.linalg import expm, solve_discrete_are

PERIOD = 0.25  # s
# Rigid angles and rates, then displacement and rate of the second mode.
KEPT = [0, 1, 2, 3, 4, 5, 8, 9]
SCENARIO = Path(__file__).parents[2] / "scenarios" / "earth-observer.toml"
AXES = ("roll", "pitch", "yaw")


def plant(model):
    """Return A, B and C of the plant in continuous time."""
    inertia = np.linalg.inv(model.b[3:6])
    return model.a[np.ix_(KEPT, KEPT)], model.b[KEPT] @ inertia, model.c[:6, KEPT]


def sampled(a, b):
    """Return A and B for inputs held over a period."""
    order, inputs = b.shape
    whole = np.zeros((order + inputs, order + inputs))
    whole[:order] = np.hstack([a, b]) * PERIOD
    whole = expm(whole)
    return whole[:order, :order], whole[:order, order:]


def compensator(model):
    """Return A, B, C and D from the errors of angles and rates to accelerations."""
    a, b, c = plant(model)
    a, b = sampled(a, b)
    # Bryson's rule: 1e-4 rad and 1e-5 rad/s, of rigid motion or of vibration, cost as much as 1e-6 rad/s².
    seen = c.copy()
    seen[:, :6] = 0.0
    cost = np.diag([1e4**2] * 3 + [1e5**2] * 3 + [0.0, 0.0])
    cost += 1e4**2 * (seen[:3].T @ seen[:3]) + 1e5**2 * (seen[3:].T @ seen[3:])
    price = np.eye(3) * 1e6**2
    x = solve_discrete_are(a, b, cost, price)
    gain = np.linalg.solve(b.T @ x @ b + price, b.T @ x @ a)
    # Disturbing accelerations of 1e-6 rad/s² from sample to sample, and errors of the estimates.
    drive = b @ b.T * 1e-6**2
    noise = np.diag([3e-6**2] * 3 + [1e-5**2] * 3)
    p = solve_discrete_are(a.T, c.T, drive, noise)
    update = np.linalg.solve(c @ p @ c.T + noise, c @ p).T
    # The observer's state is what it expects before a sample; y is minus the error.
    kept = np.eye(len(KEPT)) - update @ c
    closed = a - b @ gain
    return closed @ kept, -closed @ update, -gain @ kept, gain @ update


def text(name, matrix):
    """Return a matrix as a key of TOML."""
    rows = ",\n".join("    [" + ", ".join(f"{entry:.6e}" for entry in row) + "]" for row in matrix)
    return f"{name} = [\n{rows},\n]"


if __name__ == "__main__":
    matrices = compensator(flexsc.Scenario.load(SCENARIO).linearise())
    names = [*AXES, *(f"{axis}_rate" for axis in AXES)]
    print(f'[law.state_space]\nperiod = {PERIOD}\ncommand = "acceleration"')
    print(f"inputs = {names}".replace("'", '"'))
    for name, matrix in zip("abcd", matrices, strict=True):
        print(text(name, matrix))
