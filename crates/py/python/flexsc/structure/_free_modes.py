"""Modes of a free structure: they have neither momentum nor angular momentum."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from flexsc._numpy import np, npt
from flexsc.structure._lumped import Integrals, Lump, in_basic_axes, integrals_of, lumps_of
from flexsc.structure._punch import Solution

if TYPE_CHECKING:
    Numbers = npt.NDArray[np.float64]

# Momentum of a mode, of that of a rigid motion with its generalised mass: by the masses as Nastran lumps
# them, and by equal parts at the corners where they are of other kinds.
EXACT, ROUGH = 1e-3, 0.1
# A mode with as much is one of the rigid body.
RIGID = 0.9


def check_free(path: Path, solution: Solution, elastic: npt.NDArray[np.bool_], bulk: Any, deck: Path) -> None:
    """Refuse elastic modes with momentum: those of a clamped structure, or of the rigid body.

    Raises:
        ValueError: A mode is none of a free structure, or its shapes are not known where there is mass.
    """
    try:
        lumps, bound = lumps_of(bulk, deck), EXACT
    except ValueError:
        lumps, bound = _equal_parts(bulk), ROUGH
    if not lumps:
        return
    massive = {lump.grid for lump in lumps}
    if missing := sorted(massive - set(solution.shapes)):
        raise ValueError(
            f"{path}: must have shapes at all grid points with mass, by `DISPLACEMENT = ALL`, to check that "
            f"its modes are those of a free structure, and has none at "
            f"{', '.join(map(str, missing[:5]))}{' and others' if missing[5:] else ''}"
        )
    positions, shapes = in_basic_axes(massive, solution.shapes, bulk, deck)
    shapes = {grid: shape[elastic] for grid, shape in shapes.items()}
    sums = integrals_of(lumps, positions, shapes, np.zeros(3))
    norms = np.diagonal(sums.generalised)
    frequencies = solution.frequencies[elastic]
    at = int(np.argmax(np.abs(norms - 1.0)))
    if bound == EXACT and abs(norms[at] - 1.0) > EXACT:
        raise ValueError(
            f"{path}: shapes must be normalised by the masses of {deck}, and the mode at "
            f"{frequencies[at]:g} rad/s has the generalised mass {norms[at]:.6g}, not 1: another deck, "
            f"density or normalisation"
        )
    momenta = _momenta(sums) / np.sqrt(np.maximum(norms, np.finfo(np.float64).tiny))
    if not (momenta > bound).any():
        return
    at = int(np.argmax(momenta > bound))
    found = f"{path}: must have modes of a free structure, and the mode at {frequencies[at]:g} rad/s"
    if any(not shape[:, :3].any() for shape in solution.shapes.values()):
        raise ValueError(
            f"{found} has momentum: grid points are at rest, so the structure is clamped, and "
            f"`flexsc.appendage_from_nastran` reads it"
        )
    if (rigid := momenta > RIGID).any():
        highest = float(frequencies[rigid].max())
        raise ValueError(
            f"{path}: must have modes of a free structure above `lowest`, and {int(rigid.sum())} up to "
            f"{highest:g} rad/s are motions of the rigid body: give `lowest={1.05 * highest:.3g}`"
        )
    raise ValueError(
        f"{found} has {momenta[at]:.2g} of the momentum of a rigid motion: supports, another deck, or masses "
        f"that are not lumped at grid points"
    )


def _momenta(sums: Integrals) -> Numbers:
    """The root of the part of each mode's kinetic energy that is that of a rigid motion."""
    carried = np.hstack([sums.translation, sums.rotation])
    # A structure along a line has no inertia about it: in the scale of each direction, its part is left out.
    scale = np.sqrt(np.maximum(np.diagonal(sums.rigid), np.finfo(np.float64).tiny))
    inverse = np.linalg.pinv(sums.rigid / np.outer(scale, scale), rcond=1e-9, hermitian=True)
    scaled = carried / scale
    energies: Numbers = np.einsum("ij,jk,ik->i", scaled, inverse, scaled)
    return np.sqrt(np.maximum(energies, 0.0))


def _equal_parts(bulk: Any) -> list[Lump]:
    """The masses of all elements in equal parts at their grid points."""
    lumps = []
    for element in (*bulk.elements.values(), *bulk.masses.values()):
        try:
            grids, mass = [int(grid) for grid in element.node_ids if grid], float(element.Mass())
        except (AttributeError, KeyError, TypeError, RuntimeError):
            continue  # without mass
        if grids and mass > 0.0:
            lumps += [Lump(grid, mass / len(grids), np.zeros(3), np.zeros((3, 3))) for grid in grids]
    return lumps
