"""Wheels about roll and pitch beside jets about yaw, on a rigid body: an independent integration by SciPy.

`python several_oracle.py` writes several.csv, which tests/several_actuators.rs compares: attitude quaternion
[w, x, y, z], rates (rad/s), momenta of the wheels (N m s) and the on-time of the jets (s) at the end.
"""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import numpy.typing as npt
from scipy.integrate import solve_ivp

Vector = npt.NDArray[np.float64]

INERTIA = np.array([[30.0, 1.0, 0.0], [1.0, 40.0, -2.0], [0.0, -2.0, 35.0]])
K_P, K_D = 1.2, 9.0  # N m/rad, N m s/rad
PERIOD, CYCLES, CYCLE = 0.25, 20, 2.0  # s, and how many cycles of the jets
LEAST = 0.01  # s, the shortest pulse
PULSE = 0.25  # N m
SPIN = 0.02  # kg m², of each wheel; nothing drives that about yaw
START = (0.02, -0.03, 0.04)  # rad/s


def motion(_: float, state: Vector, motors: Vector, yaw: float) -> Vector:
    """Euler's equations with the momenta of the wheels, and the kinematics of the quaternion."""
    w, rate, stored = state[:4], state[4:7], state[7:9]
    a, b, c, d = w
    x, y, z = rate
    turning = 0.5 * np.array(
        [
            -b * x - c * y - d * z,
            a * x + c * z - d * y,
            a * y + d * x - b * z,
            a * z + b * y - c * x,
        ]
    )
    momentum = INERTIA @ rate + np.array([*stored, SPIN * START[2]])
    on_body = np.array([-motors[0], -motors[1], yaw]) - np.cross(rate, momentum)
    return np.concatenate([turning, np.linalg.solve(INERTIA, on_body), motors])


def main() -> None:
    rate = np.array(START)
    state = np.concatenate([[1.0, 0.0, 0.0, 0.0], rate, SPIN * rate[:2]])
    burnt = 0.0
    for cycle in range(CYCLES):
        begin = cycle * CYCLE
        on, sign = 0.0, 0.0
        for step in range(round(CYCLE / PERIOD)):
            now = begin + step * PERIOD
            error = 2.0 * state[1:4] * np.sign(state[0])
            wanted = -K_P * error - K_D * state[4:7]
            if step == 0:
                on = min(abs(wanted[2]) / PULSE * CYCLE, CYCLE)
                on, sign = (0.0 if on < LEAST else on), np.sign(wanted[2])
                burnt += on
            closes = np.clip(begin + on, now, now + PERIOD)
            for since, until, torque in ((now, closes, sign * PULSE), (closes, now + PERIOD, 0.0)):
                if until > since:
                    run = solve_ivp(
                        motion,
                        (since, until),
                        state,
                        "DOP853",
                        args=(-wanted[:2], torque),
                        rtol=1e-13,
                        atol=1e-16,
                    )
                    state = run.y[:, -1]
    with (Path(__file__).parent / "several.csv").open("w", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(["w", "x", "y", "z", "rate_x", "rate_y", "rate_z", "wheel_x", "wheel_y", "on"])
        rows.writerow([repr(float(value)) for value in (*state, burnt)])


if __name__ == "__main__":
    main()
