"""Structures from Nastran: files as the solver writes them, written here, read by way of pyNastran."""

import struct
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import flexsc
import numpy as np
import numpy.typing as npt
import pytest

pytest.importorskip(
    "pyNastran", reason="pyNastran reads Nastran's files, and is not installed", exc_type=ImportError
)

Numbers = npt.NDArray[np.float64]

# Tonnes and millimetres. Two masses, the second out of the axes; its shapes are in system 5, turned by 90
# degrees about z.
BULK = """\
CEND
BEGIN BULK
CORD2R,5,,0.,0.,0.,0.,0.,1.
,0.,1.,0.
GRID,10,,0.,0.,0.
GRID,20,,3000.,1000.,500.,5
CONM2,1,10,,2.,0.,0.,0.,,+
+,4.E6,0.,4.E6,0.,0.,4.E6
CONM2,2,20,,1.
ENDDATA
"""
# Two modes of the rigid body, and two elastic ones.
FREQUENCIES = (0.0, 1e-4, 1.5, 4.0)
MASSES = (1.0, 1.0, 4.0, 0.25)
GRIDS = (10, 20)


def free_shapes() -> Numbers:
    """Two motions of the rigid body and two elastic ones, without momentum in the masses of the bulk data."""
    arm = np.array([3000.0, 1000.0, 500.0])
    mass = np.diag([2.0] * 3 + [4e6] * 3 + [1.0] * 3 + [0.0] * 3)
    motions = np.vstack([np.eye(6), np.eye(6)])
    motions[6:9, 3:] = np.cross(np.eye(3), arm).T
    drawn = (
        np.random.default_rng(3).uniform(-1.0, 1.0, (12, 2)) * np.tile(np.repeat([1.0, 1e-3], 3), 2)[:, None]
    )
    elastic = drawn - motions @ np.linalg.solve(motions.T @ mass @ motions, motions.T @ mass @ drawn)
    rigid = motions[:, :2]
    both = np.column_stack([rigid / np.sqrt(3.0), elastic])
    both[:, 2:] *= np.sqrt(np.array(MASSES[2:]) / np.diagonal(elastic.T @ mass @ elastic))
    rows = both.T.reshape(4, 2, 2, 3).copy()
    # Of grid point 20 in system 5, whose x is the basic y and whose y the basic -x.
    rows[:, 1] = np.stack([rows[:, 1, :, 1], -rows[:, 1, :, 0], rows[:, 1, :, 2]], axis=-1)
    return rows.reshape(4, 2, 6).astype(np.float32).astype(np.float64)


SHAPES = free_shapes()
POINTS = {"bus": 10, "tip": 20}


