"""Lumped masses of Nastran's bulk data, and the integrals of shapes over them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from flexsc._numpy import np, npt

if TYPE_CHECKING:
    Numbers = npt.NDArray[np.float64]

# Elements whose mass goes to their ends, and to their corners, in equal parts.
_BARS = ("CBAR", "CBEAM")
_EQUAL = {
    "CROD": 2,
    "CONROD": 2,
    "CTUBE": 2,
    "CTRIA3": 3,
    "CQUAD4": 4,
    "CTETRA": 4,
    "CPENTA": 6,
    "CHEXA": 8,
}

# A grid point this near to the z axis of a cylindrical system, of its distance, has no radial direction.
AXIS = 1e-9


@dataclass(frozen=True, eq=False)
class Lump:
    """A rigid mass that moves with a grid point, in the model's units and the basic coordinate system."""

    grid: int
    mass: float
    offset: Numbers
    """Its centre of mass from the grid point."""
    second: Numbers
    """The integral of x x' dm about its centre of mass."""


@dataclass(frozen=True, eq=False)
class Integrals:
    """What an appendage is by its lumps, about a root, in the model's units."""

    mass: float
    centre: Numbers
    inertia: Numbers
    """About the centre of mass."""
    generalised: Numbers
    """Of each mode with each, shape (modes, modes)."""
    translation: Numbers
    """The integrals of phi dm, shape (modes, 3)."""
    moments: Numbers
    """The integrals of r phi' dm, shape (modes, 3, 3)."""

    @property
    def rotation(self) -> Numbers:
        """The integrals of r x phi dm, shape (modes, 3)."""
        n = self.moments
        parts = [n[:, 1, 2] - n[:, 2, 1], n[:, 2, 0] - n[:, 0, 2], n[:, 0, 1] - n[:, 1, 0]]
        return np.stack(parts, axis=1)

    @property
    def rigid(self) -> Numbers:
        """The mass matrix of the six rigid motions about the root."""
        x, y, z = self.centre
        cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        lower = self.inertia - self.mass * cross @ cross
        return np.block([[self.mass * np.eye(3), -self.mass * cross], [self.mass * cross, lower]])


def axes_of(grid: Any, path: Path) -> Numbers:
    """The axes of a grid point's displacements, as rows in the basic coordinate system."""
    name, system = f"{path}: GRID {grid.nid}: CD", grid.cd_ref
    if system is None or system.type.endswith("R"):
        return _axes(system, grid.Cd(), name)
    # Cylindrical or spherical: along the coordinate lines through the grid point.
    axes: Numbers = np.asarray(system.beta(), dtype=np.float64)
    x, y, z = axes @ (grid.get_position() - system.origin)
    across = np.hypot(x, y)
    if not across > AXIS * np.linalg.norm((x, y, z)):
        raise ValueError(
            f"{name}: must have axes, and the grid point is on the z axis of {system.type} {system.cid}"
        )
    c, s = x / across, y / across
    if system.type.endswith("C"):
        return np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]) @ axes
    up, out = np.array([z, across]) / np.hypot(z, across)
    return np.array([[out * c, out * s, up], [up * c, up * s, -out], [-s, c, 0.0]]) @ axes


def in_basic_axes(
    grids: Iterable[int], shapes: Mapping[int, Numbers], bulk: Any, path: Path
) -> tuple[dict[int, Numbers], dict[int, Numbers]]:
    """Positions and shapes, (modes, 6), of grid points in the basic coordinate system."""
    positions, turned = {}, {}
    for grid in grids:
        node = bulk.nodes[grid]
        positions[grid] = np.asarray(node.get_position(), dtype=np.float64)
        turned[grid] = (shapes[grid].reshape(-1, 2, 3) @ axes_of(node, path)).reshape(-1, 6)
    return positions, turned


def lumps_of(bulk: Any, path: Path) -> list[Lump]:
    """The masses of the model as Nastran lumps them (`COUPMASS` left out).

    Raises:
        ValueError: A mass is of a kind that has no such lumps; the text names it.
    """
    if "COUPMASS" in bulk.params and _parameter(bulk, "COUPMASS") > 0:
        raise ValueError(f"{path}: PARAM COUPMASS: must be left out: coupled masses are not at grid points")
    if bulk.nsms or bulk.nsmadds:
        raise ValueError(f"{path}: NSM: must be given by properties or CONM2, and is by NSM cards")
    scale = _parameter(bulk, "WTMASS") if "WTMASS" in bulk.params else 1.0
    found = [lump for element in bulk.elements.values() for lump in _of_element(bulk, element, path)]
    found += [_of_mass(bulk, mass, path) for mass in bulk.masses.values()]
    lumps = [
        Lump(lump.grid, scale * lump.mass, lump.offset, scale * lump.second)
        for lump in found
        if lump.mass or lump.second.any()
    ]
    if not sum(lump.mass for lump in lumps) > 0.0:
        raise ValueError(f"{path}: must have elements with density, or CONM2, and their mass is 0")
    return lumps


