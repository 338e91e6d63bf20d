"""`python -m flexsc.structure`: a MATLAB file of A, B and C as a scenario, checked by its own response."""

from __future__ import annotations

import argparse
import sys
import time
from importlib import import_module
from pathlib import Path
from typing import Any

from flexsc._numpy import np
from flexsc.structure._files import write_scenario
from flexsc.structure._modal_model import StateSpace
from flexsc.structure._state_space import from_state_space
from flexsc.structure._structure import AXES

# Assumed of the rigid body, which such a file does not contain: kg m², N, m.
INERTIA = (1e6, 1e7, 1e7)
THRUST, ARM = 260.0, (2.0, 12.0, 12.0)


def main(arguments: list[str] | None = None) -> int:
    """Run the command with these arguments, and return its exit code."""
    parser = argparse.ArgumentParser(
        prog="python -m flexsc.structure",
        description="Modes of a state-space model in a MATLAB file (A, B, C).",
    )
    parser.add_argument("file", help="such as iss.mat of the SLICOT collection")
    parser.add_argument(
        "--check", action="store_true", help="compare with `mag` at `w`, and run a closed loop"
    )
    parser.add_argument("-o", metavar="FILE", help="write a scenario here, its modes beside it as CSV")
    parser.add_argument(
        "--inertia",
        type=float,
        nargs=3,
        default=INERTIA,
        metavar=tuple("XYZ"),
        help="moments of inertia (kg m²)",
    )
    parser.add_argument("--thrust", type=float, default=THRUST, help="of each jet (N)")
    parser.add_argument(
        "--arm", type=float, nargs=3, default=ARM, metavar=tuple("XYZ"), help="of the jets (m)"
    )
    parser.add_argument("--unit", type=float, help="force of a unit of input (N); left out, the thrust")
    parser.add_argument("--duration", type=float, default=6000.0, help="simulated time (s)")
    given = parser.parse_args(arguments)
    try:
        found = import_module("scipy.io").loadmat(given.file)
        model = from_state_space(found["A"], found["B"], found["C"], found.get("D"))
    except KeyError as error:
        print(f"{given.file}: must have {error}", file=sys.stderr)
        return 2
    except (ImportError, OSError, ValueError) as error:
        print(f"{given.file}: {error}", file=sys.stderr)
        return 2
    low, high = model.frequencies[[0, -1]]
    print(f"{Path(given.file).name}: {len(model.frequencies)} modes of {low:.4g} to {high:.4g} rad/s")
    print(f"  transfer function of the matrices   off by {model.deviation:.1e} at the most")
    x, y, z = given.inertia
    scenario = model.scenario(
        [[x, 0, 0], [0, y, 0], [0, 0, z]],
        thrust=given.thrust,
        arm=dict(zip(AXES, given.arm, strict=True)),
        unit=given.unit or given.thrust,
        jets={"minimum_on": 0.05, "quantum": 0.01, "delay": 1},
        gyro={"noise": [2e-6] * 3, "resolution": [1e-6] * 3},
        law={"targets": [{"from": 10.0, "roll": 0.01, "pitch": 0.02, "yaw": 0.05}]},
        duration=given.duration,
        name=Path(given.o or given.file).stem,
    )
    if given.check:
        if {"w", "mag"} <= set(found):
            print(_summary(model, found))
        began = time.process_time()
        run = scenario.simulate(log="none")
        spent = time.process_time() - began
        pulses, speed = run.metrics["firings"], given.duration / spent
        print(
            f"  closed loop of {given.duration:g} s, {pulses} pulses   {spent:.3f} s of CPU time: "
            f"{speed:.0f} times faster than real time"
        )
    if given.o:
        table = write_scenario(scenario, given.o)
        print(f"  {given.o}, {table}")
    return 0


def _summary(model: StateSpace, found: dict[str, Any]) -> str:
    """How far the response is from the file's magnitudes: a row a frequency, the outputs for each input."""
    frequencies, magnitudes = found["w"].ravel(), np.asarray(found["mag"])
    own = np.abs(model.response(frequencies)).transpose(0, 2, 1).reshape(len(frequencies), -1)
    if own.shape != magnitudes.shape:
        return f"  `mag` has shape {magnitudes.shape}, and not {own.shape}: it is not compared"
    off = np.abs(own / magnitudes - 1.0)
    return f"  `mag` at {len(frequencies)} frequencies   off by {off.max():.1e} at the most"


if __name__ == "__main__":
    sys.exit(main())
