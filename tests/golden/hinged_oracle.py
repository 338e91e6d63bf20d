"""Two panels on hinges, far from their rest, and one on a drive: hinged.toml and hinged.csv.

    pip install numpy scipy
    python3 tests/golden/hinged_oracle.py tests/golden

Newton's and Euler's equations of four rigid bodies, projected onto the speeds that are free: the hub's place,
its rotation and the angles of the hinges. No momentum, no mode and no kinetic energy is formed. DOP853 with a
relative tolerance of 1e-13, from each change of what acts to the next.

hinged.csv has a line each half second: t, Q (4), w (3), angles (2), rates of the hinges (2), the place of
the hub's point O from the start (3).
"""

import itertools
import sys
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

DURATION = 40.0
HUB = {
    "mass": 200.0,
    "centre": np.array([0.05, -0.02, 0.1]),
    "inertia": np.array([[90.0, 6, -4], [6, 100, 5], [-4, 5, 80]]),
}
PANELS = [
    {
        "mass": 18.0,
        "root": np.array([0.1, 0.6, 0.2]),
        "centre": np.array([0.2, 1.9, 0.1]),
        "inertia": np.array([[18.0, -0.3, 0.1], [-0.3, 3.0, 0.2], [0.1, 0.2, 20.5]]),
        "turned": np.eye(3),
        "about": np.array([1.0, 0.2, -0.1]),
        "stiffness": 70.0,
        "damping": 0.8,
        "start": (0.5, 0.05),
    },
    {
        "mass": 15.0,
        "root": np.array([0.0, -0.6, 0.2]),
        "centre": np.array([-0.1, 1.7, 0.0]),
        "inertia": np.array([[14.0, 0.2, 0.0], [0.2, 2.5, -0.1], [0.0, -0.1, 16.0]]),
        "turned": np.diag([-1.0, -1.0, 1.0]),
        "about": np.array([0.0, 0.0, 1.0]),
        "stiffness": 95.0,
        "damping": 0.0,
        "start": (-0.4, 0.1),
    },
]
DRIVEN = {
    "mass": 12.0,
    "root": np.array([0.5, 0.0, -0.1]),
    "centre": np.array([1.2, 0.2, 0.1]),
    "inertia": np.array([[2.0, 0.1, 0.0], [0.1, 9.0, 0.1], [0.0, 0.1, 10.0]]),
    "turned": np.eye(3),
    "about": np.array([1.0, 0.0, 0.5]),
}
DRIVE, BEGINS = 0.04, 0.2
RATE = np.array([0.05, -0.08, 0.06])
SPIN, SPEED = 0.05, 60.0
TORQUE = np.array([0.0, 0.5, 0.0])
FORCE, AT = np.array([3.0, 1.0, -2.0]), np.array([0.4, 0.3, 0.2])
FORCED = (6.0, 9.0)
# Three wheels across each other, of which one spins, with what they have of the hub's rate; its inertia
# has them locked.
WHEELS = SPIN * (np.array([0.0, 0.0, SPEED]) + RATE)
BARE = HUB["inertia"] - SPIN * np.eye(3)


def cross_matrix(v):
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def turn(axis, angle):
    k = cross_matrix(axis)
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * (k @ k)


def placed(panel, angle):
    """Axis, arm and inertia of a panel in the hub's axes."""
    own = panel["about"] / np.linalg.norm(panel["about"])
    matrix = panel["turned"] @ turn(own, angle)
    return panel["turned"] @ own, matrix @ panel["centre"], matrix @ panel["inertia"] @ matrix.T


def residual(t, w, angles, speeds, torque, force, moves):
    """What forces, moments about O and torques of hinges lack, for these accelerations."""
    a, alpha, bends = moves[:3], moves[3:6], moves[6:]
    centre = HUB["centre"]
    moved = HUB["mass"] * (a + np.cross(alpha, centre) + np.cross(w, np.cross(w, centre)))
    pushed = moved - force
    turned = np.cross(centre, moved) + BARE @ alpha + np.cross(w, BARE @ w + WHEELS)
    turned = turned - torque - np.cross(AT, force)
    hinges = []
    bodies = [*zip(PANELS, angles, speeds, bends, strict=True), (DRIVEN, BEGINS + DRIVE * t, DRIVE, 0.0)]
    for panel, angle, speed, bend in bodies:
        axis, arm, inertia = placed(panel, angle)
        rate = w + speed * axis
        change = alpha + bend * axis + speed * np.cross(w, axis)
        root = a + np.cross(alpha, panel["root"]) + np.cross(w, np.cross(w, panel["root"]))
        moved = panel["mass"] * (root + np.cross(change, arm) + np.cross(rate, np.cross(rate, arm)))
        spun = inertia @ change + np.cross(rate, inertia @ rate)
        pushed = pushed + moved
        turned = turned + np.cross(panel["root"] + arm, moved) + spun
        about = np.cross(arm, moved) + spun
        if panel is DRIVEN:
            continue
        hinges.append(axis @ about + panel["stiffness"] * angle + panel["damping"] * speed)
    return np.concatenate([pushed, turned, hinges])


