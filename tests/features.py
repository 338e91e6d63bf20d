"""Features that third-party crates must have in both builds, light and full: `python3 tests/features.py`.

`lint.py` checks the light build with the third-party crates of the full one.
"""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# Third-party crates with features for more than the light build: for lanes, for hand-over, and for tests.
MORE_FEATURES = {"prost", "pulp", "rand"}


def features(*options: str) -> dict[str, set[str]]:
    """The features of all crates on which crates of the workspace depend."""
    shown = ("--depth", "1", "--no-dedupe", "--prefix", "none", "--format", "{p}|{f}")
    command = ["cargo", "tree", *options, *shown]
    told = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True).stdout
    pairs = (line.removesuffix(" (*)").split("|") for line in told.splitlines() if "|" in line)
    return {crate: set(names.split(",")) for crate, names in pairs}


def main() -> None:
    light, full = features("--edges", "normal"), features("--workspace")
    for crate, names in light.items():
        more = full[crate] - names
        # Crates of the workspace have paths.
        if more and "(/" not in crate and crate.split()[0] not in MORE_FEATURES:
            sys.exit(f"{crate} has features in the full build alone: {', '.join(more)}: see MORE_FEATURES")
    print(f"{len(light)} crates of the light build have the features of the full one")


if __name__ == "__main__":
    main()
