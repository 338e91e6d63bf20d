"""Reference of tests/optics.rs: the line of sight of three optics under loads on a wheel unit at 100 Hz.

A complex solution in physical coordinates: hub, clamped modes of the telescope, rigid wheel unit, and a
soft loop on the hub's rotation and place. The wheel turns
at 50 Hz. pip install numpy
"""

import numpy as np


def across(v):
    """The matrix of the product v x."""
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def rigid(at):
    """The displacement of a place and the rotation, over displacement and rotation of the hub."""
    return np.block([[np.eye(3), -across(at)], [np.zeros((3, 3)), np.eye(3)]])


MODES = 2 * np.pi * np.array([62.0, 88.0, 140.0])
DAMPING = np.array([0.004, 0.004, 0.005])
SHAPES = np.array(
    [[3.1, 0, 0, 0, 1.10, 0], [0, 2.9, 0.2, -1.02, 0, 0.03], [0.2, -0.1, 2.6, 0.04, 0.01, 0.15]]
)
JOINT = np.array([0, 0, 0.35])
WHEEL = np.array([0.12, -0.05, -0.18])
# Place from the joint, translations, rotations by mode, and rows of rotation and translation about x and y.
OPTICS = [
    (
        [0, 0, 0.05],
        [[0.020, 0, 0], [0, 0.018, 0.002], [0.002, 0, 0.04]],
        [[0, 0.12, 0], [-0.11, 0, 0], [0, 0.02, 0.005]],
        [[2, 0, 0], [0, 2, 0]],
        [[0, -1.9, 0], [1.9, 0, 0]],
    ),
    (
        [0, 0, 0.60],
        [[0.31, 0, 0], [0, 0.29, 0.01], [-0.03, 0.02, 0.28]],
        [[0, 0.74, 0], [-0.68, 0, 0.01], [0.03, -0.1, 0.01]],
        [[-0.35, 0, 0], [0, -0.35, 0]],
        [[0, 1.6, 0], [-1.6, 0, 0]],
    ),
    (
        [0.04, 0, -0.08],
        [[0.005, 0, 0], [0, 0.004, 0], [0, 0, 0.006]],
        [[0, 0.02, 0], [-0.02, 0, 0], [0.01, 0, 0]],
        np.zeros((2, 3)),
        [[0, 0.3, 0], [-0.3, 0, 0]],
    ),
]


def mass(m, inertia, at):
    """The mass matrix of a rigid part about the hub's centre."""
    there = rigid(at)
    return there.T @ np.block([[m * np.eye(3), np.zeros((3, 3))], [np.zeros((3, 3)), inertia]]) @ there


HUB, CARRIED = np.diag([4.2, 3.9, 4.8]), np.diag([9e-4, 1.6e-3, 9e-4])


def bench():
    """The mass, damping and stiffness of the free body, and the loads of the wheel unit and the line of sight over its motion."""
    m, d, k = (np.zeros((9, 9)) for _ in range(3))
    m[:6, :6] = mass(62.0, HUB, np.zeros(3)) + mass(0.95, CARRIED, WHEEL)
    m[:6, :6] += mass(18.0, np.diag([0.92, 0.92, 0.31]), JOINT + np.array([0, 0, 0.30]))
    m[6:, :6] = SHAPES @ rigid(JOINT)
    m[:6, 6:] = m[6:, :6].T
    m[6:, 6:] = np.eye(3)
    k[6:, 6:], d[6:, 6:] = np.diag(MODES**2), np.diag(2 * DAMPING * MODES)
    sight = np.zeros((2, 9))
    for at, shift, turn, by_rotation, by_translation in OPTICS:
        rows = np.hstack([rigid(JOINT + np.array(at)), np.hstack([np.array(shift), np.array(turn)]).T])
        sight += np.hstack([np.array(by_translation), np.array(by_rotation)]) @ rows
    return m, d, k, np.vstack([rigid(WHEEL).T, np.zeros((3, 6))]), sight


def answers(hertz):
    """The sizes of the line of sight about x and y for forces along x and z, and torques about x and z."""
    w = 2 * np.pi * hertz
    m, d, k, loads, sight = bench()
    loop = 2 * np.pi * 0.05
    k[3:6, 3:6], d[3:6, 3:6] = HUB * loop**2, 1.4 * loop * HUB
    hold = 2 * np.pi * 0.02
    k[:3, :3], d[:3, :3] = 62.0 * hold**2 * np.eye(3), 1.4 * 62.0 * hold * np.eye(3)
    d[3:6, 3:6] -= across(np.array([0, 1.6e-3 * 2 * np.pi * 50, 0]))
    return np.abs(sight @ np.linalg.solve(k + 1j * w * d - w * w * m, loads))[:, [0, 2, 3, 5]]


if __name__ == "__main__":
    np.set_printoptions(precision=12)
    print(answers(100.0))
