"""Golden numbers of tests/open_loops.rs and tests/margins.rs, with flexsc and SciPy installed.

`open_loop_assembly.py` assembles the opened loops with NumPy and the exponentials of SciPy; their responses
are solved for here. Each row of `open_loops.csv` has
a scenario, the break, and either `refused`, or the number of states, the period, the spectral radius of the
closed loop, and the response L v with v = (1, 1/2, 1/3, ...) at a fraction of the Nyquist frequency: real and
imaginary parts, output by output. `open_loops/` has the scenarios that are not shipped. The loops of the
wheel study are assembled without flexsc, by wheel_loop_reference.py.

`margins.csv` has the margins of each command with the other loops closed, by bisection of the poles of loops
whose gain or phase is off.
"""

from pathlib import Path

import flexsc
import numpy as np
from open_loop_assembly import margins as margins_of
from open_loop_assembly import open_loop
from wheel_loop_reference import LOOPS
from wheel_loop_reference import margin_rows as wheel_margins
from wheel_loop_reference import open_loop_rows as wheel_loops

ROOT = Path(__file__).parents[2]
OWN = ROOT / "tests/golden/open_loops"
# Fractions of the Nyquist frequency of the whole loop.
FRACTIONS = (0.0031, 0.043, 0.31, 0.89)
BREAKS = ("command", "torque", "measurement")

PLANAR = """
duration = 30.0
[law.pd]
k_p = 20.0
k_d = 125.0
period = 0.5
[sensor.sampled]
period = 0.5
[actuator.wheel]
gain = 2.0
delay = 0.7
[estimator.kalman]
angle_noise = 2e-5
moment_noise = 1e-8
feeds = "rigid"
[body.planar]
inertia = 250.0
angle = 1e-3
modes = [{ frequency = 1.3, gain = 0.4, damping = 0.01 }, { frequency = 4.0, gain = 0.2, damping = 0.005 }]
"""


def variants() -> dict[str, flexsc.Scenario]:
    """Scenarios with parts that the shipped ones do not have."""
    planar = flexsc.Scenario.parse(PLANAR)
    wheel = flexsc.Scenario.example("wheel-fast-mode")
    observer = flexsc.Scenario.example("earth-observer")
    clamped = flexsc.Scenario.example("four-clamped-modes")
    rng = np.random.default_rng(3)
    gains = np.diag([2.0, 3.0, 4.0])
    compensator = {
        "period": 0.5,
        "a": (0.5 * np.eye(2) + 0.1 * rng.standard_normal((2, 2))).tolist(),
        "b": (0.1 * rng.standard_normal((2, 6))).tolist(),
        "c": (0.1 * rng.standard_normal((3, 2))).tolist(),
        "d": np.hstack([gains, 20.0 * gains]).tolist(),
        "inputs": ["quaternion_x", "pitch", "yaw", "roll_rate", "pitch_rate", "yaw_rate"],
        "outputs": ["yaw", "roll", "pitch"],
        "gain": 1.5,
        "of": "tustin",
    }
    filters = [{"notch": {"frequency": 1.1, "depth": 0.1}}, {"low_pass": {"frequency": 6.0}}]
    integral = {"time": 60.0, "limit": 0.01}
    return {
        "kalman-late": planar,
        "kalman-hub": planar.with_("estimator.kalman.feeds", "hub"),
        "difference-late": wheel.with_(
            {"actuator.wheel.delay": 0.12, "law.pd.differentiation": "difference"}
        ),
        "compensator": clamped.with_("law", {"state_space": compensator}),
        "accelerations": clamped.with_("law", {"state_space": compensator | {"command": "acceleration"}}),
        "observer-late": observer.with_(
            {
                "law.attitude.filters": filters,
                "law.attitude.integral": integral,
                "actuator": {"wheel": {"gain": 1.0, "delay": 0.3}},
            }
        ),
        "observer-slow-gyro": observer.with_(
            {"sensor[0].gyro.period": 0.2, "sensor[1].star_tracker.latency": 0.7}
        ),
    }


def rows(name: str, scenario: flexsc.Scenario) -> list[str]:
    lines = []
    for loop in BREAKS:
        try:
            opened = open_loop(scenario, loop)
        except ValueError:
            lines.append(f"{name},{loop},refused")
            continue
        v = 1.0 / np.arange(1, len(opened.inputs) + 1)
        radius = opened.closed().spectral_radius()
        for fraction in FRACTIONS:
            values = opened.response([fraction * np.pi / opened.period])[0] @ v
            numbers = " ".join(f"{part!r}" for value in values.tolist() for part in (value.real, value.imag))
            lines.append(f"{name},{loop},{len(opened.a)},{opened.period!r},{radius!r},{fraction},{numbers}")
    return lines


def margin_rows(name: str, scenario: flexsc.Scenario) -> list[str]:
    lines = []
    try:
        opened = open_loop(scenario, "command")
    except ValueError:
        return lines
    if opened.closed().spectral_radius() < 1.0:
        for command in dict.fromkeys(signal.name.rstrip("_0123456789") for signal in opened.inputs):
            lines.append(",".join([name, command, *map(repr, margins_of(opened, [command]))]))
    return lines


def main() -> None:
    OWN.mkdir(exist_ok=True)
    lines = ["scenario,loop,states,period_s,spectral_radius,fraction,response"]
    margins = ["scenario,command,gain_below,gain_above,phase_rad"]
    for path in sorted((ROOT / "scenarios").glob("*.toml")):
        if path.stem in LOOPS:
            continue
        lines += rows(path.stem, flexsc.Scenario.load(path))
        margins += margin_rows(path.stem, flexsc.Scenario.load(path))
    for name, scenario in variants().items():
        (OWN / f"{name}.toml").write_text(scenario.to_toml())
    for path in sorted(OWN.glob("*.toml")):
        if path.stem in LOOPS:
            continue
        lines += rows(path.stem, flexsc.Scenario.load(path))
        margins += margin_rows(path.stem, flexsc.Scenario.load(path))
    lines += wheel_loops()
    margins += wheel_margins()
    (ROOT / "tests/golden/open_loops.csv").write_text("\n".join(lines) + "\n")
    (ROOT / "tests/golden/margins.csv").write_text("\n".join(margins) + "\n")


if __name__ == "__main__":
    main()
