"""Modes of three axes whose frequencies drift, by SciPy (DOP853, 1e-13) under a constant torque.

For tests/drifting_axes.rs: prints `time, mode, displacement, rate` of
q'' + 2 zeta w r q' + w² r² q = phi . M.

    python3 drifting_oracle.py > drifting_axes.csv
"""

import numpy as np
from scipy.integrate import solve_ivp

# Frequency (rad/s), damping ratio, displacement and rate at the start, phi . M of (0, 0.01, 0.02) N m.
MODES = [
    (1.0, 0.01, 2e-4, -1e-5, 0.02 * 0.04),
    (2.5, 0.004, 0.0, 3e-4, 0.01 * 0.04 - 0.02 * 0.03),
]
PERIOD, AMPLITUDE = 50.0, 0.3
RAMP = (10.0, 20.0, 0.6)


def ratio(mode, t):
    """A sinusoid of the first mode, a ramp of the second."""
    if mode == 0:
        return 1.0 + AMPLITUDE * (np.cos(2.0 * np.pi * t / PERIOD) - 1.0)
    begins, lasts, to = RAMP
    return 1.0 + (to - 1.0) * min(max((t - begins) / lasts, 0.0), 1.0)


def main():
    times = [7.3, 25.0, 41.0, 60.0]
    for mode, (w, zeta, x, v, force) in enumerate(MODES):

        def slope(t, z, w=w, zeta=zeta, force=force, mode=mode):
            wt = w * ratio(mode, t)
            return [z[1], force - 2.0 * zeta * wt * z[1] - wt * wt * z[0]]

        # From corner to corner of the ramp.
        state, now, found = np.array([x, v]), 0.0, {}
        for end in sorted({*times, 10.0, 30.0}):
            run = solve_ivp(slope, (now, end), state, method="DOP853", rtol=1e-13, atol=1e-18, max_step=0.2)
            state, now = run.y[:, -1], end
            found[end] = state
        for time in times:
            print(f"{time},{mode},{found[time][0]:.15e},{found[time][1]:.15e}")


if __name__ == "__main__":
    main()
