"""Wheels on mounts in Python: typed parts, poles with whirl, and the worst speed over the keys of a mount."""

from pathlib import Path

import flexsc
import numpy as np
import pytest
from flexsc.scenario import (
    Appendage,
    AttitudeLaw,
    Imbalance,
    LineOfSight,
    Mount,
    NamedPoint,
    Spacecraft,
    Wheels,
)

SPEED, ACROSS, SPIN = 300.0, 9e-4, 1.6e-3


def bench(hub: float = 60.0) -> flexsc.Scenario:
    unit = Appendage(
        name="wheel unit",
        mass=0.95,
        inertia=np.diag([ACROSS, SPIN, ACROSS]).tolist(),
        at=[0.1, 0.0, -0.2],
        points=[NamedPoint(name="rotor")],
        mount=Mount(translation=140.0, rocking=190.0, damping=0.0 if hub > 1e6 else 0.06, axis=[0, 1, 0]),
    )
    wheels = Wheels(
        axes=[[0, 1, 0], [0, 0, 1], [1, 0, 0]],
        inertia=SPIN,
        points=["rotor", "hub", "hub"],
        speeds=[SPEED, 0, 0],
        speed_limit=600.0,
        imbalance=Imbalance(static=[3e-6, 0, 0]),
    )
    return flexsc.Scenario(
        duration=1.0,
        spacecraft=Spacecraft(
            mass=hub, inertia=np.diag([hub / 10] * 3).tolist(), points=[NamedPoint(name="hub")]
        ),
        appendage=[unit],
        line_of_sight=[LineOfSight(point="hub", period=0.01)],
        law=AttitudeLaw(period=0.1, bandwidth=0.1),
        actuator=wheels,
    )


def test_whirl_on_a_base_that_does_not_move() -> None:
    poles = bench(1e10).poles(SPEED)["frequency"]
    half = SPIN * SPEED / (2 * ACROSS)
    for expected in np.sqrt(half**2 + 190.0**2) + half * np.array([-1, 1]):
        assert np.abs(poles / expected - 1).min() < 1e-9


def test_the_worst_mount_has_the_least_damping() -> None:
    ranges = {"appendage[0].mount.damping": {"uniform": [0.02, 0.08]}}
    worst = bench().with_("uncertain", ranges).worst(signal="line_of_sight0_y", points=20)
    assert worst.keys["appendage[0].mount.damping"] == 0.02
    assert worst.value > worst.nominal


def test_frames_of_a_camera(tmp_path: Path) -> None:
    """A frame is the mean of the samples of its exposure, of which the first and the last count half."""
    scenario = bench().with_({"line_of_sight[0].period": 0.001, "log.period": 0.01})
    scenario.simulate(log="full").to_mcap(tmp_path / "run.mcap")
    log = flexsc.read_log(tmp_path / "run.mcap")
    frames, lines = log.frames(20.0, 0.005)
    assert len(frames["time_s"]) == 20
    samples = log["line_of_sight"]["axes.error_rad"].reshape(-1, 3)
    for place in (0, 7, 19):
        own = samples[50 * place : 50 * place + 6, 1]
        mean = (own.sum() - (own[0] + own[-1]) / 2) / 5
        assert abs(frames["mean_y_rad"][place] - mean) < 1e-9 * np.abs(samples[:, 1]).max()
    assert lines
    assert all(0 <= own["lands_at_hz"] <= 10 for own in lines)
    with pytest.raises(ValueError, match="frames: each frame must have two samples"):
        log.frames(1e9)
