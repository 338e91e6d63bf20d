"""Appendages from Craig-Bampton matrices: rows of an interface, and rows of modes that are clamped there."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from flexsc._numpy import np, npt
from flexsc.structure._clamped import CARRIED, _dampings
from flexsc.structure._matrices import RIGID, _body, _kept, _matrix, _modes

if TYPE_CHECKING:
    Numbers = npt.NDArray[np.float64]


def appendage_from_craig_bampton(
    mass: Any,
    stiffness: Any,
    interface: Sequence[int] = (0, 1, 2, 3, 4, 5),
    *,
    damping: float | Sequence[float],
    positions: npt.ArrayLike = ((0.0, 0.0, 0.0),),
    root: Sequence[float] = (0.0, 0.0, 0.0),
    points: Mapping[str, tuple[Sequence[float], npt.ArrayLike]] | None = None,
    name: str = "appendage",
    keep: int | None = None,
    length_unit: float = 1.0,
    mass_unit: float = 1.0,
) -> dict[str, Any]:
    """The keys of an `[[appendage]]` by a Craig-Bampton model, as suppliers hand it over (`MXX` and `KXX`).

    The rows of the interface are three displacements and three rotations of each of its nodes; all other rows
    are modes of the structure that is clamped there. Participation factors are the mass matrix between both.
    Such a model has no first moments of its modes.

    Args:
        mass: The reduced mass matrix, shape (rows, rows). `flexsc.read_matrices` reads both from a file.
        stiffness: The reduced stiffness matrix, in the same order.
        interface: Rows of the interface, from 0, node after node.
        damping: Damping ratio of all modes, or one for each that is kept.
        positions: Where the nodes of the interface are, shape (nodes, 3).
        root: What `at` of the appendage places.
        points: For each point, where it is, and the rows of the recovery matrix of its displacements, or of
            its displacements and rotations: shape (3, rows) or (6, rows).
        name: Name of the appendage.
        keep: How many modes, those with the lowest frequencies; left out, all.
        length_unit: Length of the model's unit (m); 1e-3 for millimetres.
        mass_unit: Its unit of mass (kg); 1e3 for tonnes.

    Returns:
        `name`, `mass`, `centre`, `inertia`, `points` and `modes`, in SI; add `at` and `turned`.

    Raises:
        ValueError: The matrices are none of a Craig-Bampton model; the text names why.

    >>> import flexsc, numpy as np
    >>> mass = np.eye(7)
    >>> mass[:6, :6] = np.diag([2.0, 2.0, 2.0, 0.1, 0.1, 0.1])
    >>> mass[2, 6] = mass[6, 2] = 1.2                        # one mode, which moves along z
    >>> stiffness = np.diag([0, 0, 0, 0, 0, 0, 9.0])
    >>> panel = flexsc.appendage_from_craig_bampton(mass, stiffness, damping=0.005)
    >>> panel["modes"][0]["frequency"], panel["modes"][0]["translation"]
    (3.0, [0.0, 0.0, 1.2])
    """
    mass, stiffness = (_dense(what, matrix) for what, matrix in (("mass", mass), ("stiffness", stiffness)))
    rows, held = len(mass), np.asarray(interface, dtype=np.intp)
    if stiffness.shape != mass.shape:
        raise ValueError(f"stiffness: must have the shape of the mass, {mass.shape}, got {stiffness.shape}")
    where = np.asarray(positions, dtype=np.float64)
    if where.ndim != 2 or where.shape[1:] != (3,) or len(held) != 6 * len(where):
        raise ValueError(
            f"interface: must be six rows for each node of `positions`, got {len(held)} rows and positions "
            f"of shape {where.shape}"
        )
    if len(set(held.tolist())) != len(held) or held.min() < 0 or held.max() >= rows or len(held) == rows:
        raise ValueError(f"interface: must be rows from 0 to {rows - 1}, each once and not all of them")
    origin = np.asarray(root, dtype=np.float64)
    modal = np.setdiff1d(np.arange(rows), held)
    rigid = np.vstack([_rigid_motions(at - origin) for at in where])
    _check_reduced(stiffness, held, modal, rigid)
    keep = len(modal) if keep is None else _kept(keep, len(modal))
    frequencies, shapes = _modes(
        mass[np.ix_(modal, modal)], stiffness[np.ix_(modal, modal)], keep, "stiffness"
    )
    shapes = shapes * np.sign(shapes[np.abs(shapes).argmax(axis=0), np.arange(keep)])
    carried = shapes.T @ mass[np.ix_(modal, held)] @ rigid
    total = rigid.T @ mass[np.ix_(held, held)] @ rigid
    kilograms, centre, inertia = _body(total)
    if (least := float(np.linalg.eigvalsh(total - carried.T @ carried)[0])) < -CARRIED * np.abs(total).max():
        raise ValueError(
            f"mass: modes must carry no more than the rigid mass, and {-least:g} is carried twice"
        )
    zetas = _dampings(damping, keep)
    mass_root = float(np.sqrt(mass_unit))
    scale = np.array([1.0] * 3 + [1.0 / length_unit] * 3) / mass_root
    placed, recovered = [], {}
    for point, (at, recovery) in (points or {}).items():
        rows_of_point = np.asarray(recovery, dtype=np.float64)
        if rows_of_point.shape not in ((3, rows), (6, rows)):
            raise ValueError(
                f"points: `{point}` must have a recovery matrix of shape (3, {rows}) or (6, {rows})"
            )
        placed.append({"name": point, "position": (length_unit * (np.asarray(at) - origin)).tolist()})
        recovered[point] = (rows_of_point[:, modal] @ shapes).T * scale[: len(rows_of_point)]
    modes = []
    for at_mode in range(keep):
        at_points = {
            point: {"translation": found[at_mode, :3].tolist()}
            | ({"rotation": found[at_mode, 3:].tolist()} if found.shape[1] == 6 else {})
            for point, found in recovered.items()
        }
        modes.append(
            {
                "frequency": float(frequencies[at_mode]),
                "damping": zetas[at_mode],
                "translation": (mass_root * carried[at_mode, :3]).tolist(),
                "rotation": (mass_root * length_unit * carried[at_mode, 3:]).tolist(),
                "shapes": at_points,
            }
        )
    return {
        "name": name,
        "mass": mass_unit * kilograms,
        "centre": (length_unit * centre).tolist(),
        "inertia": (mass_unit * length_unit**2 * inertia).tolist(),
        "points": placed,
        "modes": modes,
    }


def _dense(name: str, given: Any) -> Numbers:
    matrix = _matrix(name, given)
    dense: Numbers = matrix.toarray() if hasattr(matrix, "toarray") else matrix
    return dense


def _rigid_motions(arm: Numbers) -> Numbers:
    """Displacements and rotations of a node under unit displacements and rotations of the root."""
    motions = np.eye(6)
    motions[:3, 3:] = np.cross(np.eye(3), arm).T
    return motions


def _check_reduced(stiffness: Numbers, held: Any, modal: Any, rigid: Numbers) -> None:
    """In a Craig-Bampton model modes strain nothing at the interface, and a rigid motion strains nothing."""
    largest = float(np.abs(stiffness).max())
    if (coupled := float(np.abs(stiffness[np.ix_(modal, held)]).max())) > RIGID * largest:
        raise ValueError(
            f"stiffness: must be 0 between interface and modes, got {coupled:g} of {largest:g}: rows of "
            f"another order (`interface`), or matrices that are not reduced: "
            f"`flexsc.appendage_from_matrices`"
        )
    # What the reduction leaves of large elements is small beside the modes.
    force = float(np.abs(stiffness[np.ix_(held, held)] @ rigid).max())
    if force > RIGID * largest * max(1.0, float(np.abs(rigid).max())):
        raise ValueError(
            "stiffness: must meet no rigid motion of the interface: other `positions`, or another order of "
            "rows"
        )
