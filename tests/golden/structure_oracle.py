"""The example structure of [Rotation] (two panels of four sections) as NumPy and SciPy write it.

Run as `python structure_oracle.py`; writes structure-dense.npz and structure-{csr,csc,coo,dia}.npz beside
itself, and prints what tests/structure.rs compares with: frequencies and couplings by 40-digit arithmetic.
"""

from pathlib import Path

import numpy as np
import scipy.sparse
from mpmath import mp

mp.dps = 40

MASS = [
    [4616.67, 75.0, 137.5, 200.0, 177.5],
    [75.0, 20.0, 2.5, 0.0, 0.0],
    [137.5, 2.5, 20.0, 2.5, 0.0],
    [200.0, 0.0, 2.5, 20.0, 2.5],
    [177.5, 0.0, 0.0, 2.5, 15.0],
]
STIFFNESS = [
    [0, 0, 0, 0, 0],
    [0, 4160, -2560, 640, 0],
    [0, -2560, 3840, -2560, 640],
    [0, 640, -2560, 3200, -1280],
    [0, 0, 640, -1280, 640],
]
HERE = Path(__file__).parent


def modes(mass, stiffness):
    """Frequencies and mass-normalised vectors, one a column."""
    factor = mp.cholesky(mass)
    inverse = mp.inverse(factor)
    squares, vectors = mp.eigsy(inverse * stiffness * inverse.T)
    return [mp.sqrt(abs(square)) for square in squares], inverse.T * vectors


def main():
    mass, stiffness = np.array(MASS), np.array(STIFFNESS)
    np.savez_compressed(HERE / "structure-dense.npz", M=mass, K=np.asfortranarray(stiffness, dtype=np.int32))
    for layout in ("csr", "csc", "coo", "dia"):
        scipy.sparse.save_npz(HERE / f"structure-{layout}.npz", scipy.sparse.coo_array(mass).asformat(layout))
    # The decimal number, not the nearest double.
    exact = mp.matrix([[mp.mpf(str(element)) for element in row] for row in MASS])
    frequencies, vectors = modes(exact, mp.matrix(STIFFNESS))
    for n in range(1, 5):
        phi = (vectors[4, n] - vectors[3, n]) / mp.mpf("2.5")
        parts = [frequencies[n], abs(vectors[0, n]), abs(phi), vectors[0, n] * phi]
        print("free", *(mp.nstr(part, 17) for part in parts))
    frequencies, vectors = modes(exact[1:, 1:], mp.matrix(STIFFNESS)[1:, 1:])
    for n in range(4):
        coupling = sum(exact[0, i + 1] * vectors[i, n] for i in range(4))
        phi = (vectors[3, n] - vectors[2, n]) / mp.mpf("2.5")
        parts = [frequencies[n], abs(coupling), coupling * phi]
        print("clamped", *(mp.nstr(part, 17) for part in parts))


if __name__ == "__main__":
    main()
