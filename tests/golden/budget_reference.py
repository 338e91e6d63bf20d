"""Golden numbers of tests/budget_levels.rs, with NumPy and SciPy alone: sources and levels of indices.

The bodies of `budgets/windows.toml`, `bias.toml` and `uncertain.toml` are rigid, under a PD law and noise
that is drawn at its samples. Their loops are assembled here in closed form. The variance of an index is that
of a weighted sum of samples, by a discrete Lyapunov equation; a sine is the response of the sampled loop to
exp(j w t). Levels are roots of the probability by the integral of Gil-Pelaez, with a bias that all runs have
as a constant.

Run it in this directory: `python budget_reference.py > budgets.csv`. Each row has a scenario, a requirement,
a quantity and its value.
"""

import numpy as np
from scipy.linalg import solve_discrete_lyapunov
from scipy.optimize import brentq
from scipy.special import j0

INERTIA, STIFFNESS, DAMPING, PERIOD, NOISE, RATE_NOISE = 12.0, 1.2, 6.0, 0.25, 1e-6, 1e-7
FLOW = np.array([[1.0, PERIOD], [0.0, 1.0]])
HELD = np.array([[PERIOD**2 / 2], [PERIOD]]) / INERTIA
GAIN = np.array([[STIFFNESS, DAMPING]])
LOOP = FLOW - HELD @ GAIN
DRAWN = -HELD @ GAIN * [NOISE, RATE_NOISE]
COVARIANCE = solve_discrete_lyapunov(LOOP, DRAWN @ DRAWN.T)
ANGLE, RATE = np.array([1.0, 0.0]), np.array([0.0, 1.0])

INDICES = {
    "ape": lambda: [np.ones(1)],
    "rate": lambda: [np.ones(1)],
    "mean": lambda: [mean(2)],
    "end2": lambda: [less_mean(2, 1)],
    "end8": lambda: [less_mean(8, 7)],
    "middle4": lambda: [less_mean(4, 2)],
    "uniform4": lambda: [less_mean(4, place) for place in range(4)],
    "uniform8": lambda: [less_mean(8, place) for place in range(8)],
    "drift": lambda: [np.concatenate([-mean(2), [0.0], mean(2)])],
}


def mean(count):
    """Return the weights of the mean of samples."""
    return np.full(count, 1 / count)


def less_mean(count, place):
    """Return the weights of a sample less the mean."""
    weights = -mean(count)
    weights[place] += 1
    return weights


def noise(weights, row):
    """Return the standard deviation of a weighted sum of samples."""
    ahead, variance = np.zeros(2), 0.0
    for weight in weights[::-1]:
        drawn = ahead @ DRAWN
        variance += drawn @ drawn
        ahead = weight * row + ahead @ LOOP
    return np.sqrt(variance + ahead @ COVARIANCE @ ahead)


def amplitude(weights, torque, frequency):
    """Return the amplitude of a weighted sum of samples under torque sin(w t)."""
    jw = 1j * frequency
    # Integrals over a sample of exp(j w s), and of that times the rest of the sample.
    turn = np.exp(jw * PERIOD)
    rate = (turn - 1) / jw
    angle = (turn - 1 - jw * PERIOD) / jw**2
    forced = np.array([angle, rate]) * torque / INERTIA
    state = np.linalg.solve(turn * np.eye(2) - LOOP, forced)
    return abs(sum(weight * state[0] * turn**k for k, weight in enumerate(weights)))


def level(probability, places, halves=()):
    """Return the level of places with a constant, amplitudes and a deviation, and of uniform parts."""
    most = max(abs(c) + sum(a) + 9 * s for c, a, s in places) + sum(halves)
    least = min(s for _, _, s in places)
    end = 9 / least
    count = int(max(4000, 40 * end * most / np.pi))
    t = (np.arange(count) + 0.5) * end / count
    function = np.zeros(count)
    for constant, amplitudes, deviation in places:
        own = np.exp(-0.5 * (deviation * t) ** 2) * np.cos(constant * t)
        for value in amplitudes:
            own *= j0(value * t)
        function += own / len(places)
    for half in halves:
        function *= np.sinc(half * t / np.pi)

    def beyond(m):
        """Return the probability that the magnitude is at most m, less the given one."""
        return 2 / np.pi * np.sum(function * np.sin(m * t) / t) * end / count - probability

    return brentq(beyond, 0, most, xtol=1e-20, rtol=1e-13)


def write(scenario, requirement, steady=0.0, sines=(), half=0.0):
    """Print the rows of a requirement."""
    row = RATE if requirement == "rate" else ANGLE
    places = []
    for weights in INDICES[requirement]():
        static = weights.sum() * row[0] / STIFFNESS
        places.append((static * steady, [amplitude(weights, *sine) for sine in sines], noise(weights, row)))
    rows = {"noise": np.sqrt(np.mean([s**2 for _, _, s in places])), "bias": places[0][0]}
    for k in range(len(sines)):
        rows[f"amplitude{k}"] = np.sqrt(np.mean([a[k] ** 2 for _, a, _ in places]))
    rows["bias_spread"] = abs(static) * half / np.sqrt(3)
    for probability in (0.683, 0.955, 0.997):
        rows[f"{probability}"] = level(probability, places, [abs(static) * half] if half else [])
    for name, value in rows.items():
        print(f"{scenario},{requirement},{name},{float(value)!r}")


for name in ("ape", "mean", "end2", "end8", "middle4", "uniform8", "drift", "rate"):
    write("windows", name)
for name in ("ape", "mean", "end2", "uniform4"):
    write("bias", name, steady=1.2e-6, sines=[(2e-5, 4.0), (3e-6, 0.4)])
for name in ("ape", "drift"):
    write("uncertain", name, half=1.2e-6)
