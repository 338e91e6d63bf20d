"""Golden numbers of the adaptive observers, by NumPy: `python3 tests/golden/observer_oracle.py` prints them.

One channel with two modes and two groups of thrusters, each of which excites both modes, without noise:
what the gradient observer of crates/control/src/estimator/adaptive identifies. Matrices are exponentials,
derivatives by the frequency are differences of the fourth order.
"""

import numpy as np
from scipy.linalg import expm

CYCLE, ZETA = 0.2, 0.005
FREQUENCIES, INFLUENCES = (0.25, 0.6), ((2.9, -0.6), (1.1, 1.5))
STARTS, GUESSES = (0.28, 0.55), ((2.2, -0.9), (1.5, 1.0))
BOUNDS = ((0.15, 0.4), (0.4, 0.9))
ACCELERATIONS, RIGID = (2e-5, 4e-5), (1.0, 0.02)
GAINS, RATE, GATE = (0.03, 0.1), 0.02, 5e-6


def system(w):
    return w * np.array([[-2.0 * ZETA, -1.0], [1.0, 0.0]])


def pulse(w, start, duration):
    """The state after the cycle for a unit acceleration, by the exponential of the system with its input."""
    whole = np.zeros((3, 3))
    whole[:2, :2], whole[0, 2] = system(w), 1.0
    return expm(system(w) * (CYCLE - start - duration)) @ expm(whole * duration)[:2, 2]


def slope(function, w):
    """w times the derivative by w, by differences of the fourth order."""
    h = 1e-3
    points = [function(w * np.exp(k * h)) for k in (-2, -1, 1, 2)]
    return (points[0] - 8.0 * points[1] + 8.0 * points[2] - points[3]) / (12.0 * h)


def burst(cycle):
    """Pulses of a cycle: (group, signed acceleration, start, duration)."""
    found = []
    if cycle % 60 < 8:
        found.append((0, ACCELERATIONS[0] * (-1) ** (cycle // 60), 0.0, 0.2))
    if cycle % 47 in range(20, 26):
        found.append((1, ACCELERATIONS[1] * (-1) ** (cycle // 47), 0.05, 0.11))
    return found


def main():
    true = 2.0 * np.pi * np.array(FREQUENCIES)
    log_w, mu = np.log(2.0 * np.pi * np.array(STARTS)), np.array(GUESSES)
    limits, start = np.log(2.0 * np.pi * np.array(BOUNDS)), np.array(GUESSES)
    state, truth = np.zeros(5), np.zeros(5)
    slopes, power = np.zeros((5, 6)), np.zeros(6)
    seen = np.array([1.0, 1.0, 0.0, 1.0, 0.0])
    gains = np.array([GAINS[0], GAINS[1], 0.0, GAINS[1], 0.0])
    for cycle in range(1201):
        pulses = burst(cycle)
        innovation, psi = seen @ (truth - state), seen @ slopes
        power = np.maximum(0.99 * power + 0.01 * psi**2, 0.05 * psi**2)
        for mode in range(2):
            if np.hypot(*state[1 + 2 * mode : 3 + 2 * mode]) > GATE:
                step = np.clip(RATE * psi[mode] * innovation / (power[mode] + GATE**2), -0.02, 0.02)
                log_w[mode] = np.clip(log_w[mode] + step, *limits[mode])
            for group in range(2):
                at, size = 2 + 2 * mode + group, abs(start[mode, group])
                step = RATE * psi[at] * innovation / (power[at] + (GATE / size) ** 2)
                step = np.clip(step, -0.02 * size, 0.02 * size)
                ends = sorted((0.2 * start[mode, group], 5.0 * start[mode, group]))
                mu[mode, group] = np.clip(mu[mode, group] + step, *ends)
        state, slopes = state + gains * innovation, slopes - np.outer(gains, psi)
        if cycle in (100, 400, 1200):
            print(cycle, np.exp(log_w) / (2.0 * np.pi), mu.ravel())
            print("    state", state)
        next_state, next_slopes, next_truth = state.copy(), slopes.copy(), truth.copy()
        for mode in range(2):
            part, w = slice(1 + 2 * mode, 3 + 2 * mode), np.exp(log_w[mode])
            turn = expm(system(w) * CYCLE)
            next_state[part], next_slopes[part] = turn @ state[part], turn @ slopes[part]
            turned = slope(lambda w, x=state[part]: expm(system(w) * CYCLE) @ x, w)
            next_slopes[part, mode] += turned
            next_truth[part] = expm(system(true[mode]) * CYCLE) @ truth[part]
            for group, size, begin, length in pulses:
                push = size * pulse(w, begin, length)
                next_state[part] += mu[mode, group] * push
                bent = slope(lambda w, b=begin, d=length: pulse(w, b, d), w)
                next_slopes[part, mode] += mu[mode, group] * size * bent
                next_slopes[part, 2 + 2 * mode + group] += push
                next_truth[part] += INFLUENCES[mode][group] * size * pulse(true[mode], begin, length)
        for group, size, _, length in pulses:
            next_state[0] += RIGID[group] * size * length
            next_truth[0] += RIGID[group] * size * length
        state, slopes, truth = next_state, next_slopes, next_truth


if __name__ == "__main__":
    np.set_printoptions(precision=12)
    main()