def rotated(q, v):
    s, u = q[0], q[1:]
    return v + 2 * np.cross(u, np.cross(u, v) + s * v)


def slope(t, y, forced):
    q, velocity, w, angles, speeds = y[:4], y[7:10], y[10:13], y[13:15], y[15:17]
    force = FORCE if forced else np.zeros(3)
    none = residual(t, w, angles, speeds, TORQUE, force, np.zeros(8))
    matrix = np.array([residual(t, w, angles, speeds, TORQUE, force, unit) - none for unit in np.eye(8)]).T
    moves = np.linalg.solve(matrix, -none)
    s, u = q[0], q[1:]
    turned = 0.5 * np.concatenate([[-u @ w], s * w + np.cross(u, w)])
    return np.concatenate([turned, velocity, rotated(q, moves[:3]), moves[3:6], speeds, moves[6:]])


def start():
    angles, speeds = (np.array(of) for of in zip(*(panel["start"] for panel in PANELS), strict=True))
    # The centre of mass rests.
    momentum = HUB["mass"] * np.cross(RATE, HUB["centre"])
    mass = HUB["mass"]
    for panel, angle, speed in zip([*PANELS, DRIVEN], [*angles, BEGINS], [*speeds, DRIVE], strict=True):
        axis, arm, _ = placed(panel, angle)
        moved = np.cross(RATE, panel["root"]) + np.cross(RATE + speed * axis, arm)
        momentum, mass = momentum + panel["mass"] * moved, mass + panel["mass"]
    return np.concatenate([[1.0, 0, 0, 0], np.zeros(3), -momentum / mass, RATE, angles, speeds])


def main():
    folder = Path(sys.argv[1])
    times = np.linspace(0, DURATION, 81)
    edges, y, lines = [0.0, *FORCED, DURATION], start(), []
    for began, ends in itertools.pairwise(edges):
        within = times[(times >= began) & (times < ends)]
        forced = began == FORCED[0]
        ways = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-15, "t_eval": [*within, ends]}
        run = solve_ivp(lambda t, y, forced=forced: slope(t, y, forced), (began, ends), y, **ways)
        lines += list(zip(run.t[:-1], run.y.T[:-1], strict=True))
        y = run.y[:, -1]
    lines.append((DURATION, y))
    with (folder / "hinged.csv").open("w") as out:
        for t, y in lines:
            row = [t, *(y[:4] / np.linalg.norm(y[:4])), *y[10:13], *y[13:17], *y[4:7]]
            print(",".join(f"{value:.17g}" for value in row), file=out)
    (folder / "hinged.toml").write_text(scenario())


def listed(v):
    return "[" + ", ".join(listed(x) if np.ndim(x) else f"{float(x)!r}" for x in v) + "]"


def scenario():
    text = f"""# Two panels on hinges, far from their rest, and an antenna on a drive: by hinged_oracle.py.
duration = {DURATION}
[spacecraft]
mass = {HUB["mass"]}
centre = {listed(HUB["centre"])}
inertia = {listed(HUB["inertia"])}
rate = {listed(RATE)}
points = [{{ name = "O" }}, {{ name = "bus", position = {listed(AT)} }}]
"""
    for index, panel in enumerate(PANELS):
        turned = "" if index == 0 else "turned = { about = [0, 0, 1], by = 3.141592653589793 }\n"
        angle, rate = panel["start"]
        text += f"""[[appendage]]
name = "panel {index + 1}"
mass = {panel["mass"]}
centre = {listed(panel["centre"])}
inertia = {listed(panel["inertia"])}
at = {listed(panel["root"])}
{turned}hinge = {{ about = {listed(panel["about"])}, stiffness = {panel["stiffness"]}, \
damping = {panel["damping"]}, angle = {angle}, rate = {rate} }}
"""
    return (
        text
        + f"""[[appendage]]
name = "antenna"
mass = {DRIVEN["mass"]}
centre = {listed(DRIVEN["centre"])}
inertia = {listed(DRIVEN["inertia"])}
at = {listed(DRIVEN["root"])}
drive = {{ about = {listed(DRIVEN["about"])}, rate = {DRIVE}, angle = {BEGINS} }}
[[disturbance]]
about = "pitch"
torque = {TORQUE[1]}
[[disturbance]]
force = {listed(FORCE)}
point = "bus"
from = {FORCED[0]}
to = {FORCED[1]}
[law.open]
[actuator.wheels]
axes = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
inertia = {SPIN}
speeds = [{SPEED}, 0.0, 0.0]
torque = 0.1
[log]
period = 0.5
"""
    )


if __name__ == "__main__":
    main()
