"""Golden numbers of tests/damping.rs, by NumPy and SciPy: `python3 tests/golden/damping_oracle.py`.

The limit of a delayed rate feedback comes from the rightmost characteristic roots, of the delay equation's
generator on Chebyshev points, and from the delay equation itself by steps; the region of convergence from
eigenvalues at random points; the decay to a threshold from an integration.
"""

import numpy as np
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq

TURN = 2.0 * np.pi


def rightmost(w, h, zeta, k, points=32):
    """The largest real part of a characteristic root of x'' + 2 zeta w x' + w^2 x + k x'(t - h) = 0."""
    x = np.cos(np.pi * np.arange(points + 1) / points)
    c = np.r_[2.0, np.ones(points - 1), 2.0] * (-1.0) ** np.arange(points + 1)
    apart = x[:, None] - x[None, :]
    d = np.outer(c, 1.0 / c) / (apart + np.eye(points + 1))
    d -= np.diag(d.sum(axis=1))
    generator = np.kron(2.0 / h * d, np.eye(2))
    generator[:2] = 0.0
    generator[:2, :2] = [[0.0, 1.0], [-w * w, -2.0 * zeta * w]]
    generator[1, -1] -= k
    return np.linalg.eigvals(generator).real.max()


def first_unstable(w, h, zeta, highest):
    """The least gain at which a root crosses the axis."""
    gains = np.linspace(0.0, highest, 120)
    grows = [rightmost(w, h, zeta, k) > 0.0 for k in gains]
    at = int(np.argmax(grows))
    return brentq(lambda k: rightmost(w, h, zeta, k), gains[at - 1], gains[at], xtol=1e-12)


def growth(w, h, zeta, k, time=60.0):
    """Ratio of the energies in the last and the first quarter of an integration by steps of h."""
    history = lambda t: np.cos(w * t) * w  # noqa: E731
    state, energies = [0.0, w], []
    for step in range(int(time / h)):
        start = step * h
        right = lambda t, x, past=history: [  # noqa: E731
            x[1],
            -2.0 * zeta * w * x[1] - w * w * x[0] - k * past(t - h),
        ]
        done = solve_ivp(right, (start, start + h), state, rtol=1e-10, atol=1e-12, dense_output=True)
        history = lambda t, of=done.sol: of(t)[1]  # noqa: E731
        state = done.y[:, -1]
        energies.append(state[1] ** 2 + w * w * state[0] ** 2)
    quarter = len(energies) // 4
    return np.mean(energies[-quarter:]) / np.mean(energies[:quarter])


def frozen(hertz, weights, kappa, period=0.2, zeta=0.005):
    """One cycle of the observer's errors under a constant regressor: rigid, elastic, elastic before, A."""
    w, (w1, w2, w3) = TURN * hertz, weights
    a = 2.0 * np.exp(-zeta * w * period) * np.cos(w * np.sqrt(1.0 - zeta**2) * period)
    b = np.exp(-2.0 * zeta * w * period)
    seen = np.array([1.0, 1.0, 0.0, 0.0])
    rows = np.eye(4)
    elastic, turn = rows[1] - w2 * seen, rows[3] - kappa * seen
    return np.array([rows[0] - w1 * seen, a * elastic + turn - b * rows[2] + w3 * seen, elastic, turn])


def area(w1, kappa, draws=400_000):
    """The area of the region of convergence in (W2, W3): eigenvalues at random points; one of them is 1."""
    rng = np.random.default_rng(1)
    low, high = np.array([-0.3, -4.5]), np.array([2.1, 6.5])
    points = rng.uniform(low, high, (draws, 2))
    cycles = np.array([frozen(0.2, (w1, w2, w3), kappa) for w2, w3 in points])
    sizes = np.sort(np.abs(np.linalg.eigvals(cycles)), axis=1)
    inside = (sizes[:, -1] < 1.0 + 1e-9) & (sizes[:, -2] < 1.0)
    return inside.mean() * np.prod(high - low)


def main():
    print("gain limits, 1/s: frequency Hz, delay s, damping ratio")
    for hertz, h, zeta, highest in (
        (0.2, 0.2, 0.005, 10.0),
        (1.0, 0.2, 0.005, 5.0),
        (1.5, 0.2, 0.005, 5.0),
        (0.8, 1.0, 0.05, 5.0),
        (2.3, 1.0, 0.05, 20.0),
        (3.0, 1.5, 0.1, 20.0),
    ):
        print(hertz, h, zeta, f"{first_unstable(TURN * hertz, h, zeta, highest):.9f}")
    limit = first_unstable(TURN, 0.2, 0.005, 5.0)
    for part in (0.97, 1.03):
        print("energy, after by before, at", part, "of the second:", growth(TURN, 0.2, 0.005, part * limit))
    roots = np.linalg.eigvals(frozen(0.2, (0.05, 0.2, 0.15), 0.0))
    print("frozen observer:", sorted(roots, key=abs))
    print("areas:", [area(0.05, kappa) for kappa in (0.0, 1.5, 4.0)], area(0.02, 0.0), area(0.2, 0.0))
    slope, rate, start, threshold = 2e-5, 0.01, 5e-4, 1e-4
    fall = lambda v: 1.0 / (rate * v + slope * np.sqrt(1.0 - (threshold / v) ** 2))  # noqa: E731
    print("to the threshold with damping:", quad(fall, threshold, start, limit=200, epsabs=1e-13)[0])
    thrust = lambda v: fall(v) * 2.0 / np.pi * np.arccos(threshold / v)  # noqa: E731
    print("of that under thrust:", quad(thrust, threshold, start, limit=200, epsabs=1e-13)[0])


if __name__ == "__main__":
    main()
