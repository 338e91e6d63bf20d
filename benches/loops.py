"""The sampled loop of 400 s by SciPy, by a NumPy loop and by python-control, beside the engine's benchmark.

pip install scipy control            # python-control may be left out
python3 benches/loops.py
"""

import time

import numpy as np
from scipy.linalg import expm
from scipy.signal import dlsim

FREQUENCIES = np.array([0.2, 0.533333333, 0.666666667, 1.333333333])
GAINS = np.array([1.44, 0.21, 0.165, 0.72])
PERIOD, BACK_EMF, AUTHORITY, K_P, K_D = 0.3, 1e-4, 5e-4, 7.5, 275.0
SAMPLES = 1334


def closed_loop():
    """The matrix from sample to sample, the row of the angle, and the start."""
    order = 10
    system, push, felt = np.zeros((order, order)), np.zeros(order), np.zeros(order)
    push[1], push[3::2], felt[1::2], system[0, 1] = 1.0, GAINS, 1.0, 1.0
    for i, w in enumerate(FREQUENCIES):
        system[2 + 2 * i, 3 + 2 * i], system[3 + 2 * i, 2 + 2 * i] = 1.0, -(w**2)
    system -= BACK_EMF * np.outer(push, felt)
    whole = np.zeros((order + 1, order + 1))
    whole[:order, :order], whole[:order, order] = system * PERIOD, AUTHORITY * push * PERIOD
    held = expm(whole)
    angle = np.zeros(order)
    angle[::2] = 1.0
    closed = np.zeros((order + 1, order + 1))
    closed[:order, :order] = held[:order, :order] - np.outer(held[:order, order], (K_P + K_D) * angle)
    closed[:order, order] = K_D * held[:order, order]
    closed[order, :order] = angle
    start = np.zeros(order + 1)
    start[0] = start[order] = 0.06
    return closed, np.append(angle, 0.0), start


def settling(angles):
    """The last sample outside 3 mrad (s)."""
    return np.nonzero(np.abs(angles) > 0.003)[0][-1] * PERIOD


def by_loop():
    closed, angle, state = closed_loop()
    angles = np.empty(SAMPLES)
    for k in range(SAMPLES):
        angles[k] = angle @ state
        state = closed @ state
    return settling(angles)


def by_scipy():
    closed, angle, start = closed_loop()
    none = np.zeros((len(start), 1))
    _, angles, _ = dlsim((closed, none, angle[None], [[0.0]], PERIOD), np.zeros(SAMPLES), x0=start)
    return settling(angles[:, 0])


def by_control(response):
    import control

    closed, angle, start = closed_loop()
    system = control.ss(closed, np.zeros((len(start), 1)), angle[None], [[0.0]], PERIOD)
    times = PERIOD * np.arange(SAMPLES)
    answer = getattr(control, response)
    if response == "forced_response":
        return settling(answer(system, times, np.zeros(SAMPLES), start).outputs)
    return settling(answer(system, times, start).outputs)


def by_integrator():
    """Between samples SciPy's DOP853, which needs no constant frequencies."""
    from scipy.integrate import solve_ivp

    def field(t, z, u):
        moment = AUTHORITY * u - BACK_EMF * z[1::2].sum()
        rate = np.empty_like(z)
        rate[0], rate[1], rate[2::2] = z[1], moment, z[3::2]
        rate[3::2] = GAINS * moment - FREQUENCIES**2 * z[2::2]
        return rate

    state, last, angles = np.zeros(10), 0.06, np.empty(SAMPLES)
    state[0] = 0.06
    for k in range(SAMPLES):
        angle = angles[k] = state[::2].sum()
        u = -(K_P * angle + K_D * (angle - last))
        last = angle
        state = solve_ivp(field, (0.0, PERIOD), state, "DOP853", rtol=1e-9, atol=1e-12, args=(u,)).y[:, -1]
    return settling(angles)


def median(work, runs=9):
    """Median CPU time (s) of some runs; all settle when the engine's does."""
    times = []
    for _ in range(runs):
        began = time.process_time()
        settled = work()
        times.append(time.process_time() - began)
        if abs(settled - 180.3) > 1e-9:
            raise AssertionError(f"settles at {settled} s")
    return sorted(times)[runs // 2]


def peers():
    """Name and CPU time (s) of each peer; None for one that is not installed."""
    rows = [("NumPy, a loop over the samples", median(by_loop)), ("SciPy, `signal.dlsim`", median(by_scipy))]
    for response in ("forced_response", "initial_response"):
        try:
            rows.append((f"python-control, `{response}`", median(lambda r=response: by_control(r))))
        except ModuleNotFoundError:
            rows.append((f"python-control, `{response}`", None))
    rows.append(("SciPy, DOP853 from sample to sample", median(by_integrator, runs=3)))
    return rows


if __name__ == "__main__":
    for name, seconds in peers():
        print(f"{name}: {'not installed' if seconds is None else f'{seconds * 1e3:.3g} ms'}")
