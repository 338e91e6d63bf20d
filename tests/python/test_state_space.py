"""A compensator from a design program as the law of a scenario, beside the same loop in NumPy."""

from typing import Any

import numpy as np
import pytest
from flexsc import Scenario, ScenarioError
from scipy.signal import cont2discrete

PERIOD, INERTIA = 0.5, 12.0


def study() -> Scenario:
    return Scenario(
        {
            "duration": 40.0,
            "body": {"planar": {"inertia": INERTIA, "angle": 0.02}},
            "sensor": {"sampled": {"period": PERIOD}},
            "actuator": {"hold": {"period": PERIOD}},
            "law": {"open": {}},
            "log": {"period": PERIOD},
        }
    )


def test_a_design_becomes_a_law() -> None:
    # 0.8 + 5 s/(1 + 0.4 s), in continuous time.
    lead = np.array([[-2.5]]), np.array([[2.5]]), np.array([[-12.5]]), np.array([[13.3]])
    sampled: Any = cont2discrete(lead, PERIOD, "bilinear")
    a, b, c, d, _ = sampled
    law = {"period": PERIOD, "a": a, "b": b, "c": c, "d": d}
    run = Scenario({**study().to_dict(), "law": {"state_space": law}}).simulate(log="full")
    # The same by flexsc's own rule.
    whole = {"period": PERIOD, "of": "tustin", **dict(zip("abcd", lead, strict=True))}
    again = Scenario({**study().to_dict(), "law": {"state_space": whole}}).simulate(log="full")
    angle, rate, state, angles = 0.02, 0.0, 0.0, []
    for _ in range(81):
        angles.append(angle)
        torque = (c[0, 0] * state - d[0, 0] * angle) / INERTIA
        state = a[0, 0] * state - b[0, 0] * angle
        angle, rate = angle + rate * PERIOD + 0.5 * torque * PERIOD**2, rate + torque * PERIOD
    for result in (run, again):
        found = result["/attitude"]["angle_rad"]
        np.testing.assert_allclose(found, angles, rtol=0.0, atol=1e-14)
    assert abs(angles[-1]) < 1e-3


def test_matrices_that_do_not_fit() -> None:
    law = {"period": PERIOD, "a": np.eye(2), "b": np.ones((1, 1)), "c": np.ones((1, 2))}
    with pytest.raises(ScenarioError, match=r"law\.state_space\.b.*each of 2 states"):
        Scenario({**study().to_dict(), "law": {"state_space": law}})
