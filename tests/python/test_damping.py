"""Active damping: the relay, and the convergence of the observer, beside NumPy's own numbers."""

import numpy as np
import pytest
from flexsc.papers import identify, observer_margin, observer_region, persistence, relay_damping

HERTZ = 2.0 * np.pi


def test_what_a_relay_damps() -> None:
    hertz = np.array([0.137, 0.711, 1.1])
    late = relay_damping(HERTZ * hertz, 1e-6, delay=0.2, damping=0.0, amplitude=1e-4)
    w, factor = HERTZ * hertz, late["phase_factor"]
    exact = (np.sin(0.4 * w) - np.sin(0.2 * w)) / (0.2 * w)
    np.testing.assert_allclose(factor, exact, rtol=1e-12)
    np.testing.assert_allclose(late["slope_rad_s2"], 2e-6 / np.pi * exact, rtol=1e-12)
    np.testing.assert_allclose(late["decay_s"][:2], 1e-4 / late["slope_rad_s2"][:2], rtol=1e-12)
    assert np.isnan(late["decay_s"][2]), "beyond 0.833 Hz it feeds the mode"
    pure = relay_damping([HERTZ], 1e-6, period=0.0, delay=0.2)
    assert pure["gain_limit_1_s"][0] == pytest.approx(2.999018284, rel=1e-8)
    assert np.isnan(relay_damping([1.0], 1e-6, period=0.0)["gain_limit_1_s"][0])


def largest_root(weights: tuple[float, float, float], kappa: float) -> float:
    w, zeta = 0.2 * HERTZ, 0.005
    a = 2.0 * np.exp(-zeta * w * 0.2) * np.cos(w * np.sqrt(1.0 - zeta**2) * 0.2)
    b, (w1, w2, w3) = np.exp(-2.0 * zeta * w * 0.2), weights
    seen, rows = np.array([1.0, 1.0, 0.0, 0.0]), np.eye(4)
    elastic, turn = rows[1] - w2 * seen, rows[3] - kappa * seen
    cycle = [rows[0] - w1 * seen, a * elastic + turn - b * rows[2] + w3 * seen, elastic, turn]
    roots = np.linalg.eigvals(np.array(cycle))
    # A constant elastic rate cannot be told from a rigid one.
    return float(np.abs(np.delete(roots, np.abs(roots - 1.0).argmin())).max())


def test_where_the_observer_converges() -> None:
    region = observer_region(0.2 * HERTZ, [0.6, 1.2, 2.1], kappa=1.5)
    assert region["area"] == pytest.approx(1.347, rel=0.01)
    assert np.isnan(region["next_min"][2])
    for w2, low, high in zip(region["elastic"][:2], region["next_min"], region["next_max"], strict=False):
        edges = ((low - 1e-4, False), (low + 1e-4, True), (high - 1e-4, True), (high + 1e-4, False))
        for w3, inside in edges:
            assert (largest_root((0.05, w2, w3), 1.5) < 1.0) == inside, (w2, w3)


def test_how_fast_the_observer_may_be() -> None:
    margin = observer_margin(0.2 * HERTZ, [0.01, 0.04, 0.05])
    assert margin["gain_max"] == pytest.approx(0.0429, rel=0.03)
    assert margin["spectral_radius"] == pytest.approx(0.9539, rel=1e-3)
    assert (margin["radii"] < 1.0).tolist() == [True, True, False]
    assert np.isnan(observer_margin(0.2 * HERTZ, weights=(0.05, -0.5, 0.15))["gain_max"])


def test_what_tells_parameters_apart() -> None:
    rng = np.random.default_rng(1)
    rows = rng.normal(size=(50, 3)) * [1.0, 1e-6, 1e3]
    lengths = np.sqrt((rows**2).sum(axis=0))
    exact = np.linalg.eigvalsh(rows.T @ rows / np.outer(lengths, lengths))[0]
    assert persistence(rows) == pytest.approx(exact, rel=1e-9)
    assert np.isnan(persistence([[1.0, 0.0]]))


def test_what_is_out_of_range() -> None:
    with pytest.raises(ValueError, match=r"on_time must be .* at most the period of 0\.2 s, got 0\.3"):
        relay_damping([1.0], 1e-6, on_time=0.3)
    with pytest.raises(ValueError, match="frequencies must be positive numbers, got 0"):
        relay_damping([0.0], 1e-6)
    with pytest.raises(ValueError, match=r"frequency must be .* below the Nyquist frequency of 15\.7"):
        observer_margin(16.0)
    with pytest.raises(ValueError, match="damping must be 0 or more and below 1, got 1"):
        observer_region(1.0, [0.2], damping=1.0)


def test_how_fast_modes_are_found() -> None:
    modes = [(0.2476 * HERTZ, 2.89), (0.6 * HERTZ, 3.0)]
    found = identify(modes, [0.05, 0.3], runs=12)
    assert found["converged"].tolist() == [12.0, 12.0]
    # 20 and 39 s in the study that the model comes from, at most 46 and 120 s.
    assert np.all(found["time_median_s"] < [25.0, 45.0])
    assert np.all(found["frequency_error"] < 5e-4)
    for times, median, longest in zip(
        found["times_s"], found["time_median_s"], found["time_longest_s"], strict=True
    ):
        assert times.tolist() == sorted(times)
        assert (times[6], times[-1]) == (median, longest)
    near = identify([(0.6049 * HERTZ, 1.5), (0.6096 * HERTZ, 1.6)], [0.05], runs=4)
    assert near["persistence"][0] < 0.05 < found["persistence"][0]
    with pytest.raises(ValueError, match="must have influences other than 0"):
        identify([(1.0, 0.0)])
    with pytest.raises(ValueError, match="runs and cycles must be from 1 to 1000000, got 0"):
        identify(modes, runs=0)
