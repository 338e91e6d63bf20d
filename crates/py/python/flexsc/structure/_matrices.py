"""Appendages from assembled matrices: clamped modes by the mass and stiffness of a finite-element model."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from flexsc._numpy import np, npt
from flexsc.structure._clamped import MECHANISM, _dampings
from flexsc.structure._matrix_file import DENSE

if TYPE_CHECKING:
    Numbers = npt.NDArray[np.float64]
    Rows = npt.NDArray[np.intp]

# Of the largest element: how far matrices may be from symmetric.
SYMMETRIC = 1e-9
# Of the largest element: what force a rigid motion may leave.
RIGID = 1e-6
# Number of modes, unless it is given.
KEPT = 10


def appendage_from_matrices(
    mass: Any,
    stiffness: Any,
    positions: npt.ArrayLike,
    points: Mapping[str, int] | None = None,
    *,
    clamped: Sequence[int],
    damping: float | Sequence[float],
    dofs: npt.ArrayLike | None = None,
    root: int | Sequence[float] = (0.0, 0.0, 0.0),
    name: str = "appendage",
    keep: int = KEPT,
    length_unit: float = 1.0,
    mass_unit: float = 1.0,
) -> dict[str, Any]:
    """The keys of an `[[appendage]]` by the assembled mass and stiffness matrices of a free structure.

    The nodes in `clamped` are held and the others vibrate. Participations and mass properties are products
    of the mass matrix with rigid motions, exact for lumped and consistent matrices. First moments are its
    products with linear displacements, with half their curl as rotation of the nodes: exact for lumped
    masses and for solids, and converging with the mesh for consistent matrices of bars and shells.

    Args:
        mass: The mass matrix, shape (rows, rows): NumPy, or a sparse one of SciPy. `flexsc.read_matrices`
            reads both from a file.
        stiffness: The stiffness matrix, in the same order. Its unit of force is that of the other units.
        positions: Where the nodes are, shape (nodes, 3).
        points: Names of points, with the numbers of their nodes, from 0.
        clamped: The numbers of the nodes that the body holds.
        damping: Damping ratio of all modes, or one for each that is kept.
        dofs: Node and direction of each row, shape (rows, 2): directions 1 to 3 are displacements along
            x, y and z, 4 to 6 rotations about them. Left out, the rows have three or six directions of each
            node, node after node.
        root: What `at` of the appendage places: the number of a node, or a position.
        name: Name of the appendage.
        keep: How many modes, those with the lowest frequencies.
        length_unit: Length of the model's unit (m); 1e-3 for millimetres.
        mass_unit: Its unit of mass (kg); 1e3 for tonnes.

    Returns:
        `name`, `mass`, `centre`, `inertia`, `points` and `modes`, in SI; add `at` and `turned`. A point at
        a node without rotations has none in its shapes.

    Raises:
        ImportError: Sparse matrices need SciPy: `pip install flexsc[matlab]`.
        ValueError: The matrices are none of a free structure, or nothing holds it; the text names it.

    >>> import flexsc, numpy as np
    >>> mass = np.diag([0, 0, 0, 2.0, 2.0, 2.0])             # a mass on springs along x, y and z
    >>> spring = np.diag([50.0, 18.0, 32.0])
    >>> stiffness = np.block([[spring, -spring], [-spring, spring]])
    >>> boom = flexsc.appendage_from_matrices(
    ...     mass, stiffness, [[0, 0, 0], [0, 0, 0]], {"tip": 1}, clamped=[0], damping=0.005, keep=3
    ... )
    >>> boom["mass"], [round(mode["frequency"], 12) for mode in boom["modes"]]
    (2.0, [3.0, 4.0, 5.0])
    """
    where = np.asarray(positions, dtype=np.float64)
    if where.ndim != 2 or where.shape[1:] != (3,) or not np.isfinite(where).all():
        raise ValueError(f"positions: must be finite, of shape (nodes, 3), got shape {where.shape}")
    mass, stiffness = _matrix("mass", mass), _matrix("stiffness", stiffness)
    rows = mass.shape[0]
    if stiffness.shape != mass.shape:
        raise ValueError(f"stiffness: must have the shape of the mass, {mass.shape}, got {stiffness.shape}")
    of_node, direction = _directions(dofs, rows, len(where))
    points = {} if points is None else points
    for label, numbers in (("clamped", list(clamped)), *((f"points: `{p}`", [n]) for p, n in points.items())):
        if wrong := [number for number in numbers if not 0 <= number < len(where)]:
            raise ValueError(f"{label}: must be nodes from 0 to {len(where) - 1}, got {wrong[0]}")
    origin = _place(root, where)
    motions = _linear_motions(where - origin, of_node, direction)
    rigid = np.column_stack([motions[:, :3], motions[:, 3:] @ _curls()])
    _check_free(stiffness, rigid)
    free = ~np.isin(of_node, np.asarray(list(clamped), dtype=np.intp))
    if free.all() or not free.any():
        raise ValueError("clamped: must be some nodes, not none or all of them")
    inside = np.flatnonzero(free)
    keep = _kept(keep, len(inside))
    frequencies, shapes = _modes(mass[inside][:, inside], stiffness[inside][:, inside], keep)
    shapes = _signed(shapes, direction[inside])
    zetas = _dampings(damping, keep)
    # What the clamped rows move counts as well: a consistent mass couples them.
    carried = np.asarray(shapes.T @ (mass[inside] @ motions))
    moments = carried[:, 3:].reshape(-1, 3, 3)
    rotation = np.asarray(shapes.T @ (mass[inside] @ rigid[:, 3:]))
    total = np.asarray(rigid.T @ (mass @ rigid))
    kilograms, centre, inertia = _body(total)

    whole = np.zeros((keep, len(where), 6))
    whole[:, of_node[inside], direction[inside]] = shapes.T
    turns = {int(node) for node in of_node[direction >= 3]}
    mass_root = float(np.sqrt(mass_unit))
    modes = []
    for at in range(keep):
        at_points = {}
        for point, number in points.items():
            shape = whole[at, number] / mass_root
            at_points[point] = {"translation": shape[:3].tolist()}
            if number in turns:
                at_points[point]["rotation"] = (shape[3:] / length_unit).tolist()
        modes.append(
            {
                "frequency": float(frequencies[at]),
                "damping": zetas[at],
                "translation": (mass_root * carried[at, :3]).tolist(),
                "rotation": (mass_root * length_unit * rotation[at]).tolist(),
                "moments": (mass_root * length_unit * moments[at]).tolist(),
                "shapes": at_points,
            }
        )
    return {
        "name": name,
        "mass": mass_unit * kilograms,
        "centre": (length_unit * centre).tolist(),
        "inertia": (mass_unit * length_unit**2 * inertia).tolist(),
        "points": [
            {"name": point, "position": (length_unit * (where[number] - origin)).tolist()}
            for point, number in points.items()
        ],
        "modes": modes,
    }


def _matrix(name: str, given: Any) -> Any:
    """A symmetric matrix of finite numbers: dense, or in SciPy's compressed rows."""
    sparse = hasattr(given, "tocsr")
    matrix = given.tocsr().astype(np.float64) if sparse else np.asarray(given, dtype=np.float64)
    if matrix.ndim != 2 or matrix.shape[0] != matrix.shape[1] or matrix.shape[0] == 0:
        raise ValueError(f"{name}: must be a square matrix, got shape {matrix.shape}")
    if not sparse and matrix.shape[0] > DENSE:
        raise ValueError(
            f"{name}: must have at most {DENSE} rows, or be a sparse matrix of SciPy; got {matrix.shape[0]}"
        )
    values = matrix.data if sparse else matrix
    if not np.isfinite(values).all():
        raise ValueError(f"{name}: must have finite elements")
    uneven, largest = abs(matrix - matrix.T).max(), abs(matrix).max()
    if uneven > SYMMETRIC * largest:
        raise ValueError(
            f"{name}: must be symmetric, and elements differ by {uneven:.3g} of {largest:.3g} "
            f"(half a matrix? add its transpose without the diagonal)"
        )
    return matrix


