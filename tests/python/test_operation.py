"""Modes of operation in Python: the changes are recomputed from the columns of the log."""

import flexsc
import numpy as np
import pytest
from conftest import shipped


def test_changes_follow_from_the_columns() -> None:
    run = shipped("safe-mode").with_({"duration": 7000.0, "log.period": 0.5}).simulate(log="full")
    modes = run["mode"]
    assert list(modes["mode"]) == ["detumble", "point", "safe", "point"]
    times = np.asarray(run["rates"]["time_s"])
    rate = np.linalg.norm(np.asarray(run["rates"]["axes.believed_rad_s"]), axis=1)
    # The B-dot law samples at whole seconds, and the condition `rate < 4e-3` has to hold for 60 s.
    seconds = (times % 1 == 0) & (times >= 1)
    slow = rate[seconds] < 4e-3
    window = np.convolve(slow, np.ones(61), "valid")
    point = float(times[seconds][np.flatnonzero(window == 61)[0] + 60])
    # The tracker is silent from 5800 s on: its last reading is at 5799 s.
    safe = next(t for t in np.arange(point, 7000, 0.5) if t - 5799 > 30)
    back = next(t for t in np.arange(safe + 1, 7000, 1.0) if t >= 6400) + 120
    np.testing.assert_array_equal(modes["time_s"], [0.0, point, safe, back])
    metrics = run.metrics
    assert metrics["mode_changes"] == 3
    np.testing.assert_allclose(metrics["mode_times_s"], [point, safe - point + 7000 - back, back - safe])
    np.testing.assert_array_equal(metrics["mode_starts_s"], [0.0, point, safe])


def test_one_mode_has_margins() -> None:
    scenario = shipped("safe-mode")
    margins = scenario.with_("spacecraft.rate", [0.0, 0.0, 0.0]).in_mode("point").margins()
    assert margins.spectral_radius < 1
    with pytest.raises(flexsc.ScenarioError, match="choose one"):
        scenario.margins()
    with pytest.raises(flexsc.ScenarioError, match="must be one of `detumble`, `point`, `safe`"):
        scenario.in_mode("sleep")
