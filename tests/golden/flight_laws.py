"""Golden numbers of `crates/flight/tests/linear_laws.rs`: a compensator by SciPy, a Kalman filter by hand."""

import numpy as np
from scipy import signal
from scipy.linalg import expm


def compensator() -> None:
    """Outputs of a compensator with two states, two inputs and one output, times 0.8."""
    matrices = (
        np.array([[0.9, 0.2], [-0.1, 0.7]]),
        np.array([[0.5, 0.1], [0.0, 0.3]]),
        np.array([[1.5, -2.0]]),
        np.array([[0.25, -0.5]]),
    )
    inputs = np.array([[1.0, 0.5], [-2.0, 0.25], [0.5, 1.0], [0.0, -1.0]])
    (_, outputs, _) = signal.dlsim((*matrices, 0.1), inputs)
    print("outputs", (0.8 * outputs[:, 0]).tolist())


def kalman() -> None:
    """Filter of a rigid angle and one mode; a sample updates by angle and rate together."""
    (h, w, damping, gain) = (0.1, 2.0, 0.01, 0.3)
    flow = np.zeros((5, 5))
    flow[0, 1] = flow[2, 3] = flow[1, 4] = 1.0
    flow[3, 2:5] = [-w * w, -2.0 * damping * w, gain]
    whole = expm(flow * h)
    (transition, push) = (whole[:4, :4], whole[:4, 4])
    pushed = np.array([0.0, 1.0, 0.0, gain])
    noise = 1e-9 * h * np.outer(pushed, pushed)
    print("model", np.concatenate([transition.T.ravel(), push, noise.T.ravel()]).tolist())
    covariance = np.diag(np.square([1e-4, 1e-4, 2e-3, 6e-4]))
    mean = np.array([1e-3, -2e-4, 5e-4, 0.0])
    measures = np.array([[1.0, 0.0, 1.0, 0.0], [0.0, 1.0, 0.0, 1.0]])
    measured_noise = np.diag(np.square([1e-5, 3e-6]))
    samples = [(1.4e-3, -1.5e-4, 0.0), (1.35e-3, -1.2e-3, 1e-3), (1.1e-3, -2.4e-3, -5e-4)]
    for k, (angle, rate, moment) in enumerate(samples):
        if k > 0:
            mean = transition @ mean + push * moment
            covariance = transition @ covariance @ transition.T + noise
        spread = measures @ covariance @ measures.T + measured_noise
        gains = covariance @ measures.T @ np.linalg.inv(spread)
        innovation = np.array([angle, rate]) - measures @ mean
        square = innovation @ np.linalg.solve(spread, innovation)
        mean = mean + gains @ innovation
        covariance = (np.eye(4) - gains @ measures) @ covariance
        print("mean", mean.tolist(), "square", square, "deviations", np.sqrt(np.diag(covariance)).tolist())


compensator()
kalman()