def op2(
    path: Path,
    subcases: Sequence[int] = (1,),
    frequencies: Sequence[float] = FREQUENCIES,
    masses: Sequence[float] = MASSES,
    grids: Sequence[int] = GRIDS,
    shapes: Numbers | None = None,
    table: bool = True,
    approach: int = 22,
) -> Path:
    """An OP2 file of eigenvalues and eigenvectors: Fortran records, tables of numbered ones."""

    shapes = SHAPES if shapes is None else shapes

    def words(*numbers: int) -> bytes:
        return b"".join(struct.pack("<3i", 4, number, 4) for number in numbers)

    def record(data: bytes) -> bytes:
        return struct.pack("<i", len(data)) + data + struct.pack("<i", len(data))

    def named(name: str, records: list[bytes]) -> bytes:
        title = name.ljust(8).encode()
        head = words(2) + record(title) + words(-1, 7) + record(struct.pack("<7i", 102, 0, 0, 0, 512, 0, 0))
        head += words(-2, 1, 0, 7) + record(title + struct.pack("<5i", 1, 1, 20, 0, 1))
        body = [words(-3 - at, 1, 0, len(data) // 4) + record(data) for at, data in enumerate(records)]
        return head + b"".join(body) + words(-3 - len(records), 1, 0, 0)

    def identification(**at: float) -> bytes:
        numbers = [struct.pack("<i", 0)] * 50
        for place, number in at.items():
            numbers[int(place[1:]) - 1] = struct.pack("<f" if isinstance(number, float) else "<i", number)
        return b"".join(numbers) + b" " * 384

    def eigenvalue(at: int) -> bytes:
        w, mass = frequencies[at], masses[at]
        return struct.pack("<2i5f", at + 1, at + 1, w * w, w, w / (2 * np.pi), mass, mass * w * w)

    vectors = []
    for subcase in subcases:
        for at, w in enumerate(frequencies):
            cycles = w / (2 * np.pi)
            vectors.append(
                identification(w1=approach, w2=7, w4=subcase, w5=at + 1, w6=w * w, w7=cycles, w9=1, w10=8)
            )
            rows = zip(grids, shapes[at], strict=True)
            vectors.append(b"".join(struct.pack("<2i6f", 10 * grid + 2, 1, *row) for grid, row in rows))
    head = (
        words(3) + record(struct.pack("<3i", 1, 1, 20)) + words(7) + record(b"NASTRAN FORT TAPE ID CODE - ")
    )
    head += words(2) + record(b"XXXXXXXX") + words(-1, 0)
    values = [identification(w1=21, w2=6, w4=1, w10=7), b"".join(map(eigenvalue, range(len(frequencies))))]
    path.write_bytes(head + (named("LAMA", values) if table else b"") + named("OUGV1", vectors) + words(0))
    return path


def punch(path: Path) -> Path:
    """A punch file: lines of 72 columns with their number after them."""
    lines = ["$TITLE   = A BEAM", "$EIGENVECTOR", "$REAL OUTPUT", "$SUBCASE ID =           1"]
    for at, w in enumerate(FREQUENCIES):
        lines.append(f"$EIGENVALUE = {w * w:.7E}  MODE = {at + 1:5d}")
        for grid, row in zip(GRIDS, SHAPES[at] / np.sqrt(MASSES[at]), strict=True):
            first, second = ("".join(f"{number:18.6E}" for number in part) for part in (row[:3], row[3:]))
            lines += [f"{grid:10d}       G{first}", f"-CONT-            {second}"]
    lines += ["$ELEMENT FORCES", "         1            1.0"]
    path.write_text("".join(f"{line:72s}{number:8d}\n" for number, line in enumerate(lines, 1)))
    return path


@pytest.fixture
def bulk(tmp_path: Path) -> Path:
    path = tmp_path / "model.bdf"
    path.write_text(BULK)
    return path


READ: list[tuple[str, Callable[[Path], Path], float]] = [("op2", op2, 1e-6), ("pch", punch, 2e-6)]


@pytest.mark.parametrize(("kind", "write", "tolerance"), READ, ids=["op2", "punch"])
def test_shapes_are_mass_normalised_and_in_si(
    tmp_path: Path, bulk: Path, kind: str, write: Callable[[Path], Path], tolerance: float
) -> None:
    results = write(tmp_path / f"run.{kind}")
    structure = flexsc.from_nastran(results, bulk, POINTS, damping=0.01, length_unit=1e-3, mass_unit=1e3)
    np.testing.assert_allclose(structure.frequencies, [1.5, 4.0], rtol=tolerance)
    np.testing.assert_array_equal(structure.dampings, [0.01, 0.01])
    scale = np.array([1.0] * 3 + [1e3] * 3) / np.sqrt(1e3)
    for mode, mass in ((0, 4.0), (1, 0.25)):
        bus, tip = SHAPES[2 + mode] / np.sqrt(mass) * scale
        np.testing.assert_allclose(structure.shapes["bus"][mode], bus, rtol=tolerance, atol=1e-9)
        # The axes of system 5: x is the basic y, y the basic -x.
        turned = [-tip[1], tip[0], tip[2], -tip[4], tip[3], tip[5]]
        np.testing.assert_allclose(structure.shapes["tip"][mode], turned, rtol=tolerance, atol=1e-9)
    np.testing.assert_allclose(structure.positions["bus"], [-1.0, -1.0 / 3.0, -1.0 / 6.0])
    np.testing.assert_allclose(structure.positions["tip"], [2.0, 2.0 / 3.0, 1.0 / 3.0])
    inertia = 4e3 * np.eye(3)
    for mass, name in ((2e3, "bus"), (1e3, "tip")):
        r = np.array(structure.positions[name])
        inertia += mass * (r @ r * np.eye(3) - np.outer(r, r))
    assert structure.inertia is not None
    np.testing.assert_allclose(structure.inertia, inertia, rtol=1e-12)


def test_a_scenario_of_it_runs(tmp_path: Path, bulk: Path) -> None:
    structure = flexsc.from_nastran(op2(tmp_path / "run.op2"), bulk, POINTS, length_unit=1e-3, mass_unit=1e3)
    axes = {"roll": ("tip", [0, 0, 1]), "pitch": ("tip", [0, 0, -1]), "yaw": ("tip", [0, 1, 0])}
    thrusters = [
        {"name": f"{axis} {sign}", "point": point, "direction": [sense * d for d in direction], "thrust": 2.0}
        for axis, (point, direction) in axes.items()
        for sign, sense in (("+", 1.0), ("-", -1.0))
    ]
    groups = {axis: {"plus": [f"{axis} +"], "minus": [f"{axis} -"]} for axis in axes}
    targets = [{"from": 1.0, "yaw": 0.1}]
    scenario = structure.scenario(
        gyro="bus",
        jets={"thrusters": thrusters, "groups": groups},
        law={"targets": targets, "rate_limit": 5e-3},
        duration=60.0,
    )
    run = scenario.simulate(log="none")
    assert run.metrics["firings"] > 0
    assert run.metrics["elastic_energy_peak_j"] > 0.0


def test_modes_with_momentum_are_refused(tmp_path: Path, bulk: Path) -> None:
    run = op2(tmp_path / "noise.op2", frequencies=(0.02, 0.11, 1.5, 4.0))
    with pytest.raises(
        ValueError, match=r"2 up to 0.11 rad/s are motions of the rigid body: give `lowest=0.11[56]`"
    ):
        flexsc.from_nastran(run, bulk, POINTS)
    assert len(flexsc.from_nastran(run, bulk, POINTS, lowest=0.116).frequencies) == 2
    held = SHAPES.copy()
    held[:, 0] = 0.0
    held /= np.sqrt(np.sum(held[:, 1, :3] ** 2, axis=1))[:, None, None] / np.sqrt(MASSES)[:, None, None]
    with pytest.raises(ValueError, match=r"at 1.5 rad/s has momentum: .* `flexsc.appendage_from_nastran`"):
        flexsc.from_nastran(op2(tmp_path / "held.op2", shapes=held), bulk, POINTS)
    pushed = SHAPES.copy()
    pushed[2, :, 2] += 0.02
    with pytest.raises(ValueError, match=r"at 1.5 rad/s has 0.0\d+ of the momentum|generalised mass"):
        flexsc.from_nastran(op2(tmp_path / "pushed.op2", shapes=pushed), bulk, POINTS)
    scaled = op2(tmp_path / "scaled.op2", masses=(1.0,) * 4)
    with pytest.raises(ValueError, match=r"the mode at 1.5 rad/s has the generalised mass 4"):
        flexsc.from_nastran(scaled, bulk, POINTS)
    with pytest.raises(ValueError, match=r"`DISPLACEMENT = ALL`, .* and has none at 20"):
        flexsc.from_nastran(op2(tmp_path / "part.op2", grids=(10,), shapes=SHAPES[:, :1]), bulk, {"bus": 10})
    # Coupled masses have no lumps: in equal parts they show a motion of the rigid body all the same.
    bulk.write_text(BULK.replace("ENDDATA", "PARAM,COUPMASS,1\nENDDATA"))
    with pytest.raises(ValueError, match=r"motions of the rigid body"):
        flexsc.from_nastran(run, bulk, POINTS)


def test_without_its_table_of_eigenvalues_a_file_is_read(tmp_path: Path, bulk: Path) -> None:
    whole = op2(tmp_path / "run.op2")
    unit = SHAPES / np.sqrt(MASSES)[:, None, None]
    bare = op2(tmp_path / "bare.op2", masses=(1.0,) * 4, shapes=unit, table=False)
    assert b"LAMA" not in bare.read_bytes()
    assert b"LAMA" in whole.read_bytes()
    expected = flexsc.from_nastran(whole, bulk, POINTS)
    found = flexsc.from_nastran(bare, bulk, POINTS)
    np.testing.assert_allclose(found.frequencies, expected.frequencies, rtol=1e-6)
    np.testing.assert_allclose(found.shapes["tip"], expected.shapes["tip"], rtol=1e-5, atol=1e-9)


def test_other_runs_are_named(tmp_path: Path, bulk: Path) -> None:
    torn = tmp_path / "torn.op2"
    torn.write_bytes(op2(tmp_path / "run.op2").read_bytes()[:700])
    with pytest.raises(ValueError, match=r"pyNastran cannot read it|no eigenvectors|has none"):
        flexsc.from_nastran(torn, bulk, POINTS)
    buckling = op2(tmp_path / "buckling.op2", approach=83)
    with pytest.raises(ValueError, match=r"has those of buckling|pyNastran cannot read it|has none"):
        flexsc.from_nastran(buckling, bulk, POINTS)


def test_what_the_files_do_not_tell_is_refused(tmp_path: Path, bulk: Path) -> None:
    results = op2(tmp_path / "run.op2")

    def refused(why: str, points: dict[str, int] = POINTS, at: Path = results, **keys: Any) -> None:
        with pytest.raises(ValueError, match=why):
            flexsc.from_nastran(at, bulk, points, **keys)

    refused("points: must be grid points of .*, got 30 for `none`", {"none": 30})
    refused("must have a mode above 5 rad/s", lowest=5.0)
    refused("subcase: must be one of \\[1\\], got 2", subcase=2)
    refused("subcase: must be one of \\[1, 2\\]", at=op2(tmp_path / "two.op2", (1, 2)))
    empty = tmp_path / "empty.pch"
    empty.write_text("$TITLE\n")
    refused("empty.pch: must have eigenvectors", at=empty)
    torn = punch(tmp_path / "torn.pch")
    torn.write_text(torn.read_text().replace("E-01", "E?01"))
    refused("torn.pch: line 6: must have numbers, got", at=torn)
    with pytest.raises(FileNotFoundError):
        flexsc.from_nastran(tmp_path / "none.op2", bulk, POINTS)
    bulk.write_text("GRID,10,,0.,0.,0.\nGRID,20,,1.,2.,3.,5\nCORD2C,5,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n")
    refused("centre: must be given, as the model has neither elements nor masses", {"bus": 10})
    structure = flexsc.from_nastran(results, bulk, {"bus": 10}, centre=(1.0, 0.0, 0.0))
    assert structure.inertia is None
    assert structure.positions == {"bus": [-1.0, 0.0, 0.0]}
    refused("rectangular coordinates, and those of grid point 20 are in CORD2C 5", centre=(0.0, 0.0, 0.0))
