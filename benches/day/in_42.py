"""The study of nadir.toml in 42: CPU time (s) of its run, pointing and wheels at its end, as JSON.

git clone https://github.com/ericstoneking/42
python3 benches/day/in_42.py 42 [STEP]  # STEP (s) of integration: 0.5

It builds 42 in that directory without graphics, with nadir_law.c in place of its SandboxFSW, writes the input
files into 42/Day from those of 42/InOut, and runs them.
"""

import json
import re
import resource
import shutil
import subprocess
import sys
from math import degrees, hypot, radians
from pathlib import Path

import tomllib

HERE = Path(__file__).resolve().parent
STUDY = tomllib.loads((HERE / "nadir.toml").read_text())
FLAGS = "-O2 -w -fpic -I Include/ -I Kit/Include/ -I Kit/Source/"


def build(home):
    """Builds 42 with the law, once."""
    source, marked = home / "Source" / "42fsw.c", "ShippedSandboxFSW"
    text = source.read_text()
    if marked not in text:
        text = text.replace("void SandboxFSW(struct SCType *S)\n{", f"void {marked}(struct SCType *S)\n{{")
        end = text.index("void FlightSoftWare(")
        source.write_text(text[:end] + (HERE / "nadir_law.c").read_text() + text[end:])
    make = ["make", "-s", "GUIFLAG=", "SHADERFLAG=", f"CFLAGS={FLAGS}", "42"]
    subprocess.run(make, cwd=home, check=True)


def edited(text, lines):
    """The text with other values in the lines whose comments begin with these words."""
    for comment, value in lines:
        pattern = rf"^.*?([ \t]*!?[ \t]*!\s*{re.escape(comment)})"
        text, count = re.subn(pattern, rf"{value}  \1", text, count=1, flags=re.MULTILINE)
        if not count:
            raise SystemExit(f"no line '{comment}'")
    return text


def blocks(text, title, count):
    """The text with the block of a part repeated `count` times, from its line of = to the next section."""
    found = re.search(rf"^(={{3,}}\s*{title}\s*0\s*=+\n)((?:(?!^[*=<]).*\n)+)", text, re.MULTILINE)
    return text[: found.start()] + found.group(0) * count + text[found.end() :]


def write(home, step):
    """Writes the input files."""
    case, shipped = home / "Day", home / "InOut"
    shutil.rmtree(case, ignore_errors=True)
    shutil.copytree(shipped, case)
    body, wheel, orbit = STUDY["spacecraft"], STUDY["actuator"]["wheels"], STUDY["environment"]["orbit"]
    text = edited(
        (shipped / "Inp_Sim.txt").read_text(),
        [
            ("Sim Duration", f"{STUDY['duration']} {step}"),
            ("File Output Interval", STUDY["log"]["period"]),
            ("Graphics Front End", "FALSE"),
            ("Date (UTC)", f"{STUDY['epoch']:%m %d %Y}"),
            ("Time (UTC)", f"{STUDY['epoch']:%H %M} 0.0"),
            ("IGRF Degree", "10 10"),
            ("Aerodynamic", "TRUE FALSE"),
            ("Gravity Gradient", "TRUE"),
            *((planet, "FALSE") for planet in ("Mercury", "Venus", "Mars and", "Jupiter", "Saturn")),
            *((planet, "FALSE") for planet in ("Uranus", "Neptune", "Pluto")),
        ],
    )
    (case / "Inp_Sim.txt").write_text(text)
    (case / "Inp_Cmd.txt").write_text("EOF\n")
    height = (orbit["semi_major_axis"] - 6378137.0) / 1e3
    text = edited(
        (shipped / "Orb_LEO.txt").read_text(),
        [
            ("Periapsis &", f"{height} {height}"),
            ("Inclination", degrees(orbit["inclination"])),
            ("Right Ascension", degrees(orbit["node"])),
            ("Argument of Periapsis (deg)", 0.0),
            ("True Anomaly", 0.0),
        ],
    )
    (case / "Orb_LEO.txt").write_text(text)
    text = (shipped / "SC_Simple.txt").read_text()
    for part in ("Wheel", "MTB"):
        text = blocks(text, part, 3)
    axes = [("Wheel Axis", f"{x} {y} {z}") for x, y, z in ((1, 0, 0), (0, 1, 0), (0, 0, 1))]
    text = edited(
        text,
        [
            ("Flight Software", "SANDBOX_FSW"),
            ("FSW Sample", STUDY["law"]["attitude"]["period"]),
            ("Ang Vel wrt", "NQN"),
            ("Ang Vel (deg", "0 0 0"),
            ("Drag Coefficient", STUDY["environment"]["drag"]["coefficient"]),
            ("Mass\n", body["mass"]),
            ("Moments of", " ".join(str(row[axis]) for axis, row in enumerate(body["inertia"]))),
            ("Location of mass center", f"0 0 {-STUDY['environment']['drag']['plates'][0]['at'][2]}"),
            ("Geometry Input", "Cubesat_6U.obj"),
            ("Number of wheels", 3),
            ("Number of MTBs", 3),
        ],
    )
    # The three blocks are equal so far: each gets an axis of its own, and the figures of all.
    parts = re.split(r"(?=^=+\s*(?:Wheel|MTB)\s+0)", text, flags=re.MULTILINE)
    for index, (_, axis) in enumerate(axes):
        momentum = f"{wheel['torque']} {wheel['momentum']}"
        lines = [("Wheel Axis", axis), ("Max Torque", momentum), ("Wheel Rotor", wheel["inertia"])]
        parts[1 + index] = edited(parts[1 + index], lines)
        moment = wheel["unloading"]["magnetorquers"]["moment"]
        parts[4 + index] = edited(parts[4 + index], [("Saturation", moment), ("MTB Axis", axis)])
    (case / "SC_Simple.txt").write_text("".join(parts))


def main():
    home, step = Path(sys.argv[1]).resolve(), float(sys.argv[2]) if len(sys.argv) > 2 else 0.5
    build(home)
    write(home, step)
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    subprocess.run(["./42", "Day"], cwd=home, check=True, stdout=subprocess.DEVNULL)
    cpu = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before

    def rows(name):
        lines = (home / "Day" / name).read_text().splitlines()
        return [[float(value) for value in line.split()] for line in lines]

    wheels = [hypot(*row) for row in rows("Hwhl.42")]
    found = {
        "cpu_s": cpu,
        "rows": len(wheels),
        "position_m": rows("PosN.42")[-1][:3],
        "error_rad": radians(hypot(*rows("RPY.42")[-1])),
        "momentum_nm_s": wheels[-1],
        "momentum_peak_nm_s": max(wheels),
    }
    print(json.dumps(found))


main()
