"""Golden numbers of tests/margins.rs, with flexsc, python-control and slycot installed.

Each row of `disk_margins.csv` has a scenario, a command or `all`, the modulus margin 1/|S| and the disk
margin 1/|S - 1/2|, by the norms of SLICOT (AB13DD) of the loops that Python opens at the command, with
SciPy's exponentials. AB13DD stops at a lower peak for the modulus about roll of `attitude-hold`: the larger
of its value and of a search by SciPy from the largest values on a grid is taken. The loops of the wheel study
come from wheel_loop_reference.py.
"""

from pathlib import Path

import control
import flexsc
import numpy as np
from flexsc import _native
from scipy.linalg import expm
from scipy.optimize import minimize_scalar
from wheel_loop_reference import disk_rows

ROOT = Path(__file__).parents[2]
NAMES = (
    "attitude-hold",
    "earth-observer",
    "four-clamped-modes",
    "slew-wheel-lqg",
    "station-keeping",
    "kalman-late",
    "observer-late",
)


def largest(system: control.StateSpace, grid: np.ndarray, period: float) -> float:
    """Return the norm by AB13DD, or the largest value near the peaks of a grid if that is larger."""

    def gain(frequency: float) -> float:
        inner = np.linalg.solve(np.exp(1j * frequency * period) * np.eye(len(system.A)) - system.A, system.B)
        return float(np.linalg.norm(system.C @ inner + system.D, 2))

    gains = np.array([gain(frequency) for frequency in grid])
    found = [control.linfnorm(system, tol=1e-12)[0]]
    for k in np.argsort(gains[1:-1])[-5:] + 1:
        bounds, options = (grid[k - 1], grid[k + 1]), {"xatol": 1e-10}
        found.append(
            -minimize_scalar(lambda w: -gain(w), bounds=bounds, method="bounded", options=options).fun
        )
    return float(max(found))


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
            systems = [control.ss(closed.a, b, c, part * one - d, closed.period) for part in (1.0, 0.5)]
            norms = [largest(system, closed.frequency_grid(), closed.period) for system in systems]
            lines.append(",".join([name, own, *(repr(1.0 / norm) for norm in norms)]))
    lines += disk_rows()
    (ROOT / "tests/golden/disk_margins.csv").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