def _directions(dofs: npt.ArrayLike | None, rows: int, nodes: int) -> tuple[Rows, Rows]:
    """The node of each row, and its direction from 0 to 5."""
    if dofs is None:
        if rows not in (3 * nodes, 6 * nodes):
            raise ValueError(
                f"dofs: must be given unless each of {nodes} nodes has 3 or 6 rows, got {rows} rows"
            )
        each = rows // nodes
        return np.repeat(np.arange(nodes), each), np.tile(np.arange(each), nodes)
    table = np.asarray(dofs)
    if table.shape != (rows, 2) or not np.issubdtype(table.dtype, np.integer):
        raise ValueError(f"dofs: must be whole numbers of shape ({rows}, 2), got shape {table.shape}")
    node, direction = table[:, 0].astype(np.intp), table[:, 1].astype(np.intp) - 1
    if node.min() < 0 or node.max() >= nodes or direction.min() < 0 or direction.max() > 5:
        raise ValueError(f"dofs: must be nodes from 0 to {nodes - 1} and directions from 1 to 6")
    if len(np.unique(6 * node + direction)) != rows:
        raise ValueError("dofs: must name each direction of a node once")
    return node, direction


def _place(root: int | Sequence[float], where: Numbers) -> Numbers:
    if isinstance(root, int):
        if not 0 <= root < len(where):
            raise ValueError(f"root: must be a node from 0 to {len(where) - 1}, or a position, got {root}")
        return np.asarray(where[root])
    place = np.asarray(root, dtype=np.float64)
    if place.shape != (3,):
        raise ValueError(f"root: must be a node, or its three coordinates, got {root}")
    return place


