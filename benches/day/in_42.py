"""The study of nadir.toml in 42: user CPU time (s) of its run and its rows, as JSON.

python3 benches/day/in_42.py 42 DURATION STEP [without-drag]    # s, s of integration

The first argument is the directory of a built 42 whose SandboxFSW is that of nadir_law.c. It stays as it
is: the input files are those of its InOut with the study's values, and plates, in a directory of their own.
"""

import json
import re
import resource
import shutil
import subprocess
import sys
import tempfile
from math import degrees
from pathlib import Path

import tomllib

HERE = Path(__file__).resolve().parent
STUDY = tomllib.loads((HERE / "nadir.toml").read_text())
# The radius of the Earth in 42 (m); the solar activity F10.7 for which its NRLMSISE-00 has the study's
# density on the mean of an orbit, and the index Ap.
RADIUS, ACTIVITY, DISTURBED = 6378145.0, 145.0, 8.0


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


def geometry(plates):
    """The plates as an .obj file and its materials: squares whose corners turn left about their normals."""
    lines, faces = ["mtllib Day.mtl", "o plates"], []
    for plate in plates:
        axis = next(index for index, part in enumerate(plate["normal"]) if part)
        one, two, half = (axis + 1) % 3, (axis + 2) % 3, plate["area"] ** 0.5 / 2
        for left, up in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
            corner = list(plate["at"])
            corner[one] += plate["normal"][axis] * left * half
            corner[two] += up * half
            lines.append("v " + " ".join(f"{part:.9f}" for part in corner))
        first = 4 * len(faces) + 1
        faces.append("f " + " ".join(str(first + corner) for corner in range(4)))
    lines += ["usemtl PLATE", *faces]
    materials = "".join(
        f"newmtl {name}\nKd 0.5 0.5 0.5\nSpecFrac {plates[0]['specular']}\nDiffFrac 0.0\n\n"
        for name in ("default", "PLATE")
    )
    return "\n".join(lines) + "\n", materials


def write(home, place, duration, step, drag):
    """Writes a directory like that of 42 with the input files."""
    case, shipped = place / "Day", home / "InOut"
    for part in home.iterdir():
        if part.name not in ("Model", case.name):
            (place / part.name).symlink_to(part)
    shutil.copytree(shipped, case)
    (place / "Model").mkdir()
    for part in (home / "Model").iterdir():
        (place / "Model" / part.name).symlink_to(part)
    plates, materials = geometry(STUDY["environment"]["solar_pressure"]["plates"])
    (place / "Model" / "Day.obj").write_text(plates)
    (place / "Model" / "Day.mtl").write_text(materials)
    body, wheel, orbit = STUDY["spacecraft"], STUDY["actuator"]["wheels"], STUDY["environment"]["orbit"]
    text = edited(
        (shipped / "Inp_Sim.txt").read_text(),
        [
            ("Sim Duration", f"{duration} {step}"),
            ("File Output Interval", STUDY["log"]["period"]),
            ("Graphics Front End", "FALSE"),
            ("Date (UTC)", f"{STUDY['epoch']:%m %d %Y}"),
            ("Time (UTC)", f"{STUDY['epoch']:%H %M} 0.0"),
            ("IGRF Degree", "10 10"),
            ("USER-provided F10.7", ACTIVITY),
            ("USER-provided Ap", DISTURBED),
            ("Aerodynamic", "TRUE FALSE" if drag else "FALSE FALSE"),
            ("Gravity Gradient", "TRUE"),
            ("Solar Pressure", "TRUE FALSE"),
            *((planet, "FALSE") for planet in ("Mercury", "Venus", "Mars and", "Jupiter", "Saturn")),
            *((planet, "FALSE") for planet in ("Uranus", "Neptune", "Pluto")),
        ],
    )
    (case / "Inp_Sim.txt").write_text(text)
    (case / "Inp_Cmd.txt").write_text("EOF\n")
    height = (orbit["semi_major_axis"] - RADIUS) / 1e3
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
            ("Quaternion", " ".join(map(str, (*body["attitude"][1:], body["attitude"][0])))),
            ("Drag Coefficient", 2.2),
            ("Mass\n", body["mass"]),
            ("Moments of", " ".join(str(row[axis]) for axis, row in enumerate(body["inertia"]))),
            ("Geometry Input", "Day.obj"),
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
    home, duration, step = Path(sys.argv[1]).resolve(), float(sys.argv[2]), float(sys.argv[3])
    with tempfile.TemporaryDirectory() as name:
        place = Path(name)
        write(home, place, duration, step, "without-drag" not in sys.argv[4:])
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        subprocess.run(["./42", "Day"], cwd=place, check=True, stdout=subprocess.DEVNULL)
        cpu = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before

        def rows(name):
            lines = (place / "Day" / name).read_text().splitlines()
            return [[float(value) for value in line.split()] for line in lines]

        found = {
            "cpu_s": cpu,
            "attitude": [[row[3], *row[:3]] for row in rows("qbn.42")],
            "position": [row[:3] for row in rows("PosN.42")],
            "momentum": rows("Hwhl.42"),
        }
    print(json.dumps(found))


main()
