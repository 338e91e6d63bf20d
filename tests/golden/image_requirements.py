"""Reference of tests/image_requirements.rs: the image of the bench of broadband.py under its forces and a
cooler, with samples of the law at 1 kHz.

The circles: the covariance of the line of sight over time, and the radius of a part of the energy by an
integral over one axis of the error function of the other, in mpmath. The contrast: an integral over frequency
for the variance about the mean of an exposure, and over the time of the exposure. pip install numpy scipy
mpmath
"""

import mpmath as mp
import numpy as np
from broadband import BANDWIDTH, DENSITY, HUB, LOWER, UPPER, line, over, system
from scipy.linalg import solve_discrete_lyapunov
from scipy.special import j0, roots_legendre

PERIOD = 0.001


def covariance():
    """The covariance of the line of sight about x and y over time."""
    a, noise, torque, sight = system()
    gain = np.hstack([HUB * BANDWIDTH**2, np.zeros((3, 3)), 1.4 * BANDWIDTH * HUB, np.zeros((3, 15))])

    def closed(time):
        flow, added, held = over(a, noise, torque, time)
        return flow - held @ gain, added

    p = solve_discrete_lyapunov(*closed(PERIOD))
    at, weights = np.polynomial.legendre.leggauss(16)
    total = np.zeros((2, 2))
    for place, weight in zip(0.5 * (at + 1), 0.5 * weights, strict=True):
        after, more = closed(PERIOD * place)
        total += weight * (sight @ (after @ p @ after.T + more) @ sight.T)
    return total


def radius(major, minor, part):
    """The radius that has a part of the energy of two normal axes with these deviations."""

    def energy(r):
        def strip(x):
            return mp.npdf(x, 0, major) * mp.erf(mp.sqrt(r * r - x * x) / (minor * mp.sqrt(2)))

        return 2 * mp.quad(strip, mp.linspace(0, r, 9))

    return mp.findroot(lambda r: energy(r) - part, (0.7 * major, 2.2 * major), solver="anderson")


def sinc(x):
    return np.sinc(x / np.pi)


def shape(w):
    """The density of a force at a frequency."""

    def low(corner):
        return 1 / np.abs(1 - (w / corner) ** 2 + 1.4j * w / corner) ** 2

    return DENSITY * (w / LOWER) ** 4 * low(LOWER) * low(UPPER)


def grid():
    """Frequencies (rad/s) and weights, close around the resonances of the free body."""
    poles = np.linalg.eigvals(system()[0][:12, :12])
    edges = [1e-2, *np.geomspace(0.05, 3e4, 90)]
    for pole in poles[poles.imag > 1]:
        width = abs(pole.real)
        steps = width * np.geomspace(0.2, 3000, 40)
        edges += [pole.imag, *(pole.imag + steps), *(pole.imag - steps)]
    edges = np.unique([edge for edge in edges if 1e-2 <= edge <= 3e4])
    at, weights = roots_legendre(10)
    half = np.diff(edges) / 2
    middle = edges[:-1] + half
    return (middle[:, None] + half[:, None] * at).ravel(), (half[:, None] * weights).ravel()


def powers():
    """Frequencies with the power of the line of sight about x and y in the band of each."""
    w, weights = grid()
    found = np.zeros((2, len(w)))
    for force in np.eye(6)[:3]:
        for k, at in enumerate(w):
            amplitude, _ = line(PERIOD, at, force)
            found[:, k] += np.abs(amplitude) ** 2 * shape(at) * weights[k] / (2 * np.pi)
    return w, found


def contrast(nu, exposure, axis, broad, tones):
    """The contrast over exposures, or over a long one."""
    w, power = broad

    def at(time):
        def square(w):
            if exposure is None:
                return np.ones_like(w)
            q = sinc(w * exposure / 2)
            return 1 - 2 * q * np.cos(w * time) + q * q

        value = np.exp(-2 * (np.pi * nu) ** 2 * (power[axis] * square(w)).sum())
        for tone, amplitude in tones:
            value *= j0(2 * np.pi * nu * amplitude[axis] * np.sqrt(square(np.array(tone))))
        return value

    if exposure is None:
        return at(0)
    places, weights = roots_legendre(40)
    return sum(
        0.5 * weight * at(0.5 * exposure * place) for place, weight in zip(places, weights, strict=True)
    )


if __name__ == "__main__":
    both = covariance()
    minor, major = np.sqrt(np.linalg.eigvalsh(both))
    print("covariance", both, "axes", major, minor)
    print("radii", [mp.nstr(radius(mp.mpf(major), mp.mpf(minor), part), 15) for part in (0.5, 0.8, 0.95)])
    mp.mp.dps = 25
    print("one to two", [mp.nstr(radius(mp.mpf(2), mp.mpf(1), part), 18) for part in (0.5, 0.8, 0.95)])
    broad = powers()
    print("variances", broad[1].sum(axis=1), np.diag(both))
    cooler = [
        (2 * np.pi * 51.0, np.array([0.01, 0, 0.02, 0, 0, 0])),
        (4 * np.pi * 51.0, np.array([0, 0.003, 0, 2e-4, 0, 0])),
    ]
    tones = [(w, np.abs(line(PERIOD, w, load)[0])) for w, load in cooler]
    # The scenario's cooler is 100 times as strong.
    tones = [(w, 100 * amplitude) for w, amplitude in tones]
    print("tones", tones)
    none = (broad[0], 0 * broad[1])
    for exposure in (None, 0.01):
        for axis in range(2):
            print(
                exposure,
                "xy"[axis],
                "all",
                contrast(1.5e6, exposure, axis, broad, tones),
                "broadband alone",
                contrast(1.5e6, exposure, axis, broad, []),
                "cooler alone",
                contrast(1.5e6, exposure, axis, none, tones),
            )
