"""Golden numbers of tests/margins.rs, with flexsc, python-control and slycot installed.

Each row of `disk_margins.csv` has a scenario, a command or `all`, the modulus margin 1/|S| and the disk
margin 1/|S - 1/2|, by the norms of SLICOT (AB13DD) of the loops that Python opens at the command, with
SciPy's exponentials.
"""

from pathlib import Path

import control
import flexsc
import numpy as np
from flexsc import _native
from scipy.linalg import expm

ROOT = Path(__file__).parents[2]
NAMES = (
    "attitude-hold",
    "earth-observer",
    "four-clamped-modes",
    "slew-wheel-lqg",
    "station-keeping",
    "wheel-slow-mode",
    "kalman-late",
    "observer-late",
)


def main() -> None:
    _native.exponential = expm
    lines = ["scenario,command,modulus,disk"]
    for name in NAMES:
        paths = (ROOT / folder / f"{name}.toml" for folder in ("scenarios", "tests/golden/open_loops"))
        opened = flexsc.Scenario.load(next(path for path in paths if path.exists())).linearise(loop="command")
        closed = opened.closed()
        names = [signal.name.rstrip("_0123456789") for signal in opened.inputs]
        for own in [*dict.fromkeys(names), "all"]:
            places = [k for k, each in enumerate(names) if own in (each, "all")]
            b, c = closed.b[:, places], -closed.c[places]
            one, d = np.eye(len(places)), closed.d[np.ix_(places, places)]
            # S = 1 - T, and (S - T)/2 = S - 1/2.
            norms = [
                control.linfnorm(control.ss(closed.a, b, c, part * one - d, closed.period), tol=1e-12)[0]
                for part in (1.0, 0.5)
            ]
            lines.append(",".join([name, own, *(repr(float(1.0 / norm)) for norm in norms)]))
    (ROOT / "tests/golden/disk_margins.csv").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
