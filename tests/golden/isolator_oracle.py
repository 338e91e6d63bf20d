"""Lines of a line of sight under a wheel on a mount (tests/golden/isolator.toml), in physical coordinates.

Hub (translation, rotation), clamped modes of the telescope, and the wheel relative to its mount:
matrices of mass, damping and stiffness as they are written, and one complex solve for each frequency.
The law at 0.02 rad/s has no part at 50 Hz and above.

    python tests/golden/isolator_oracle.py      # prints the numbers of tests/isolators.rs
"""

import numpy as np

TURN = 2 * np.pi


def cross(v):
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


EYE, NONE = np.eye(3), np.zeros((3, 3))
# Telescope: root, centre of mass from it, modes.
ROOT, CENTRE = np.array([0, 0, 0.35]), np.array([0, 0, 0.3])
FREQUENCIES, RATIOS = TURN * np.array([62.0, 88.0, 140.0]), np.array([0.004, 0.004, 0.005])
SHIFTS = np.array([[3.1, 0, 0], [0, 2.9, 0.2], [0.2, -0.1, 2.6]])
TURNS = np.array([[0, 1.10, 0], [-1.02, 0, 0.03], [0.04, 0.01, 0.15]])
SIGHT = np.array([[0, 0.74, 0], [-0.68, 0, 0.01], [0.03, -0.1, 0.01]])
# Wheel: place, mass, moments of inertia across and along its axis y.
PLACE, MASS, ACROSS, ALONG = np.array([0.12, -0.05, -0.18]), 0.95, 9.0e-4, 1.6e-3
TRANSLATION, ROCKING, RATIO = TURN * 22.0, TURN * 30.0, 0.06

# Coordinates: hub place and rotation, modes, wheel place and its rotations about x and z.
HUB = np.zeros((6, 14))
HUB[:, :6] = np.eye(6)
WHEEL_PLACE = np.hstack([EYE, -cross(PLACE), NONE, EYE, np.zeros((3, 2))])
WHEEL_TURN = np.hstack([NONE, EYE, NONE, NONE, np.eye(3)[:, [0, 2]]])


def matrices():
    mass, damping, stiffness = (np.zeros((14, 14)) for _ in range(3))
    mass[:3, :3], mass[3:6, 3:6] = 62.0 * EYE, np.diag([4.2, 3.9, 4.8])
    body = np.hstack([EYE, -cross(ROOT + CENTRE), np.zeros((3, 8))])
    mass += 18.0 * body.T @ body
    mass[3:6, 3:6] += np.diag([0.92, 0.92, 0.31])
    root = np.block([[EYE, -cross(ROOT)], [NONE, EYE]])
    coupled = np.hstack([SHIFTS, TURNS]) @ root
    mass[6:9, :6], mass[:6, 6:9], mass[6:9, 6:9] = coupled, coupled.T, EYE
    mass += MASS * WHEEL_PLACE.T @ WHEEL_PLACE
    mass += WHEEL_TURN.T @ np.diag([ACROSS, ALONG, ACROSS]) @ WHEEL_TURN
    own = np.concatenate([FREQUENCIES, 3 * [TRANSLATION], 2 * [ROCKING]])
    ratios = np.concatenate([RATIOS, 5 * [RATIO]])
    inertia = np.array([1.0, 1.0, 1.0, MASS, MASS, MASS, ACROSS, ACROSS])
    stiffness[6:, 6:] = np.diag(inertia * own**2)
    damping[6:, 6:] = np.diag(2 * ratios * inertia * own)
    return mass, damping, stiffness


def lines(hertz, static, dynamic):
    """Amplitudes of the line of sight about x and y at a speed of the wheel."""
    w = TURN * hertz
    turning = np.array([1, 0, 0]) - 1j * np.cross([0, 1, 0], [1, 0, 0])
    load = WHEEL_PLACE.T @ (static * w**2 * turning) + WHEEL_TURN.T @ (
        dynamic * w**2 * turning * np.exp(-0.5j * np.pi)
    )
    mass, damping, stiffness = matrices()
    motion = np.linalg.solve(stiffness + 1j * w * damping - w**2 * mass, load)
    sight = np.hstack([NONE, EYE, SIGHT.T, np.zeros((3, 5))])
    return np.abs(sight[:2] @ motion)


if __name__ == "__main__":
    np.set_printoptions(precision=12)
    print("50 Hz", lines(50.0, 3.6e-6, 1.2e-7))
    for hertz in (100.0, 150.0):
        print(hertz, "Hz, force alone", lines(hertz, 3.6e-6, 0.0))
