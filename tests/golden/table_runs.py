"""Reference of tests/density_tables.rs and crates/spacecraft/src/held_lines.rs: variances of loads by
tables of densities, and the line of sight of the bench of broadband.py under one.

The variance of an output is the integral of the density times twice its mean square under a sine of unit
amplitude, aliases included: by Gauss's rule between breaks around the modes and the multiples of half the
sampling rate, near which the law resonates.
pip install numpy scipy
"""

from itertools import pairwise

import broadband
import numpy as np
from broadband import body, line

TABLE = np.array([[5, 1e-7, 4e-7, 5e-8], [40, 1e-6, 4e-6, 5e-7], [120, 1e-7, 4e-7, 5e-8]])
LOAD = np.array([[5, 1e-7], [40, 1e-6], [200, 1e-8]])
CORRELATION = np.array([[1, 0.6, -0.3], [0.6, 1, 0.2], [-0.3, 0.2, 1]])


def density(table, f):
    """The densities of a table at a frequency (Hz): straight lines on logarithmic scales."""
    return np.array([np.exp(np.interp(np.log(f), np.log(table[:, 0]), np.log(s))) for s in table[:, 1:].T])


def integral(value, breaks):
    """The integral over frequency by Gauss's rule of 24 nodes between breaks."""
    at, weights = np.polynomial.legendre.leggauss(24)
    found = 0.0
    for low, high in pairwise(breaks):
        half = 0.5 * (high - low)
        found = found + sum(half * w * value(low + half * (1 + x)) for x, w in zip(at, weights, strict=True))
    return found


def breaks_around(places, low, high, reach):
    """Breaks between two frequencies, finer towards some places."""
    near = [p + s * reach * 3.0**-k for p in places for k in range(12) for s in (-1, 1)]
    every = np.geomspace(low, high, 60)
    found = np.unique(np.concatenate([every, places, near, TABLE[:, 0]]))
    return found[(found >= low) & (found <= high)]


def rms(period, correlation):
    """The rms over time of the line of sight about x and y under the table."""
    factor = np.linalg.cholesky(correlation)
    a = body()[0]
    modes = [abs(p.imag) / 2 / np.pi for p in np.linalg.eigvals(a) if p.imag > 1]
    folds = np.arange(1, int(2 * 120 * period) + 2) / period / 2

    def power(f):
        loads = np.sqrt(density(TABLE, f))[:, None] * factor
        each = [line(period, 2 * np.pi * f, np.append(column, np.zeros(3)))[1] for column in loads.T]
        return 2 * np.sum(each, axis=0)

    places = [m for m in modes if m < 150] + list(folds)
    return np.sqrt(integral(power, breaks_around(places, 5.0, 120.0, 8.0)))


if __name__ == "__main__":
    np.set_printoptions(precision=9)
    print(
        "force x:",
        integral(lambda f: density(LOAD, f)[0], np.geomspace(5, 40, 9))
        + integral(lambda f: density(LOAD, f)[0], np.geomspace(40, 200, 9)),
    )
    torque = np.array([[5, 1e-8], [40, 1.25e-9]])
    print("torque x:", integral(lambda f: density(torque, f)[0], np.geomspace(5, 40, 9)))
    flat = np.array([[200, 1e-8, 3e-6], [300, 1e-8, 3e-6]])
    print("200 to 300 Hz:", integral(lambda f: density(flat, f), [200, 300]))
    broadband.BANDWIDTH = 2 * np.pi * 0.5
    for correlation in (np.eye(3), CORRELATION):
        print("line of sight about x and y", rms(0.001, correlation))
