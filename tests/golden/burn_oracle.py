"""On-times of canted thrusters for a torque and a force, by SciPy's `linprog`: burn.csv, for tests/jets.rs.

The torques (N m) are -200 times the vector part of the attitude in the run at 1.0 s and 1.5 s, which is what
its law demands; the cycle is 0.5 s, half of which the burn from 1.25 s on overlaps at first. The torque is
met first; then the missing force, along each axis, is least, and then the propellant.
"""

import numpy as np
from scipy.optimize import linprog

OFFSETS = np.array([[0.62, 0.6, -1.2], [-0.58, 0.6, -1.2], [-0.58, -0.6, -1.2], [0.62, -0.6, -1.2]])
DIRECTIONS = np.array([[-0.1, 0.1], [0.1, 0.1], [0.1, -0.1], [-0.1, -0.1]])
DIRECTIONS = np.column_stack([DIRECTIONS, np.full(4, np.sqrt(0.98))])
FORCES = 10.0 * DIRECTIONS
TORQUES = np.cross(OFFSETS, FORCES)
PERIOD = 0.5
FORCE = np.array([0.0, 0.0, 40.0])
DEMANDS = np.array(
    [
        [-0.19428975589595965, 0.09608617755948236, -0.19466272044727084],
        [-0.1892470335940314, 0.0940946988637233, -0.1900739186478512],
    ]
)


def on_times(torque: np.ndarray, overlap: float) -> np.ndarray:
    angular, impulse = torque * PERIOD, FORCE * overlap
    # The largest attainable part of the torque.
    rows = np.column_stack([TORQUES.T, -angular])
    bounds = [(0.0, PERIOD)] * 4 + [(0.0, 1.0)]
    part = linprog([0, 0, 0, 0, -1], A_eq=rows, b_eq=np.zeros(3), bounds=bounds, method="highs").x[4]
    slack = np.vstack([np.zeros((3, 6)), np.kron(np.eye(3), [1.0, -1.0])])
    rows = np.column_stack([np.vstack([TORQUES.T, FORCES.T]), slack])
    costs = np.concatenate([np.full(4, 1e-4), np.ones(6)])
    bounds = [(0.0, PERIOD)] * 4 + [(0.0, None)] * 6
    demand = np.concatenate([part * angular, impulse])
    return linprog(costs, A_eq=rows, b_eq=demand, bounds=bounds, method="highs").x[:4]


def main() -> None:
    times = [on_times(torque, overlap) for torque, overlap in zip(DEMANDS, [0.25, 0.5], strict=True)]
    np.savetxt("burn.csv", np.column_stack([DEMANDS, times]), delimiter=",", fmt="%.17g")


if __name__ == "__main__":
    main()
