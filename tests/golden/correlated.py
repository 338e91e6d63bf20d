"""Reference of tests/machines.rs: the bench of broadband.py under broadband forces that are correlated.

White noise of the three forces is mixed by a factor of their correlation matrix; the rest is that of
broadband.py. pip install numpy scipy
"""

import broadband
import numpy as np

CORRELATION = np.array([[1, 0.6, -0.3], [0.6, 1, 0.2], [-0.3, 0.2, 1]])
LEVELS = np.array([1.0, 4.0, 0.25])
OWN = broadband.system()


def mixed(matrix):
    """The system of broadband.py with mixed noise."""
    values, vectors = np.linalg.eigh(matrix)
    factor = vectors * np.sqrt(np.maximum(values, 0))

    def system():
        a, noise, torque, sight = OWN
        return a, noise @ np.diag(np.sqrt(LEVELS)) @ factor, torque, sight

    return system


if __name__ == "__main__":
    np.set_printoptions(precision=12)
    for name, matrix in [("some", CORRELATION), ("one load", np.ones((3, 3))), ("none", np.eye(3))]:
        broadband.system = mixed(matrix)
        print(name, "at samples, over time, means over 20 ms", broadband.deviations(0.001, 0.02))
