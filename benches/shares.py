"""Instructions of runs by part of the program, of two commands: the profile of docs/benchmarks.md.

python3 benches/shares.py BEFORE AFTER  # flexsc with symbols, built with `--profile ci`; needs valgrind

A function of a library counts for the parts that call it.
"""

import re
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
RUNS = {"cubesat-day": 1000, "s2e-sample": 500, "forty-two-leo": 600}
PARTS = {
    "environment": r"flexsc_spacecraft::environment",
    "integration": r"flexsc_dynamics|flexsc_sim::plant",
    "control": r"flexsc_control|flexsc_flight::(?!trig|matrix)",
    "record": r"flexsc_record|flexsc_core::(metrics|answer)",
    "scenario": r"flexsc_scenario|flexsc_formats|toml|serde|flexsc::|^cli",
}


def profile(command, scenario, seconds):
    """Own instructions of each function, and those of each call."""
    own, calls, names, caller, called = Counter(), Counter(), {}, None, None
    with tempfile.NamedTemporaryFile() as out:
        run = [command, "simulate", scenario, "--set", f"duration={seconds}", "--log", "none"]
        valgrind = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={out.name}"]
        done = subprocess.run([*valgrind, *run], capture_output=True, text=True)
        # 3: a requirement is not met.
        if done.returncode not in (0, 3):
            raise SystemExit(f"{command} {scenario}: {done.stderr}")
        lines = Path(out.name).read_text().splitlines()
    for line in lines:
        if found := re.match(r"(c?fn)=\((\d+)\)(?: (.*))?", line):
            kind, key, name = found.groups()
            names.setdefault(key, name)
            caller, called = (caller, names[key]) if kind == "cfn" else (names[key], None)
        elif re.match(r"[0-9+*-]", line):
            cost = int(line.split()[1])
            if called:
                calls[caller, called] += cost
                called = None
            else:
                own[caller] += cost
    return own, calls


def shares(own, calls):
    """Instructions of each part."""
    fixed = {
        name: next((part for part, rule in PARTS.items() if re.search(rule, name)), None) for name in own
    }
    callers = {name: Counter() for name in own}
    for (caller, called), cost in calls.items():
        if caller != called:
            callers[called][caller] += cost
    split = {name: Counter({part: 1.0} if part else {}) for name, part in fixed.items()}
    for _ in range(60):
        for name in own:
            if not fixed[name]:
                whole = sum(callers[name].values()) or 1
                split[name] = Counter()
                for caller, cost in callers[name].items():
                    for part, share in split[caller].items():
                        split[name][part] += share * cost / whole
    found = Counter()
    for name, cost in own.items():
        whole = sum(split[name].values())
        for part, share in split[name].items():
            found[part] += cost * share / whole
    return found


def main():
    print("| millions of instructions, before and after | all | " + " | ".join(PARTS) + " |")
    print("|---|" + "---|" * (1 + len(PARTS)))
    for name, seconds in RUNS.items():
        ends = []
        for command in sys.argv[1:]:
            own, calls = profile(command, ROOT / "scenarios" / f"{name}.toml", seconds)
            ends.append({"all": sum(own.values()), **shares(own, calls)})
        cells = [", ".join(f"{end.get(part, 0) / 1e6:.0f}" for end in ends) for part in ("all", *PARTS)]
        print(f"| `{name}`, {seconds} s | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()
