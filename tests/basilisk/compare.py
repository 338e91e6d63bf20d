"""The spacecraft of craft.toml in Basilisk and in flexsc: how far they are apart, and how long they take.

    cargo build --release
    python3 -m venv target/basilisk && target/basilisk/bin/pip install bsk numpy
    target/basilisk/bin/python tests/basilisk/compare.py

Basilisk takes the panels as rigid bodies on hinges, with all that large angles do, in steps of Runge and
Kutta's method of order 4. flexsc takes them as hinges too, and as the clamped modes of these with their
first moments.

- `tumble`: nothing acts and the wheels turn freely, for 200 s at 0.006 to 0.06 of the lowest frequency. With
  hinges the step error of Basilisk is left. With modes what is left grows as the fourth power of that part,
  for modes are linear.
- `slew`: the motors' torques of a slew of 54 degrees, as flexsc's law has commanded them, are given to
  Basilisk 4 times a second.
- `pointing`: so are those of 600 s of fine pointing, from small rates.

It ends with 1 if they are further apart than the limits below.
"""

import argparse
import csv
import io
import math
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import tomllib
from Basilisk.architecture import messaging
from Basilisk.simulation import (
    hingedRigidBodyStateEffector,
    reactionWheelStateEffector,
    spacecraft,
)
from Basilisk.utilities import SimulationBaseClass, macros, simIncludeRW

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
STUDY = tomllib.loads((HERE / "craft.toml").read_text())
CONTROL = STUDY["law"]["attitude"]["period"]
SPIN = STUDY["actuator"]["wheels"]["inertia"]
# Rates (rad/s) and absolute momenta of the wheels (N m s) of a tumble, for a scale of 1.
RATE, MOMENTA = np.array([0.04, 0.05, -0.03]), np.array([2.0, -1.0, 0.5, 1.5])
# Largest angles between the attitudes (rad): with modes 0.4 (|w|/W)^4 in 200 s of a tumble, by experience;
# with hinges what Basilisk's step of 12.5 ms leaves, and its rounding.
LIMITS = {
    "modes": {"tumble 0.1": 1e-9, "tumble 0.3": 1e-7, "tumble 1": 1e-5, "slew": 2e-8, "pointing": 1e-10},
    "hinges": {"tumble 0.1": 1e-12, "tumble 0.3": 1e-11, "tumble 1": 1e-10, "slew": 5e-12, "pointing": 1e-12},
}
POINTING = {"duration": 600.0, "target": "[]", "spacecraft.rate": [2e-5, -1e-5, 3e-5]}


def rotation(about, by):
    """The matrix of a rotation by an angle about an axis of the frame."""
    axis = int(np.argmax(about))
    cos, sin = math.cos(by), math.sin(by)
    one, two = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.eye(3)
    matrix[one, one] = matrix[two, two] = cos
    matrix[two, one], matrix[one, two] = sin, -sin
    return matrix


def axes():
    """The axes of the wheels, a row each."""
    cant = STUDY["actuator"]["wheels"]["cant"]
    around = [math.radians(angle) for angle in (45, 135, 225, 315)]
    return np.array(
        [[math.cos(cant) * math.cos(a), math.cos(cant) * math.sin(a), math.sin(cant)] for a in around]
    )


def column(vector):
    return [[float(value)] for value in vector]


def panels():
    """Basilisk's panels: h2 is the axis of the hinge, our x; the panel stretches along -h1, our y."""
    for appendage in STUDY["appendage"]:
        turned = appendage["turned"]
        matrix = np.eye(3)
        for turn in turned if isinstance(turned, list) else [turned]:
            matrix = matrix @ rotation(turn["about"], turn["by"])
        mode, (xx, yy, zz) = appendage["modes"][0], np.diag(appendage["inertia"])
        arm, about = appendage["centre"][1], inertia(appendage)
        panel = hingedRigidBodyStateEffector.HingedRigidBodyStateEffector()
        panel.mass, panel.d = appendage["mass"], arm
        panel.IPntS_S = np.diag([yy, xx, zz]).tolist()
        panel.r_HB_B = column(appendage["at"])
        panel.dcm_HB = np.array([-matrix[:, 1], matrix[:, 0], matrix[:, 2]]).tolist()
        panel.k = mode["frequency"] ** 2 * about
        panel.c = 2 * mode["damping"] * mode["frequency"] * about
        yield panel


