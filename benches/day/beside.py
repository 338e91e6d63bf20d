"""A day of a CubeSat in flexsc, Basilisk and 42, interleaved: prints the figures of docs/benchmarks.md.

pip install bsk; git clone https://github.com/ericstoneking/42; cargo build --release
python3 benches/day/beside.py WMM.COF 42    # the field model of NOAA for Basilisk, the directory of 42

Each row is the least user CPU time of five runs, or the time of one with steps of 0.1 s: of the whole process
for flexsc and 42, of `ExecuteSimulation` for Basilisk, without the start of Python.
"""

import json
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
RUNS = 5
NOT_TURNING = ("magnetic_field.rotation=0", "magnetic_field.meridian=0", "drag.rotation=0")


def flexsc(scenario, *settings):
    """Runs flexsc with a full log, and returns what the scripts of the others print."""
    with tempfile.TemporaryDirectory() as place:
        command = [ROOT / "target" / "release" / "flexsc", "simulate", scenario, "--log", "full", "--json"]
        for setting in settings:
            command += ["--set", f"environment.{setting}"]
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        done = subprocess.run([*command, "-o", place], capture_output=True, text=True, check=True)
        cpu = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    metrics = json.loads(done.stdout)["metrics"]
    return {
        "cpu_s": cpu,
        "error_rad": metrics["pointing_error_end_rad"],
        "momentum_nm_s": metrics["wheel_momentum_end_nm_s"],
    }


def script(name, *arguments):
    """Runs a script of another program, whose last line is the result."""
    command = [sys.executable, HERE / name, *arguments]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return json.loads(done.stdout.splitlines()[-1])


def main():
    field, home = sys.argv[1:]
    studies = {
        "flexsc": lambda: flexsc(HERE / "nadir.toml"),
        "flexsc, the field and the air do not turn": lambda: flexsc(HERE / "nadir.toml", *NOT_TURNING),
        "Basilisk, steps of 0.5 s": lambda: script("in_basilisk.py", field, "0.5"),
        "Basilisk, steps of 0.1 s": lambda: script("in_basilisk.py", field, "0.1"),
        "42, steps of 0.5 s": lambda: script("in_42.py", home, "0.5"),
        "42, steps of 0.1 s": lambda: script("in_42.py", home, "0.1"),
        "flexsc, `cubesat-day`": lambda: flexsc(ROOT / "scenarios" / "cubesat-day.toml"),
    }
    found = {name: [] for name in studies}
    for run in range(RUNS):
        for name, study in studies.items():
            if run == 0 or "0.1 s" not in name:
                found[name].append(study())
    print("| program | CPU time | pointing error at the end | momentum of the wheels at the end |")
    print("|---|---|---|---|")
    for name, runs in found.items():
        cpu, last = min(run["cpu_s"] for run in runs), runs[-1]
        momentum = f"{last['momentum_nm_s']:.3e} N m s"
        print(f"| {name} | {cpu:.2g} s | {last['error_rad']:.2e} rad | {momentum} |")


main()
