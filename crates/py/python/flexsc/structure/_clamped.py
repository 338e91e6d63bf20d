"""Appendages from Nastran: clamped modes as the participations and first moments of an `[[appendage]]`."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

from flexsc._numpy import np, npt
from flexsc.structure._nastran import _read_bulk, _read_solution
from flexsc.structure._punch import Solution

if TYPE_CHECKING:
    from flexsc.structure._lumped import Integrals

    Numbers = npt.NDArray[np.float64]

# How well the masses of the bulk data have to give the generalised masses of the run.
AGREES = 1e-3
# A mode this much slower than the next is a mechanism, or a motion of the rigid body.
MECHANISM = 1e-3
# What modes may carry above the rigid mass, of its largest, by the digits of the file.
CARRIED = 1e-6


def appendage_from_nastran(
    results: str | os.PathLike[str],
    model: str | os.PathLike[str],
    points: Mapping[str, int] | None = None,
    *,
    damping: float | Sequence[float],
    root: int | Sequence[float] = (0.0, 0.0, 0.0),
    name: str = "appendage",
    keep: int | None = None,
    length_unit: float = 1.0,
    mass_unit: float = 1.0,
    subcase: int | None = None,
) -> dict[str, Any]:
    """The keys of an `[[appendage]]` by a normal-modes solution (SOL 103) of the clamped structure.

    Participations, first moments and mass properties are sums over the lumped masses of the bulk data: bars,
    beams, rods, shells and solids without mid-side grid points, and `CONM2`. They are right to the digits of
    the shapes, which have to be in the file at all grid points with mass.

    Args:
        results: The OP2 file, or the punch file (`.pch`) of `DISPLACEMENT(PUNCH) = ALL`. Shapes of an OP2
            file are normalised by its generalised masses; those of a punch file must be so already
            (`EIGRL` with `NORM = MASS`, which is its default).
        model: The bulk data, for positions, coordinate systems and masses.
        points: Names of points, with the numbers of their grid points.
        damping: Damping ratio of all modes, or one for each that is kept: no file has it.
        root: What `at` of the appendage places: the number of a grid point, or where it is in the basic
            coordinate system, in the model's unit.
        name: Name of the appendage.
        keep: How many modes, those with the lowest frequencies; left out, all.
        length_unit: Length of the model's unit (m); 1e-3 for millimetres.
        mass_unit: Its unit of mass (kg), after `PARAM,WTMASS`; 1e3 for tonnes.
        subcase: Which subcase, if there are several.

    Returns:
        `name`, `mass`, `centre`, `inertia`, `points` and `modes`, in SI; add `at` and `turned`.

    Raises:
        ImportError: pyNastran is not installed: `pip install flexsc[nastran]`.
        OSError: A file cannot be read.
        ValueError: The files lack something that is needed, or contradict each other; the text names it.
    """
    from flexsc.structure._lumped import in_basic_axes, integrals_of, lumps_of

    path, deck = Path(results), Path(model)
    solution = _lowest(_read_solution(path, subcase), keep, path)
    zetas = _dampings(damping, len(solution.frequencies))
    bulk = _read_bulk(deck)
    points = {} if points is None else points
    lumps = lumps_of(bulk, deck)
    massive = {lump.grid for lump in lumps}
    if missing := sorted(massive - set(solution.shapes)):
        raise ValueError(
            f"{path}: must have shapes at all grid points with mass, by `DISPLACEMENT = ALL`, and has none "
            f"at {', '.join(map(str, missing[:5]))}{' and others' if missing[5:] else ''}"
        )
    for point, number in points.items():
        if number not in bulk.nodes or number not in solution.shapes:
            raise ValueError(
                f"points: must be grid points of {deck} with shapes in {path}, got {number} for `{point}`"
            )
    if not any(not shape[:, :3].any() for shape in solution.shapes.values()):
        raise ValueError(f"{path}: must have a grid point at rest in all modes: clamp the root")
    positions, shapes = in_basic_axes(massive | set(points.values()), solution.shapes, bulk, deck)
    origin = _place(root, bulk, deck)
    sums = integrals_of(lumps, positions, shapes, origin)
    _check(sums, path, deck)
    # The masses of the file have fewer digits than those of the shapes and the bulk data.
    norms = np.sqrt(np.diagonal(sums.generalised))
    t, n = sums.translation / norms[:, None], sums.moments / norms[:, None, None]
    r = sums.rotation / norms[:, None]
    _check_carried(sums, np.hstack([t, r]), path)

    mass_root = float(np.sqrt(mass_unit))
    modes = []
    for at, frequency in enumerate(solution.frequencies.tolist()):
        at_points = {}
        for point, number in points.items():
            shape = shapes[number][at] / (norms[at] * mass_root)
            at_points[point] = {
                "translation": shape[:3].tolist(),
                "rotation": (shape[3:] / length_unit).tolist(),
            }
        modes.append(
            {
                "frequency": frequency,
                "damping": zetas[at],
                "translation": (mass_root * t[at]).tolist(),
                "rotation": (mass_root * length_unit * r[at]).tolist(),
                "moments": (mass_root * length_unit * n[at]).tolist(),
                "shapes": at_points,
            }
        )
    return {
        "name": name,
        "mass": mass_unit * sums.mass,
        "centre": (length_unit * sums.centre).tolist(),
        "inertia": (mass_unit * length_unit**2 * sums.inertia).tolist(),
        "points": [
            {"name": point, "position": (length_unit * (positions[number] - origin)).tolist()}
            for point, number in points.items()
        ],
        "modes": modes,
    }


def _lowest(solution: Solution, keep: int | None, path: Path) -> Solution:
    """The modes in the order of their frequencies, the lowest of them if fewer are wanted."""
    order = np.argsort(solution.frequencies, kind="stable")
    frequencies = solution.frequencies[order]
    for slow, fast in pairwise(frequencies.tolist()):
        if slow <= MECHANISM * fast:
            raise ValueError(
                f"{path}: must have no mode at {slow:g} rad/s, below a thousandth of the next ({fast:g}): "
                f"a mechanism, or a free structure; clamp the root"
            )
    if keep is not None and not 1 <= keep <= len(order):
        raise ValueError(f"keep: must be 1 to {len(order)}, the modes of {path}, got {keep}")
    order = order[:keep]
    shapes = {grid: shape[order] for grid, shape in solution.shapes.items()}
    return Solution(solution.frequencies[order], shapes)


def _dampings(damping: float | Sequence[float], modes: int) -> list[float]:
    given = np.asarray(damping, dtype=np.float64)
    if given.shape not in ((), (modes,)):
        raise ValueError(f"damping: must be one number, or one for each of {modes} modes, got {given.shape}")
    ratios: list[float] = np.broadcast_to(given, modes).tolist()
    return ratios


def _place(root: int | Sequence[float], bulk: Any, deck: Path) -> Numbers:
    if isinstance(root, int):
        if root not in bulk.nodes:
            raise ValueError(f"root: must be a grid point of {deck}, or its place, got {root}")
        return np.asarray(bulk.nodes[root].get_position(), dtype=np.float64)
    place = np.asarray(root, dtype=np.float64)
    if place.shape != (3,):
        raise ValueError(f"root: must be a grid point, or its three coordinates, got {root}")
    return place


def _check(sums: Integrals, path: Path, deck: Path) -> None:
    """Shapes of another deck, in other units or of coupled masses are not normalised by these masses."""
    off = np.abs(sums.generalised - np.eye(len(sums.generalised)))
    i, j = (int(at) for at in np.unravel_index(int(np.argmax(off)), off.shape))
    if off[i, j] <= AGREES:
        return
    if i == j:
        why = f"must be normalised by the masses of {deck}, and mode {i + 1} has"
    else:
        why = f"must be orthogonal by the masses of {deck}, and modes {i + 1} and {j + 1} have"
    raise ValueError(
        f"{path}: shapes {why} the generalised mass {sums.generalised[i, j]:.6g}, not {float(i == j):g}: "
        f"another deck, density or normalisation, or masses that are not lumped at grid points"
    )


def _check_carried(sums: Integrals, participations: Numbers, path: Path) -> None:
    """What the modes carry is part of the rigid mass: the rest has no negative value."""
    rigid = sums.rigid
    least = float(np.linalg.eigvalsh(rigid - participations.T @ participations)[0])
    if least < -CARRIED * float(np.abs(rigid).max()):
        raise ValueError(
            f"{path}: modes must carry no more than the rigid mass about the root, and {-least:g} of it is "
            f"carried twice: is a mode there twice?"
        )