def basilisk(step, rate, speeds, torques=None):
    """The attitude quaternions (w, x, y, z) each second, and the CPU time (s)."""
    simulation = SimulationBaseClass.SimBaseClass()
    process = simulation.CreateNewProcess("dynamics")
    process.addTask(simulation.CreateNewTask("task", macros.sec2nano(step)))
    craft = spacecraft.Spacecraft()
    hub = STUDY["spacecraft"]
    craft.hub.mHub = hub["mass"]
    craft.hub.r_BcB_B = column(hub["centre"])
    craft.hub.IHubPntBc_B = [[float(x) for x in row] for row in hub["inertia"]]
    craft.hub.omega_BN_BInit = column(rate)
    parts = list(panels())
    for panel in parts:
        craft.addStateEffector(panel)
    wheels, factory = reactionWheelStateEffector.ReactionWheelStateEffector(), simIncludeRW.rwFactory()
    for axis, speed in zip(axes(), speeds, strict=True):
        factory.create(
            "custom",
            axis,
            Omega=speed / macros.RPM,
            Js=SPIN,
            useMaxTorque=False,
            RWModel=messaging.BalancedWheels,
        )
    factory.addToSpacecraft("wheels", wheels, craft)
    command = messaging.ArrayMotorTorqueMsg().write(messaging.ArrayMotorTorqueMsgPayload())
    wheels.rwMotorCmdInMsg.subscribeTo(command)
    for model in (wheels, craft, *parts):
        simulation.AddModelToTask("task", model)
    seen = craft.scStateOutMsg.recorder(macros.sec2nano(1.0))
    simulation.AddModelToTask("task", seen)
    simulation.InitializeSimulation()
    began = time.process_time()
    if torques is None:
        simulation.ConfigureStopTime(macros.sec2nano(STUDY["duration"]))
        simulation.ExecuteSimulation()
    else:
        for index, torque in enumerate(torques):
            payload = messaging.ArrayMotorTorqueMsgPayload()
            payload.motorTorque = [*torque, *([0.0] * 32)]
            command.write(payload, simulation.TotalSim.CurrentNanos)
            # A step reads the command at its end: that of a period holds from after its start up to its end.
            simulation.ConfigureStopTime(macros.sec2nano((index + 1) * CONTROL))
            simulation.ExecuteSimulation()
    took = time.process_time() - began
    sigma = np.array(seen.sigma_BN)
    square = (sigma**2).sum(axis=1, keepdims=True)
    return np.hstack([1 - square, 2 * sigma]) / (1 + square), took


def inertia(appendage):
    """Moment of inertia of a panel about its hinge."""
    return appendage["inertia"][0][0] + appendage["mass"] * appendage["centre"][1] ** 2


def hinged(text):
    """The scenario with panels on hinges in the place of their modes."""
    lines, panels = [], iter(STUDY["appendage"])
    for line in text.splitlines():
        if line.startswith("modes"):
            panel = next(panels)
            mode, about = panel["modes"][0], inertia(panel)
            stiffness = mode["frequency"] ** 2 * about
            damping = 2 * mode["damping"] * mode["frequency"] * about
            line = f"hinge = {{ about = [1, 0, 0], stiffness = {stiffness!r}, damping = {damping!r} }}"
        if not line.startswith("plate"):
            lines.append(line)
    return "\n".join(lines)


