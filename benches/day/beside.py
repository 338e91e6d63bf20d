"""A day of a CubeSat in flexsc, Basilisk and 42, interleaved: the rows of docs/benchmarks.md.

pip install bsk; cargo build --release
FORTY_TWO=path/of/42 python3 benches/day/beside.py  # a built 42 whose SandboxFSW is that of nadir_law.c

A peer that is not there is left out with a line. CPU time is user time, the least of three runs, or of one
with steps of 0.1 s: of the whole process of flexsc and of 42, both with their files, and of Basilisk without
the start of Python. It ends with 1 if the attitudes, positions or momenta of the wheels in an orbit are
further apart than LIMITS. `FLEXSC` names another command.
"""

import csv
import io
import json
import os
import resource
import subprocess
import sys
import tempfile
from math import dist, sqrt
from pathlib import Path

import tomllib

HERE = Path(__file__).resolve().parent
FLEXSC = os.environ.get("FLEXSC", HERE.parent.parent / "target" / "release" / "flexsc")
HOME = os.environ.get("FORTY_TWO")
DAY, ORBIT, RUNS = 86400, 5740, 3
# Largest differences from flexsc in an orbit: rad, m, N m s.
LIMITS = {
    "Basilisk": (4e-7, 2.0, 1e-7),
    "Basilisk, panels": (4e-7, 2.0, 1e-7),
    "42": (1e-5, 5.0, 6e-6),
    "42, no drag": (1e-6, 5.0, 1.5e-6),
}


def flexsc(duration, *settings, wings=False):
    """Flies the study with a full log: what the scripts of the others print."""
    text = (HERE / "nadir.toml").read_text()
    if wings:
        more = (HERE / "panels.toml").read_text()
        hub = tomllib.loads(more)["spacecraft"]
        text += more[more.index("[[appendage]]") :]
        settings += tuple(f"spacecraft.{key}={value}" for key, value in hub.items())
    with tempfile.TemporaryDirectory() as name:
        place = Path(name)
        (place / "day.toml").write_text(text)
        command = [FLEXSC, "simulate", place / "day.toml", "--log", "full", "-o", place]
        for setting in (f"duration={duration}", *settings):
            command += ["--set", setting]
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        subprocess.run(command, capture_output=True, check=True)
        cpu = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before

        def rows(topic, *columns):
            command = [FLEXSC, "export", place / "day.mcap", "--topic", topic]
            table = subprocess.run(command, capture_output=True, text=True, check=True).stdout
            return [[float(row[column]) for column in columns] for row in csv.DictReader(io.StringIO(table))]

        return {
            "cpu_s": cpu,
            "attitude": rows("/pointing", "q_w", "q_x", "q_y", "q_z"),
            "position": rows("/orbit", *(f"axes[{axis}].position_m" for axis in range(3))),
            "momentum": rows("/wheels", *(f"wheels[{wheel}].momentum_nm_s" for wheel in range(3))),
        }


def script(name, *arguments):
    """Runs a script of another program, whose last line is the result; None if the program is not there."""
    command = [sys.executable, HERE / name, *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        why = (done.stderr.splitlines() or [f"exit code {done.returncode}"])[-1]
        print(f"{name} {' '.join(command[2:])}: {why}", file=sys.stderr)
        return None
    return json.loads(done.stdout.splitlines()[-1])


def basilisk(duration, step, *options):
    return script("in_basilisk.py", duration, step, *options)


def forty_two(duration, step, *options):
    return script("in_42.py", HOME, duration, step, *options) if HOME else None


def apart(one, other):
    """Largest differences of two runs: attitude (rad), position (m), momentum of the wheels (N m s)."""

    def turn(p, q):
        sign = 1 if sum(a * b for a, b in zip(p, q, strict=True)) > 0 else -1
        return 2 * sqrt(sum((a - sign * b) ** 2 for a, b in zip(p, q, strict=True)))

    if abs(len(one["attitude"]) - len(other["attitude"])) > 1:
        raise SystemExit(f"{len(one['attitude'])} rows beside {len(other['attitude'])}")

    def largest(name, by):
        return max(by(a, b) for a, b in zip(one[name], other[name], strict=False))

    return largest("attitude", turn), largest("position", dist), largest("momentum", dist)


def differences():
    """The table of the differences from flexsc in an orbit; ends the program if they are beyond LIMITS."""
    cases = {
        "Basilisk": (lambda: basilisk(ORBIT, 0.5), ()),
        "Basilisk, panels": (lambda: basilisk(ORBIT, 0.1, "panels"), ()),
        "42": (lambda: forty_two(ORBIT, 0.5), ()),
        "42, no drag": (lambda: forty_two(ORBIT, 0.5, "without-drag"), ("environment.drag.scale=0.001",)),
    }
    lines = ["| largest difference from flexsc in an orbit | attitude | position | momentum of the wheels |"]
    lines += ["|---|---|---|---|"]
    for name, (fly, settings) in cases.items():
        if other := fly():
            found = apart(flexsc(ORBIT, *settings, wings="panels" in name), other)
            if any(value > limit for value, limit in zip(found, LIMITS[name], strict=True)):
                raise SystemExit(f"{name}: {found} apart, more than {LIMITS[name]} (rad, m, N m s)")
            turn, way, momentum = found
            row = f"| {name} | {turn:.1e} rad | {way:.2g} m | {momentum:.1e} N m s |"
            lines.append(row.replace("e-0", "e-"))
    return lines if len(lines) > 2 else []


def table():
    """Text of both tables."""
    apart_by = differences()
    studies = {
        "flexsc": lambda: flexsc(DAY),
        "Basilisk, steps of 0.5 s": lambda: basilisk(DAY, 0.5),
        "Basilisk, steps of 0.1 s": lambda: basilisk(DAY, 0.1),
        "42, steps of 0.5 s": lambda: forty_two(DAY, 0.5),
        "42, steps of 0.1 s": lambda: forty_two(DAY, 0.1),
        "flexsc, panels": lambda: flexsc(DAY, wings=True),
        "Basilisk, panels, steps of 0.1 s": lambda: basilisk(DAY, 0.1, "panels"),
    }
    found = {name: [] for name in studies}
    for run in range(RUNS):
        for name, study in studies.items():
            result = study() if run == 0 or "0.1 s" not in name else None
            found[name] += [result["cpu_s"]] if result else []
    lines = ["| a day of a CubeSat | CPU time | ratio |", "|---|---|---|"]
    for name, times in found.items():
        whole = min(found["flexsc, panels" if "panels" in name else "flexsc"])
        cells = (f"{min(times):.2g} s", f"{min(times) / whole:.2g}") if times else ("not there", "")
        lines.append(f"| {name} | {cells[0]} | {cells[1]} |")
    return "\n".join([*lines, "", *apart_by]) + "\n"


if __name__ == "__main__":
    print(table())