def integrals_of(
    lumps: list[Lump], positions: Mapping[int, Numbers], shapes: Mapping[int, Numbers], root: Numbers
) -> Integrals:
    """Integrate shapes in the basic coordinate system, (modes, 6) at each grid point, over the lumps."""
    mass = sum(lump.mass for lump in lumps)
    places = [positions[lump.grid] + lump.offset - root for lump in lumps]
    centre = sum((lump.mass * at for lump, at in zip(lumps, places, strict=True)), np.zeros(3)) / mass
    modes = len(next(iter(shapes.values())))
    inertia, generalised = np.zeros((3, 3)), np.zeros((modes, modes))
    translation, moments = np.zeros((modes, 3)), np.zeros((modes, 3, 3))
    for lump, at in zip(lumps, places, strict=True):
        moved, turned = shapes[lump.grid][:, :3], shapes[lump.grid][:, 3:]
        moved = moved + np.cross(turned, lump.offset)
        own = np.trace(lump.second) * np.eye(3) - lump.second
        arm = at - centre
        inertia += lump.mass * (arm @ arm * np.eye(3) - np.outer(arm, arm)) + own
        generalised += lump.mass * moved @ moved.T + turned @ own @ turned.T
        translation += lump.mass * moved
        # Of x in the lump the displacement is theta x x, and of x x' dm the integral is `second`.
        spun = np.cross(turned[:, None, :], lump.second)
        moments += lump.mass * at[None, :, None] * moved[:, None, :] + spun
    return Integrals(float(mass), centre, inertia, generalised, translation, moments)


def _of_element(bulk: Any, element: Any, path: Path) -> Iterator[Lump]:
    kind, name = element.type, f"{path}: {element.type} {element.eid}"
    if kind.startswith(("CELAS", "CBUSH", "CDAMP", "CVISC", "CGAP", "PLOTEL", "CFAST", "CWELD")):
        return  # springs and the like: without mass
    try:
        grids = [int(grid) for grid in element.node_ids if grid]
        if kind in _BARS:
            ends = [_end(bulk, element, end, path) for end in (0, 1)]
            between = bulk.nodes[grids[1]].get_position() - bulk.nodes[grids[0]].get_position()
            mass = element.MassPerLength() * float(np.linalg.norm(between + ends[1] - ends[0]))
        else:
            between = np.zeros(3)
            mass, ends = float(element.Mass()), [np.zeros(3)] * len(grids)
    except (AttributeError, KeyError, TypeError, RuntimeError) as error:
        raise ValueError(f"{name}: must have a property and a material, of which its mass follows") from error
    if not mass:
        return
    if kind not in _BARS and len(grids) != _EQUAL.get(kind):
        raise ValueError(
            f"{name}: must be one of {', '.join((*_BARS, *_EQUAL))} without mid-side grid points, or "
            f"have no density, got {len(grids)} grid points and the mass {mass:g}"
        )
    # Of a bar, Nastran lumps no inertia.
    own = _torsion(element, between + ends[1] - ends[0]) if kind == "CBEAM" else np.zeros((3, 3))
    for grid, end in zip(grids, ends, strict=True):
        yield Lump(grid, mass / len(grids), end, own)


def _torsion(element: Any, along: Numbers) -> Numbers:
    """The integral of x x' dm that gives an end of a beam half of its inertia rho (I1 + I2) L about its axis,
    and none across it, as Nastran lumps it."""
    length = float(np.linalg.norm(along))
    if not length > 0.0:
        return np.zeros((3, 3))
    polar = float(element.Rho() * (element.I11() + element.I22())) * length / 2.0
    axis = along / length
    second: Numbers = polar * (np.eye(3) / 2.0 - np.outer(axis, axis))
    return second


def _end(bulk: Any, element: Any, end: int, path: Path) -> Numbers:
    """Where the end of a bar is, from its grid point."""
    offset = np.asarray(element.wa if end == 0 else element.wb, dtype=np.float64)
    if not offset.any():
        return offset
    if element.offt[1 + end : 2 + end] != "G":
        raise ValueError(
            f"{path}: {element.type} {element.eid}: OFFT: must be `GGG` where there are offsets, got "
            f"`{element.offt}`"
        )
    grid = bulk.nodes[element.node_ids[end]]
    turned: Numbers = offset @ axes_of(grid, path)
    return turned


def _of_mass(bulk: Any, mass: Any, path: Path) -> Lump:
    name = f"{path}: {mass.type} {mass.eid}"
    if mass.type != "CONM2":
        raise ValueError(f"{name}: must be a CONM2, the only point mass that is read")
    offset = np.asarray(mass.X, dtype=np.float64)
    i11, i21, i22, i31, i32, i33 = (float(number) for number in mass.I)
    # The card has the products as integrals of xy dm, the tensor their negatives.
    tensor = np.array([[i11, -i21, -i31], [-i21, i22, -i32], [-i31, -i32, i33]])
    number = mass.Cid()
    if number == -1:
        # X is then the place itself, in the basic system.
        offset = offset - bulk.nodes[mass.Nid()].get_position()
    elif number:
        axes = _axes(mass.cid_ref, number, f"{name}: CID")
        offset, tensor = offset @ axes, axes.T @ tensor @ axes
    return Lump(mass.Nid(), float(mass.Mass()), offset, np.trace(tensor) / 2.0 * np.eye(3) - tensor)


def _axes(system: Any, number: int, name: str) -> Numbers:
    if number == 0:
        return np.eye(3)
    if system is None or not system.type.endswith("R"):
        kind = "missing" if system is None else system.type
        raise ValueError(f"{name}: must be a rectangular coordinate system, and {number} is {kind}")
    axes: Numbers = np.asarray(system.beta(), dtype=np.float64)
    return axes


def _parameter(bulk: Any, name: str) -> float:
    return float(bulk.params[name].values[0])