def _linear_motions(where: Numbers, node: Rows, direction: Rows) -> Numbers:
    """What each row moves by: three translations, then u_j = r_k for each k and j, with half their curls."""
    motions = np.zeros((len(node), 12))
    for j in range(3):
        along = direction == j
        motions[along, j] = 1.0
        for k in range(3):
            motions[along, 3 + 3 * k + j] = where[node[along], k]
            if k != j:
                # The curl of e_j r_k is e_k x e_j.
                axis = 3 - j - k
                sign = 1.0 if (k, j) in ((0, 1), (1, 2), (2, 0)) else -1.0
                motions[direction == 3 + axis, 3 + 3 * k + j] = 0.5 * sign
    return motions


def _curls() -> Numbers:
    """Rotations about x, y and z as sums of the nine linear displacements u_j = r_k."""
    sums = np.zeros((9, 3))
    for axis, (k, j) in enumerate(((1, 2), (2, 0), (0, 1))):
        sums[3 * k + j, axis], sums[3 * j + k, axis] = 1.0, -1.0
    return sums


def _check_free(stiffness: Any, rigid: Numbers) -> None:
    """A rigid motion strains nothing: other units, an order of rows or a fixed node show here."""
    scale = abs(stiffness).max() * np.abs(rigid).max(axis=0)
    left = np.abs(np.asarray(stiffness @ rigid)).max(axis=0)
    names = ("along x", "along y", "along z", "about x", "about y", "about z")
    for direction, force, most in zip(names, left.tolist(), scale.tolist(), strict=True):
        if force > RIGID * most:
            raise ValueError(
                f"stiffness: must be that of a free structure, and a rigid motion {direction} is met by "
                f"{force / most:.3g} of its largest elements: matrices with the supports already removed, "
                f"another order of rows (`dofs`), or positions in another unit"
            )


