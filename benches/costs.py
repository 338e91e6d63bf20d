"""Compares the run time that `flexsc check` estimates with the measured one, for every shipped scenario.

python3 benches/costs.py [COMMAND]   # COMMAND: default target/release/flexsc

CPU time on one core: of the scenario run once, and for each run of a campaign of 20. Runs of sampled
loops about one axis share SIMD lanes there, which the estimate of a campaign allows for, and that of
`check` does not.
"""

import json
import os
import resource
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
RUNS = 20


def cpu(*command):
    """CPU time (s) of a command, and what it prints."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT)
    # A run that misses a requirement is a run.
    if done.returncode not in (0, 3):
        sys.exit(done.stderr)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime, done.stdout


def main():
    flexsc = sys.argv[1] if len(sys.argv) > 1 else str(ROOT / "target" / "release" / "flexsc")
    print(f"{'scenario':28}{'estimate':>10}{'once':>10}{'a run':>10}{'ratio':>8}{'ratio':>8}")
    beyond = []
    for path in sorted((ROOT / "scenarios").glob("*.toml")):
        start, text = cpu(flexsc, "check", str(path), "--json")
        estimate = json.loads(text)["estimate_s"]
        once = cpu(flexsc, "simulate", str(path), "--log", "none", "--json")[0] - start
        campaign = ("simulate", str(path), "--runs", str(RUNS), "--jobs", "1", "--json")
        each = (cpu(flexsc, *campaign)[0] - start) / RUNS
        ratios = [estimate / max(time, 1e-6) for time in (once, each)]
        line = f"{path.stem:28}{estimate:10.4f}{once:10.4f}{each:10.4f}{ratios[0]:8.2f}{ratios[1]:8.2f}"
        print(line, flush=True)
        if not any(0.5 <= ratio <= 2.0 for ratio in ratios) and each > 2e-3:
            beyond.append(path.stem)
    print("not within a factor of 2 of a run that takes over 2 ms:", ", ".join(beyond) or "none")


if __name__ == "__main__":
    os.environ["NO_COLOR"] = "1"
    main()
