"""Frequencies of the panel of fe/solar.inp, clamped and on a free hub, of the full matrices of its elements.

    python3 tests/golden/panel_oracle.py        (needs CalculiX's ccx, NumPy and SciPy)

ccx assembles the matrices of the panel without its clamp. The nodes at x = 0 then move with the hub, a rigid
body of 6 coordinates about O, and all others freely: K x = w^2 M x, with no modes in between.
"""

import subprocess
import tempfile
from pathlib import Path

import numpy as np
from scipy.linalg import eigh

HERE = Path(__file__).resolve().parent
# The hub: mass (kg), inertia about its centre of mass O (kg m^2), and where the panel's root is (m).
MASS, INERTIA, ROOT = 90.0, np.diag([80.0, 60.0, 70.0]), np.array([0.4, 0.1, -0.2])


def run(directory, name, deck):
    (directory / f"{name}.inp").write_text(deck)
    subprocess.run(["ccx", "-i", name], cwd=directory, check=True, stdout=subprocess.DEVNULL)


def nodes(path):
    """The positions of the nodes of a file of results."""
    found, reading = {}, False
    for line in path.read_text().splitlines():
        if line.startswith("    2C"):
            reading = True
        elif reading and line.startswith(" -3"):
            return found
        elif reading:
            found[int(line[3:13])] = np.array(
                [float(line[13 + 12 * axis : 25 + 12 * axis]) for axis in range(3)]
            )
    raise ValueError(f"{path}: no nodes")


def matrix(path, order):
    rows = np.loadtxt(path)
    i, j = rows[:, 0].astype(int) - 1, rows[:, 1].astype(int) - 1
    full = np.zeros((order, order))
    full[i, j] = rows[:, 2]
    full[j, i] = rows[:, 2]
    return full


def cross(r):
    return np.array([[0.0, -r[2], r[1]], [r[2], 0.0, -r[0]], [-r[1], r[0], 0.0]])


def frequencies(stiffness, mass, shift):
    """The lowest ones, from M x = (K + shift M) x / (w^2 + shift): reduced integration leaves M singular."""
    inverse = eigh(mass, stiffness + shift * mass, eigvals_only=True)[::-1]
    return np.sqrt(np.abs(1.0 / inverse[:20] - shift))


def main():
    deck = (HERE / "fe" / "solar.inp").read_text().replace("*BOUNDARY\nROOT, 1, 3\n", "")
    with tempfile.TemporaryDirectory() as temporary:
        directory = Path(temporary)
        run(directory, "shapes", deck)
        run(directory, "matrices", deck.replace("*FREQUENCY", "*FREQUENCY, SOLVER=MATRIXSTORAGE"))
        positions = nodes(directory / "shapes.frd")
        freedoms = [
            tuple(map(int, line.split("."))) for line in (directory / "matrices.dof").read_text().split()
        ]
        order = len(freedoms)
        mass, stiffness = (matrix(directory / f"matrices.{kind}", order) for kind in ("mas", "sti"))
    rigid = np.zeros((order, 6))
    for row, (node, axis) in enumerate(freedoms):
        r = positions[node] + ROOT
        rigid[row, axis - 1] = 1.0
        rigid[row, 3:] = -cross(r)[axis - 1]
    held = np.array([abs(positions[node][0]) < 1e-9 for node, _ in freedoms])
    print("clamped", *frequencies(stiffness[np.ix_(~held, ~held)], mass[np.ix_(~held, ~held)], 0.0)[:8])
    # All coordinates: the hub's six, and the free nodes' motion in space.
    motion = np.zeros((order, 6 + np.sum(~held)))
    motion[held, :6] = rigid[held]
    motion[np.where(~held)[0], 6 + np.arange(np.sum(~held))] = 1.0
    whole = motion.T @ mass @ motion
    whole[:3, :3] += MASS * np.eye(3)
    whole[3:6, 3:6] += INERTIA
    # Six of the body at rest come first.
    print("free", *frequencies(motion.T @ stiffness @ motion, whole, 1.0)[6:14])


main()
