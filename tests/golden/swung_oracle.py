"""A panel with modes beside a rigid panel on a hinge: swung.toml and swung.csv.

    pip install numpy scipy
    python3 tests/golden/swung_oracle.py tests/golden

The body is that of two_panels.py. The first panel stands still and has its two modes; the second is rigid
and swings on a hinge by half a radian, which moves the centre of mass. Momenta are derivatives of T.
H' = - w x H, p' = - k th - c th' + dT/d th, pi' = -O^2 eta - D eta' + dT/d eta, by DOP853 with a relative
tolerance of 1e-13.

swung.csv has a line each half second: t, Q (4), w (3), th, th', and the energy of all but the wheel.
"""

import sys
from pathlib import Path

import numpy as np
import two_panels
from two_panels import (
    DURATION,
    H_WHEEL,
    O2,
    PANELS,
    RATE,
    D,
    appendage,
    derivative,
    integrated,
    linear,
    mean_axes,
    quaternion,
    quaternion_rate,
    spacecraft,
    wheels,
)

AXIS = np.array([1.0, 0.2, -0.1])
STIFFNESS, DAMPING = 70.0, 0.8
ANGLE, SWING = 0.5, 0.1
ETA = np.array([0.3, -0.2])
# Of z = (w, alpha', eta'): the hub, the hinge, the modes of the first panel.
FREE = [0, 1, 2, 4, 5, 6]

PANELS[1].axis = AXIS / np.linalg.norm(AXIS)
two_panels.ETA[:2] = ETA


def matrices(angle):
    """M at eta = 0 and its derivatives by the modes of the first panel."""
    m0, changes, _, _ = linear([0.0, angle])
    square = np.ix_(FREE, FREE)
    return m0[square], [change[square] for change in changes[:2]]


def energy(angle, eta, z):
    m0, changes = matrices(angle)
    return 0.5 * z @ (m0 + eta[0] * changes[0] + eta[1] * changes[1]) @ z


def speeds(y):
    """(w, th', eta') from momenta."""
    m0, changes = matrices(y[7])
    m = m0 + y[9] * changes[0] + y[10] * changes[1]
    return np.linalg.solve(m, np.concatenate([y[4:7] - H_WHEEL, [y[8]], y[11:13]])), changes


def rates(_, y):
    z, changes = speeds(y)
    w, eta = z[:3], y[9:11]
    pulled = -STIFFNESS * y[7] - DAMPING * z[3] + derivative(lambda s: energy(y[7] + s, eta, z))
    pi = -O2[:2] * eta - D[:2] * z[4:] + np.array([0.5 * z @ change @ z for change in changes])
    return np.concatenate([quaternion_rate(y[:4], w), -np.cross(w, y[4:7]), [z[3], pulled], z[4:], pi])


def start():
    """The modes are displaced and at rest, the hinge swings, and the body turns."""
    still, _ = matrices(0.0)
    bent = mean_axes(still, ETA, 4)
    m0, changes = matrices(ANGLE)
    m = m0 + ETA[0] * changes[0] + ETA[1] * changes[1]
    p = m @ np.concatenate([RATE, [SWING, 0.0, 0.0]])
    return np.concatenate([quaternion(bent), p[:3] + H_WHEEL, [ANGLE, p[3]], ETA, p[4:]])


def scenario():
    lines = [
        "# A panel with modes beside a rigid panel on a hinge: made by swung_oracle.py.",
        f"duration = {DURATION}",
        *spacecraft(),
        *appendage(0, []),
    ]
    hinge = (
        f"hinge = {{ about = {AXIS.tolist()}, stiffness = {STIFFNESS}, damping = {DAMPING}, "
        f"angle = {ANGLE}, rate = {SWING} }}"
    )
    second = appendage(1, ["turned = { about = [0, 0, 1], by = 3.141592653589793 }", hinge])
    lines += [
        *second[: second.index("modes = [")],
        "[law.open]",
        *wheels(),
        "[log]",
        "period = 0.5",
    ]
    return "\n".join(lines) + "\n"


def main():
    folder = Path(sys.argv[1])
    (folder / "swung.toml").write_text(scenario())
    begun = start()
    states = integrated(lambda *_: rates, begun, [DURATION], rtol=1e-13, atol=1e-15)
    with (folder / "swung.csv").open("w") as out:
        for t, y in [(0.0, begun), *states]:
            z, _ = speeds(y)
            eta = y[9:11]
            whole = energy(y[7], eta, z) + 0.5 * STIFFNESS * y[7] ** 2 + 0.5 * eta @ (O2[:2] * eta)
            row = [t, *(y[:4] / np.linalg.norm(y[:4])), *z[:3], y[7], z[3], whole]
            print(",".join(f"{value:.17g}" for value in row), file=out)


if __name__ == "__main__":
    main()
