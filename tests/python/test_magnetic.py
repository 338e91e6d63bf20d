"""An orbit, its field and magnetic control in Python: against the same by hand."""

from datetime import datetime, timedelta, timezone

import numpy as np
from conftest import shipped


def test_orbit_and_field_are_those_by_hand() -> None:
    dipole = {"environment.magnetic_field.model": "dipole", "estimator.attitude.field_degree": 1}
    scenario = shipped("detumble-and-point").with_({"duration": 600.0, "log.period": 60.0, **dipole})
    run = scenario.simulate(log="full")
    t, orbit = run["orbit"]["time_s"], run["orbit"]
    radius, inclination, node = 6.928e6, 1.70, 0.5
    u = np.sqrt(3.986004418e14 / radius**3) * t
    along = np.array([np.cos(node), np.sin(node), 0.0])
    across = np.array(
        [-np.cos(inclination) * np.sin(node), np.cos(inclination) * np.cos(node), np.sin(inclination)]
    )
    up = np.outer(np.cos(u), along) + np.outer(np.sin(u), across)
    np.testing.assert_allclose(orbit["axes.position_m"], radius * up, atol=1e-6)
    # Greenwich at the start by Meeus, Astronomical Algorithms, 12.4, in degrees.
    epoch = scenario.to_dict()["epoch"]
    days = (epoch - datetime(2000, 1, 1, 12, tzinfo=timezone.utc)) / timedelta(days=1)
    century = days / 36525
    greenwich = 280.46061837 + 360.98564736629 * days + 0.000387933 * century**2 - century**3 / 38710000
    turned = np.radians(greenwich % 360) + 7.292115e-5 * t
    x, y, z = -1450.9e-9, 4652.5e-9, -29404.8e-9
    south = np.stack(
        [np.cos(turned) * x - np.sin(turned) * y, np.sin(turned) * x + np.cos(turned) * y, 0 * t + z], 1
    )
    field = (3 * (south * up).sum(1)[:, None] * up - south) * (6371200.0 / radius) ** 3
    # The length does not depend on where the body faces, nor does the angle to the nadir.
    np.testing.assert_allclose(
        np.linalg.norm(orbit["axes.field_t"], axis=1), np.linalg.norm(field, axis=1), rtol=1e-9
    )
    down = (orbit["axes.field_t"] * orbit["axes.nadir"]).sum(1)
    np.testing.assert_allclose(down, -(field * up).sum(1), atol=1e-14)
    assert (np.abs(run["magnetorquers"]["axes.moment_am2"]) <= 1.5).all()
    assert run.metrics["rate_end_rad_s"] < 0.06