def _kept(keep: int, rows: int) -> int:
    if not isinstance(keep, int) or isinstance(keep, bool) or keep < 1:
        raise ValueError(f"keep: must be a whole number from 1 on, got {keep}")
    return min(keep, rows)


def _modes(mass: Any, stiffness: Any, keep: int, key: str = "clamped") -> tuple[Numbers, Numbers]:
    """Frequencies (rad per unit of time) and shapes of unit generalised mass, shape (rows, keep).

    `key` is the argument that errors name.
    """
    held = f"{key}: must hold the structure: the stiffness that is left is not positive definite"
    if hasattr(mass, "tocsr"):
        from scipy.sparse.linalg import eigsh

        keep = min(keep, mass.shape[0] - 1)
        try:
            # The start makes the result repeatable.
            squares, shapes = eigsh(
                stiffness.tocsc(), keep, mass.tocsc(), sigma=0.0, which="LM", v0=np.ones(mass.shape[0])
            )
        except RuntimeError as error:
            raise ValueError(held) from error
        if squares.min() <= 0.0:
            raise ValueError(held)
        flexible = 1.0 / squares
    else:
        try:
            lower = np.linalg.cholesky(stiffness)
        except np.linalg.LinAlgError:
            raise ValueError(held) from None
        # By the inverse of the stiffness: the mass may have rows of zeros.
        half = np.linalg.solve(lower, mass)
        flexible, vectors = np.linalg.eigh(np.linalg.solve(lower, half.T))
        shapes = np.linalg.solve(lower.T, vectors[:, ::-1][:, :keep])
        flexible = flexible[::-1][:keep]
    least = flexible.max() * np.finfo(np.float64).eps * 1e2
    massive = flexible > least
    if not massive.all():
        raise ValueError(f"keep: must be at most {int(massive.sum())}, the modes that have mass, got {keep}")
    order = np.argsort(-flexible, kind="stable")
    frequencies = 1.0 / np.sqrt(flexible[order])
    if len(frequencies) > 1 and frequencies[0] <= MECHANISM * frequencies[1]:
        raise ValueError(
            f"{key}: must leave no mechanism, and a mode at {frequencies[0]:g} is below a thousandth of "
            f"the next ({frequencies[1]:g})"
        )
    shapes = shapes[:, order]
    norms = np.sqrt(np.einsum("ij,ij->j", shapes, np.asarray(mass @ shapes)))
    return frequencies, np.asarray(shapes / norms)


def _signed(shapes: Numbers, direction: Rows) -> Numbers:
    """The shapes with their largest displacement positive, or of those without any their largest rotation."""
    moved = np.abs(shapes) * (direction < 3)[:, None]
    still = moved.max(axis=0) == 0.0
    largest = np.where(still, np.abs(shapes).argmax(axis=0), moved.argmax(axis=0))
    return np.asarray(shapes * np.sign(shapes[largest, np.arange(shapes.shape[1])]))


def _body(total: Numbers) -> tuple[float, Numbers, Numbers]:
    """Mass, centre and inertia about the centre by the mass matrix of the six rigid motions."""
    masses = np.diagonal(total)[:3]
    mass = float(masses.mean())
    if not mass > 0.0 or float(np.abs(total[:3, :3] - mass * np.eye(3)).max()) > RIGID * mass:
        raise ValueError(
            f"mass: must be the same along x, y and z, got {', '.join(f'{value:.6g}' for value in masses)}"
        )
    cross = total[3:, :3]
    centre = np.array([cross[2, 1] - cross[1, 2], cross[0, 2] - cross[2, 0], cross[1, 0] - cross[0, 1]])
    centre = centre / (2.0 * mass)
    x, y, z = centre
    skew = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    inertia = total[3:, 3:] + mass * skew @ skew
    return mass, centre, 0.5 * (inertia + inertia.T)
