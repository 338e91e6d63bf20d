"""Modes from Nastran: shapes of a normal-modes solution at chosen grid points, by way of pyNastran."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from flexsc._numpy import np, npt
from flexsc.structure._free_modes import check_free
from flexsc.structure._punch import Solution, read_punch
from flexsc.structure._structure import Structure

if TYPE_CHECKING:
    Numbers = npt.NDArray[np.float64]


def from_nastran(
    results: str | os.PathLike[str],
    model: str | os.PathLike[str],
    points: Mapping[str, int],
    *,
    damping: float = 0.005,
    lowest: float = 1e-2,
    centre: Sequence[float] | None = None,
    length_unit: float = 1.0,
    mass_unit: float = 1.0,
    subcase: int | None = None,
) -> Structure:
    """The structure of a normal-modes solution (SOL 103) of the free structure.

    Args:
        results: The OP2 file, or the punch file (`.pch`) of `DISPLACEMENT(PUNCH) = ALL`. Shapes of an OP2
            file are normalised by its generalised masses; those of a punch file must be so already
            (`EIGRL` with `NORM = MASS`, which is its default).
        model: The bulk data, for positions, coordinate systems, the centre of mass and the inertia tensor.
        points: Names of points, with the numbers of their grid points.
        damping: Damping ratio of all modes.
        lowest: Modes below this frequency (rad/s) are those of the rigid body, and left out. Those above it
            have neither momentum nor angular momentum, by the masses of the bulk data, if it has any: that
            needs shapes at all grid points with mass.
        centre: Centre of mass in the basic coordinate system, in the model's unit; left out, that of the
            model, whose inertia tensor the structure then has.
        length_unit: Length of the model's unit (m); 1e-3 for millimetres.
        mass_unit: Its unit of mass (kg); 1e3 for tonnes.
        subcase: Which subcase, if there are several.

    Raises:
        ImportError: pyNastran is not installed: `pip install flexsc[nastran]`.
        OSError: A file cannot be read.
        ValueError: The files lack something that is needed; the text names it.
    """
    path = Path(results)
    solution = _read_solution(path, subcase)
    bulk = _read_bulk(Path(model))
    origin, inertia = _mass_properties(bulk, centre)
    elastic = solution.frequencies > lowest
    if not elastic.any():
        raise ValueError(f"{path}: must have a mode above {lowest:g} rad/s, and has none")
    check_free(path, solution, elastic, bulk, Path(model))
    positions, shapes = {}, {}
    for name, number in points.items():
        if number not in bulk.nodes:
            raise ValueError(f"points: must be grid points of {model}, got {number} for `{name}`")
        if number not in solution.shapes:
            raise ValueError(f"points: must be grid points with shapes in {path}, got {number} for `{name}`")
        grid = bulk.nodes[number]
        positions[name] = (length_unit * (np.asarray(grid.get_position()) - origin)).tolist()
        to_basic = _output_system(grid)
        moved = solution.shapes[number][elastic].reshape(-1, 2, 3) @ to_basic
        # u = f q: f in 1/sqrt(mass), phi in 1/(length sqrt(mass)).
        moved[:, 0] /= np.sqrt(mass_unit)
        moved[:, 1] /= length_unit * np.sqrt(mass_unit)
        shapes[name] = moved.reshape(-1, 6)
    tensor = None if inertia is None else inertia * mass_unit * length_unit**2
    frequencies = solution.frequencies[elastic]
    return Structure(frequencies, np.full(len(frequencies), damping), positions, shapes, tensor)


def _read_solution(path: Path, subcase: int | None) -> Solution:
    """Frequencies and mass-normalised shapes of a punch file or of an OP2 file."""
    return read_punch(path, subcase) if path.suffix.lower() == ".pch" else _read_op2(path, subcase)


def _pynastran(module: str) -> Any:
    try:
        return import_module(f"pyNastran.{module}")
    except (ImportError, AttributeError) as error:  # of an older version, or beside NumPy 2
        raise ImportError(
            f"pyNastran cannot be used: {error}; `pip install flexsc[nastran]` brings it, with NumPy below 2"
        ) from error


def _read_op2(path: Path, subcase: int | None) -> Solution:
    """Frequencies and mass-normalised shapes of an OP2 file."""
    if not path.is_file():
        raise FileNotFoundError(f"{path}: no such file")
    reader = _pynastran("op2.op2")
    try:
        op2 = reader.read_op2(str(path), debug=None, build_dataframe=False)
    except Exception as error:  # pyNastran's are of many kinds
        raise ValueError(
            f"{path}: pyNastran cannot read it: {' '.join(str(error).split()) or type(error).__name__}: did "
            f"the run end, and does it have normal modes (SOL 103)?"
        ) from error
    # A key is the subcase, or begins with it.
    vectors = {key[0] if isinstance(key, tuple) else key: found for key, found in op2.eigenvectors.items()}
    if not vectors:
        raise ValueError(
            f"{path}: must have eigenvectors, and has none: ask for them by `DISPLACEMENT(PLOT) = ALL`"
        )
    if subcase is None and len(vectors) > 1:
        raise ValueError(f"subcase: must be one of {sorted(vectors)}")
    chosen = next(iter(vectors)) if subcase is None else subcase
    if chosen not in vectors:
        raise ValueError(f"subcase: must be one of {sorted(vectors)}, got {chosen}")
    found = vectors[chosen]
    if (kind := _other_solution(found)) is not None:
        raise ValueError(f"{path}: must have real normal modes (SOL 103), and has {kind}")
    numbers = np.asarray(found.modes)
    tables = [
        table
        for table in op2.eigenvalues.values()
        if hasattr(table, "generalized_mass") and set(numbers) <= set(table.mode)
    ]
    if not tables:
        # Without the table of eigenvalues (LAMA), the masses of the bulk data show how shapes are normalised.
        squares = np.asarray(found.eigns, dtype=np.float64)
        return Solution(np.sqrt(np.maximum(squares, 0.0)), _by_grid(found, np.ones(len(numbers))))
    row = {int(number): index for index, number in enumerate(tables[0].mode)}
    rows = [row[int(number)] for number in numbers]
    masses = np.asarray(tables[0].generalized_mass, dtype=np.float64)[rows]
    if not (masses > 0.0).all():
        raise ValueError(f"{path}: must have positive generalised masses, got {masses.min():g}")
    return Solution(np.asarray(tables[0].radians, dtype=np.float64)[rows], _by_grid(found, masses))


def _by_grid(found: Any, masses: Numbers) -> dict[int, Numbers]:
    """The shapes at each grid point, divided by the roots of these generalised masses."""
    data = np.asarray(found.data, dtype=np.float64) / np.sqrt(masses)[:, None, None]
    return {int(node): data[:, index] for index, (node, _) in enumerate(found.node_gridtype)}


def _other_solution(found: Any) -> str | None:
    """The kind of eigenvectors that are not those of real normal modes."""
    if np.iscomplexobj(found.data):
        return "complex ones: leave out damping, rotation and other unsymmetric terms"
    code = getattr(found, "analysis_code", 2)
    if code in (7, 8):
        return "those of buckling (SOL 105)"
    return None if code == 2 else f"other vectors (analysis code {code})"


def _read_bulk(path: Path) -> Any:
    text = path.read_text(encoding="latin-1").upper()
    bulk = _pynastran("bdf.bdf").BDF(debug=None)
    # Without the sections before it, it is bulk data alone.
    try:
        bulk.read_bdf(str(path), xref=False, punch="BEGIN BULK" not in text)
        bulk.safe_cross_reference()
    except Exception as error:  # pyNastran's are of many kinds
        raise ValueError(f"{path}: pyNastran cannot read it: {' '.join(str(error).split())}") from error
    return bulk


def _mass_properties(bulk: Any, centre: Sequence[float] | None) -> tuple[Numbers, Numbers | None]:
    """Centre of mass and inertia tensor about it, in the model's units."""
    if centre is not None:
        # Who knows it better than the model knows the inertia tensor better, too.
        return np.asarray(centre, dtype=np.float64), None
    mass, found, (xx, yy, zz, xy, xz, yz) = _pynastran("bdf.mesh_utils.mass_properties").mass_properties(bulk)
    if not mass > 0.0:
        raise ValueError("centre: must be given, as the model has neither elements nor masses")
    tensor = np.array([[xx, -xy, -xz], [-xy, yy, -yz], [-xz, -yz, zz]], dtype=np.float64)
    return np.asarray(found, dtype=np.float64), tensor


def _output_system(grid: Any) -> Numbers:
    """The axes of a grid point's shapes, as rows in the basic coordinate system."""
    system = grid.cd_ref
    if system is None or grid.Cd() == 0:
        return np.eye(3)
    if not system.type.endswith("R"):
        raise ValueError(
            f"points: must have their shapes in rectangular coordinates, and those of grid point "
            f"{grid.nid} are in {system.type} {system.cid}"
        )
    axes: Numbers = np.asarray(system.beta(), dtype=np.float64)
    return axes