def flexsc(program, panels, changes):
    """The tables of a run, and its time (s)."""
    settings = [word for key, value in changes.items() for word in ("--set", f"{key}={value}")]
    text = (HERE / "craft.toml").read_text()
    with tempfile.TemporaryDirectory() as directory:
        (Path(directory) / "craft.toml").write_text(hinged(text) if panels == "hinges" else text)
        run = [program, "simulate", "craft.toml", *settings]
        subprocess.run([*run, "--log", "full"], cwd=directory, check=True, capture_output=True)

        def table(topic):
            out = subprocess.run(
                [program, "export", "craft.mcap", "--topic", topic],
                cwd=directory,
                check=True,
                capture_output=True,
                text=True,
            )
            return list(csv.DictReader(io.StringIO(out.stdout)))

        pointing, wheels = table("/pointing"), table("/wheels")
        times = []
        for _ in range(25):
            told = subprocess.run(
                [*run, "--log", "none"], cwd=directory, check=True, capture_output=True, text=True
            )
            number, unit = re.search(r"([0-9.]+) (ms|s|µs)\n", told.stdout + told.stderr).groups()
            times.append(float(number) * {"s": 1.0, "ms": 1e-3, "µs": 1e-6}[unit])
    return pointing, wheels, min(times)


def quaternions(pointing):
    every = round(1 / CONTROL)
    return np.array(
        [[float(row[name]) for name in ("q_w", "q_x", "q_y", "q_z")] for row in pointing[::every]]
    )


def apart(a, b):
    """The largest angle between attitudes (rad)."""
    count = min(len(a), len(b))
    a, b = a[:count], b[:count]
    vector = a[:, :1] * b[:, 1:] - b[:, :1] * a[:, 1:] - np.cross(a[:, 1:], b[:, 1:])
    return float(2 * np.linalg.norm(vector, axis=1).max())


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--flexsc", default=str(ROOT / "target" / "release" / "flexsc"), help="the command")
    options.add_argument(
        "--steps", type=float, nargs="+", default=[0.05, 0.025, 0.0125], help="Basilisk's steps (s)"
    )
    program = options.parse_args()
    failed = []
    cases = [(f"tumble {scale:g}", scale) for scale in (0.1, 0.3, 1.0)] + [("slew", 0.0), ("pointing", 0.0)]
    for name, scale in cases:
        rate, torques = scale * RATE, None
        points = name == "pointing"
        if scale > 0:
            speeds = scale * MOMENTA / SPIN - axes() @ rate
            changes = {
                "spacecraft.rate": rate.tolist(),
                "actuator.wheels.speeds": speeds.tolist(),
                "law": "{ open = {} }",
                "target": "[]",
            }
        else:
            speeds = np.array(STUDY["actuator"]["wheels"]["speeds"], dtype=float)
            changes = POINTING if points else {}
            rate = np.array(POINTING["spacecraft.rate"]) if points else rate
        for panels, limits in LIMITS.items():
            pointing, wheels, own = flexsc(program.flexsc, panels, changes)
            print(f"{name}, {panels}: flexsc {own * 1e3:.3g} ms")
            if scale == 0:
                motors = [f"wheels[{wheel}].torque_nm" for wheel in range(4)]
                torques = [[float(row[motor]) for motor in motors] for row in wheels[:-1]]
            exact, before = quaternions(pointing), None
            for step in program.steps:
                found, took = basilisk(step, rate, speeds, torques)
                distance = apart(exact, found)
                halved = "" if before is None else f", {apart(before, found):.1e} rad from the step before"
                print(
                    f"  Basilisk, steps of {step:g} s: {distance:.1e} rad apart{halved}; {took:.3g} s, "
                    f"{took / own:.0f} times as long"
                )
                before = found
            if distance > limits[name]:
                failed.append(f"{name} with {panels}")
    if failed:
        sys.exit(f"further apart than they may be: {', '.join(failed)}")


if __name__ == "__main__":
    main()
