"""The open loops of all shipped scenarios beside their assembly by `tests/golden/open_loop_assembly.py`."""

import sys
from collections import Counter
from importlib import import_module
from pathlib import Path
from typing import Any

import flexsc
import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "golden"))
oracle: Any = import_module("open_loop_assembly")

BREAKS = ("command", "torque", "measurement")


def assert_equal(found: flexsc.Linear, expected: flexsc.Linear) -> None:
    assert found.states == expected.states
    assert found.inputs == expected.inputs
    assert found.period == expected.period
    for name in "abcd":
        own, other = getattr(found, name), getattr(expected, name)
        np.testing.assert_allclose(own, other, rtol=1e-9, atol=1e-9 * np.abs(other).max(initial=1e-3))


def test_every_loop_is_that_of_the_oracle() -> None:
    seen: Counter[bool] = Counter()
    for name in flexsc.examples():
        scenario = flexsc.Scenario.example(name)
        for loop in BREAKS:
            try:
                expected = oracle.open_loop(scenario, loop)
            except ValueError:
                with pytest.raises(flexsc.ScenarioError, match=scenario.name):
                    scenario.linearise(loop=loop)  # type: ignore[arg-type]
                seen[False] += 1
                continue
            assert_equal(scenario.linearise(loop=loop), expected)  # type: ignore[arg-type]
            seen[True] += 1
    assert seen[True] > 50
    assert seen[False] > 100


def test_a_delay_of_the_users() -> None:
    for name in ("wheel-fast-mode", "earth-observer"):
        scenario = flexsc.Scenario.example(name)
        assert_equal(
            scenario.linearise(loop="torque", delay=0.37), oracle.open_loop(scenario, "torque", 0.37)
        )


@pytest.mark.parametrize("name", ["wheel-fast-mode", "earth-observer", "four-clamped-modes"])
def test_margins_are_those_by_bisection(name: str) -> None:
    opened = flexsc.Scenario.example(name).linearise(loop="command")
    for chosen in (None, [opened.inputs[0].name], [opened.inputs[0].name.rstrip("_0123456789")]):
        found, expected = opened.common_margins(chosen), oracle.margins(opened, chosen)
        # Those end where a motion decays by less than 1e-8 of itself in a second.
        assert (found.gain_below, found.phase) == pytest.approx((expected[0], expected[2]), rel=2e-5)
        assert min(found.gain_above, 1e4) == pytest.approx(min(expected[1], 1e4), rel=2e-5)
