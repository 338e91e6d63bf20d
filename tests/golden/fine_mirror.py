"""Reference of tests/fine_mirror.rs and crates/analysis/src/fine_mirror.rs: a mirror and its guidance sensor.

The mirror's motion over a period by the matrix exponential, means by Gauss-Legendre quadrature, and the noise
by an integral over the angles of the unit circle. pip install numpy scipy
"""

import numpy as np
from scipy.integrate import quad
from scipy.linalg import expm
from scipy.optimize import brentq

T, GAIN, NOISE = 1e-3, 0.25, 2e-8
FREQUENCY, DAMPING = 2 * np.pi * 300, 0.6
# Angle, rate and held command.
RATES = np.array([[0, 1, 0], [-(FREQUENCY**2), -2 * DAMPING * FREQUENCY, FREQUENCY**2], [0, 0, 0]])
X, WEIGHTS = np.polynomial.legendre.leggauss(24)
TIMES, WEIGHTS = (X + 1) / 2 * T, WEIGHTS / 2
FLOWS = [expm(RATES * t) for t in TIMES]
FLOW = expm(RATES * T)


def loop(w):
    """The line at w, the rms of the error, and the mean square of the mirror's angle under noise of 1."""
    z = np.exp(1j * w * T)
    start = np.linalg.solve(z * np.eye(2) - FLOW[:2, :2], FLOW[:2, 2].astype(complex))
    angle = np.array([(flow[:2, :2] @ start + flow[:2, 2])[0] for flow in FLOWS])
    mean = (z - 1) / (1j * w * T) if w else 1.0
    below = z * z - z + GAIN * (WEIGHTS * angle).sum()
    sine = np.exp(1j * w * TIMES)
    command = GAIN * mean / below
    error = sine - command * angle
    line = (WEIGHTS * error / sine).sum()
    noise = (WEIGHTS * abs(GAIN / below * angle) ** 2).sum()
    return line, np.sqrt((WEIGHTS * abs(error) ** 2).sum()), noise


if __name__ == "__main__":
    for hertz in [1.0, 22.0, 50.0, 98.11221, 150.0, 300.0]:
        line, rms, _ = loop(2 * np.pi * hertz)
        print(hertz, "Hz: line", repr(abs(line)), "rms", repr(rms))
    print("crossing (Hz)", repr(brentq(lambda f: abs(loop(2 * np.pi * f)[0]) - 1, 30, 45, xtol=1e-13)))
    square = quad(
        lambda angle: loop(angle / T)[2], 1e-9, np.pi, epsrel=1e-11, limit=400, points=[0.1, 0.3, 0.5]
    )[0]
    print("noise of the mean in the error (rad)", repr(NOISE * np.sqrt(square / np.pi)))
    closed = np.zeros((4, 4))
    # Angle, rate, command, and the mean that waits.
    both = expm(np.block([[RATES, np.zeros((3, 1))], [np.array([[1, 0, 0, 0]])]]) * T)
    closed[:2, :3], closed[2, 2:], closed[3, :3] = both[:2, :3], [1, GAIN], -both[3, :3] / T
    print("spectral radius", repr(abs(np.linalg.eigvals(closed)).max()))
