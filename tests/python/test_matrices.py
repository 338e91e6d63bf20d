"""Appendages from assembled matrices: a cantilever of beam elements beside its closed form."""

from pathlib import Path
from typing import Any

import flexsc
import numpy as np
import numpy.typing as npt
import pytest

Numbers = npt.NDArray[np.float64]

LENGTH, MASS, WIDTH, DEPTH = 3.0, 6.0, 0.08, 0.05
YOUNG, SHEAR = 70e9, 26e9
NODES = 41


def beam(nodes: int = NODES, consistent: bool = True) -> tuple[Numbers, Numbers, Numbers]:
    """Mass and stiffness of an Euler-Bernoulli beam along x, six directions a node, and the positions."""
    h = LENGTH / (nodes - 1)
    rho, area = MASS / LENGTH, WIDTH * DEPTH
    about_y, about_z = WIDTH * DEPTH**3 / 12, DEPTH * WIDTH**3 / 12
    polar, torsion = rho * (about_y + about_z) / area, about_y + about_z
    mass, stiffness = np.zeros((6 * nodes, 6 * nodes)), np.zeros((6 * nodes, 6 * nodes))
    bar = np.array([[1.0, -1.0], [-1.0, 1.0]])
    spread = np.array([[2.0, 1.0], [1.0, 2.0]]) / 6.0
    bend = (
        np.array(
            [
                [12, 6 * h, -12, 6 * h],
                [6 * h, 4 * h * h, -6 * h, 2 * h * h],
                [-12, -6 * h, 12, -6 * h],
                [6 * h, 2 * h * h, -6 * h, 4 * h * h],
            ]
        )
        / h**3
    )
    move = (
        rho
        * h
        / 420
        * np.array(
            [
                [156, 22 * h, 54, -13 * h],
                [22 * h, 4 * h * h, 13 * h, -3 * h * h],
                [54, 13 * h, 156, -22 * h],
                [-13 * h, -3 * h * h, -22 * h, 4 * h * h],
            ]
        )
    )
    # The deflection along z turns about -y.
    turned = np.diag([1.0, -1.0, 1.0, -1.0])
    for first in range(0, 6 * (nodes - 1), 6):

        def put(rows: tuple[int, ...], k: Numbers, m: Numbers, first: int = first) -> None:
            at = np.ix_([first + row for row in rows], [first + row for row in rows])
            stiffness[at] += k
            mass[at] += m

        put((0, 6), YOUNG * area / h * bar, rho * h * spread)
        put((3, 9), SHEAR * torsion / h * bar, polar * h * spread)
        put((1, 5, 7, 11), YOUNG * about_z * bend, move)
        put((2, 4, 8, 10), YOUNG * about_y * turned @ bend @ turned, turned @ move @ turned)
    if not consistent:
        lumps = rho * h * np.r_[0.5, np.ones(nodes - 2), 0.5]
        mass = np.diag(np.outer(lumps, [1, 1, 1, polar / rho, 0, 0]).ravel())
    positions = np.column_stack([np.linspace(0, LENGTH, nodes), np.zeros(nodes), np.zeros(nodes)])
    return mass, stiffness, positions


def cantilever(count: int) -> list[tuple[float, float, float]]:
    """Bending modes in closed form: b L, and integrals of phi and x phi for a unit generalised mass."""
    x = np.polynomial.legendre.leggauss(400)
    s, w = (x[0] + 1) / 2, x[1] / 2
    told = []
    for n in range(count):
        low, high = n * np.pi + 1.0, (n + 1) * np.pi
        for _ in range(200):
            middle = (low + high) / 2
            sign = np.sign(np.cos(low) + 1 / np.cosh(low)) == np.sign(np.cos(middle) + 1 / np.cosh(middle))
            low, high = (middle, high) if sign else (low, middle)
        b = low
        ratio = (np.cosh(b) + np.cos(b)) / (np.sinh(b) + np.sin(b))
        shape = np.cosh(b * s) - np.cos(b * s) - ratio * (np.sinh(b * s) - np.sin(b * s))
        scale = np.sqrt(MASS / (w @ shape**2))
        told.append((b, scale * (w @ shape), scale * LENGTH * (w @ (s * shape))))
    return told


def appendage(**keys: Any) -> dict[str, Any]:
    mass, stiffness, positions = beam(consistent=keys.pop("consistent", True))
    settings: dict[str, Any] = {"clamped": [0], "damping": 0.004, "keep": 8, **keys}
    return flexsc.appendage_from_matrices(mass, stiffness, positions, {"tip": NODES - 1}, **settings)


@pytest.mark.parametrize(("consistent", "within"), [(True, 2e-6), (False, 3e-3)])
def test_a_cantilever_is_that_of_the_closed_form(consistent: bool, within: float) -> None:
    boom = appendage(consistent=consistent)
    assert boom["mass"] == pytest.approx(MASS, rel=1e-12)
    assert boom["centre"] == pytest.approx([LENGTH / 2, 0, 0], abs=1e-12)
    across = MASS * LENGTH**2 / 12
    about = MASS * (WIDTH**2 + DEPTH**2) / 12
    assert np.diag(boom["inertia"]) == pytest.approx([about, across, across], rel=2e-3)
    # Along z it is softer: odd modes there, even ones along y, of two directions of bending.
    bending = [mode for mode in boom["modes"] if max(map(abs, mode["translation"][1:])) > 1e-6][:4]
    closed = cantilever(3)
    for axis, second in ((2, WIDTH * DEPTH**3 / 12), (1, DEPTH * WIDTH**3 / 12)):
        found = [mode for mode in bending if abs(mode["translation"][axis]) > 1e-6]
        assert len(found) == 2
        for mode, (b, carried, turned) in zip(found, closed, strict=False):
            w = b**2 * np.sqrt(YOUNG * second / (MASS / LENGTH * LENGTH**4))
            assert mode["frequency"] == pytest.approx(w, rel=within)
            sign = np.sign(mode["translation"][axis] * carried)
            assert sign * mode["translation"][axis] == pytest.approx(carried, rel=within)
            moments = np.array(mode["moments"])
            assert sign * moments[0, axis] == pytest.approx(turned, rel=200 * within)
            rotation = [0.0, -turned, 0.0] if axis == 2 else [0.0, 0.0, turned]
            assert sign * np.array(mode["rotation"]) == pytest.approx(rotation, rel=within, abs=1e-9)
            tip = mode["shapes"]["tip"]["translation"][axis]
            assert abs(tip) == pytest.approx(2 / np.sqrt(MASS), rel=5 * within)


def test_units_and_the_root_are_those_that_are_told() -> None:
    mass, stiffness, positions = beam()
    small = flexsc.appendage_from_matrices(
        # In tonnes and millimetres, rows of rotations in N mm.
        mass * scaled(1e-3),
        stiffness * scaled(1e-3),
        positions * 1e3,
        {"tip": NODES - 1},
        clamped=[0],
        damping=0.004,
        keep=8,
        root=NODES - 1,
        length_unit=1e-3,
        mass_unit=1e3,
    )
    whole = appendage()
    assert small["mass"] == pytest.approx(whole["mass"], rel=1e-12)
    assert small["centre"] == pytest.approx([-LENGTH / 2, 0, 0], abs=1e-9)
    for one, other in zip(small["modes"], whole["modes"], strict=True):
        assert one["frequency"] == pytest.approx(other["frequency"], rel=1e-9)
        assert one["translation"] == pytest.approx(other["translation"], rel=1e-6, abs=1e-7)
        shapes = [mode["shapes"]["tip"]["rotation"] for mode in (one, other)]
        assert shapes[0] == pytest.approx(shapes[1], rel=1e-6, abs=1e-7)


def scaled(tonnes: float) -> Numbers:
    length = np.tile([1.0, 1.0, 1.0, 1e3, 1e3, 1e3], NODES)
    return tonnes * np.outer(length, length)


def test_sparse_matrices_and_rows_in_any_order() -> None:
    sparse = pytest.importorskip("scipy.sparse")
    mass, stiffness, positions = beam()
    order = np.random.default_rng(3).permutation(6 * NODES)
    dofs = np.column_stack([np.repeat(np.arange(NODES), 6), np.tile(np.arange(1, 7), NODES)])[order]
    some = flexsc.appendage_from_matrices(
        sparse.csc_array(mass[order][:, order]),
        sparse.coo_array(stiffness[order][:, order]),
        positions,
        {"tip": NODES - 1},
        clamped=[0],
        damping=0.004,
        keep=8,
        dofs=dofs,
    )
    for one, other in zip(some["modes"], appendage()["modes"], strict=True):
        assert one["frequency"] == pytest.approx(other["frequency"], rel=1e-9)
        assert np.abs(one["translation"]) == pytest.approx(np.abs(other["translation"]), rel=1e-6, abs=1e-7)


def test_it_flies() -> None:
    boom = appendage(keep=4)
    scenario = flexsc.Scenario(
        {
            "duration": 20.0,
            "spacecraft": {"mass": 200.0, "inertia": [[80, 0, 0], [0, 90, 0], [0, 0, 70]]},
            "appendage": [{**boom, "at": [0.5, 0.0, 0.0]}],
            "sensor": {"sampled": {"period": 0.5}},
            "law": {"attitude": {"period": 0.5, "bandwidth": 0.1}},
        }
    )
    assert scenario.modes
    assert scenario.simulate().metrics["pointing_error_end_rad"] < 1e-6


@pytest.mark.parametrize(
    ("keys", "told"),
    [
        ({"clamped": []}, "clamped: must be some nodes"),
        ({"clamped": [NODES]}, "clamped: must be nodes from 0 to 40"),
        ({"damping": [0.1, 0.2]}, "damping: must be one number"),
        ({"keep": 0}, "keep: must be a whole number"),
        ({"root": (1.0, 2.0)}, "root: must be a node"),
        ({"dofs": [[0, 1]]}, "dofs: must be whole numbers of shape"),
    ],
)
def test_what_does_not_fit_is_told(keys: dict[str, Any], told: str) -> None:
    with pytest.raises(ValueError, match=told):
        appendage(**keys)


def test_matrices_of_another_kind_are_told() -> None:
    mass, stiffness, positions = beam()

    def told(
        mass: Numbers = mass, stiffness: Numbers = stiffness, positions: Numbers = positions, **keys: Any
    ) -> str:
        settings: dict[str, Any] = {"clamped": [0], "damping": 0.0, **keys}
        with pytest.raises(ValueError, match=":") as caught:
            flexsc.appendage_from_matrices(mass, stiffness, positions, **settings)
        return str(caught.value)

    assert "mass: must be symmetric" in told(mass=np.triu(mass))
    assert "stiffness: must be that of a free structure" in told(positions=positions * 2.0)
    assert "stiffness: must have the shape" in told(stiffness=stiffness[6:, 6:])
    assert "dofs: must be given" in told(mass=mass[:7, :7], stiffness=stiffness[:7, :7])
    heavier = mass + np.diag(np.tile([0.1, 0, 0, 0, 0, 0], NODES))
    assert "mass: must be the same along x, y and z" in told(mass=heavier)
    assert "must have finite elements" in told(mass=mass * np.nan)
    # A hinge at the root: held against displacements alone.
    hinged = np.column_stack([np.repeat(np.arange(NODES), 6), np.tile(np.arange(1, 7), NODES)])
    hinged[3:6, 0] = NODES
    loose = np.vstack([positions, positions[:1]])
    assert "must hold the structure" in told(positions=loose, dofs=hinged)


@pytest.mark.parametrize("kind", ["npz", "sparse npz", "mat", "mtx"])
def test_files_of_matrices(kind: str, tmp_path: Path) -> None:
    mass, stiffness, _ = beam(nodes=3)
    path = tmp_path / f"beam.{kind.split()[-1]}"
    if kind == "npz":
        np.savez(path, MGG=mass, KGG=stiffness, about="a beam")
        found = flexsc.read_matrices(path)
        assert sorted(found) == ["KGG", "MGG"]
    elif kind == "sparse npz":
        sparse = pytest.importorskip("scipy.sparse")
        sparse.save_npz(path, sparse.csr_array(mass))
        found = {"MGG": flexsc.read_matrices(path)["matrix"].toarray()}
    elif kind == "mat":
        pytest.importorskip("scipy.io").savemat(path, {"MGG": mass, "KGG": stiffness, "words": "no"})
        found = flexsc.read_matrices(path)
        assert sorted(found) == ["KGG", "MGG"]
    else:
        rows = [
            f"{i + 1} {j + 1} {mass[i, j]:.17e}".replace("e", "D")
            for i, j in zip(*np.nonzero(mass), strict=True)
        ]
        head = f"%%MatrixMarket matrix coordinate real general\n{len(mass)} {len(mass)} {len(rows)}\n"
        path.write_text(head + "\n".join(rows) + "\n")
        matrix = flexsc.read_matrices(path)["matrix"]
        found = {"MGG": matrix.toarray() if hasattr(matrix, "toarray") else matrix}
    assert np.array_equal(found["MGG"], mass)


def test_a_symmetric_file_has_one_triangle(tmp_path: Path) -> None:
    path = tmp_path / "both.mtx"
    text = "%%MatrixMarket matrix coordinate real symmetric\n2 2 4\n1 1 4\n2 1 1\n1 2 1\n2 2 3\n"
    path.write_text(text)
    with pytest.raises(ValueError, match="line 5: must not mirror line 4"):
        flexsc.read_matrices(path)
    path.write_text(text.replace("2 2 4\n", "2 2 3\n", 1).replace("1 2 1\n", ""))
    matrix = flexsc.read_matrices(path)["matrix"]
    assert np.array_equal(
        matrix.toarray() if hasattr(matrix, "toarray") else matrix, [[4.0, 1.0], [1.0, 3.0]]
    )


def reduced() -> tuple[Numbers, Numbers, Numbers]:
    """The cantilever of these tests as a Craig-Bampton model of four modes, with the shapes of its modes."""
    mass, stiffness, positions = beam()
    inside = np.arange(6, len(mass))
    part = np.ix_(inside, inside)
    lower = np.linalg.cholesky(mass[part] + 1e-12 * np.eye(len(inside)))
    squares, vectors = np.linalg.eigh(np.linalg.solve(lower, np.linalg.solve(lower, stiffness[part]).T))
    modes = np.linalg.solve(lower.T, vectors[:, :4])
    rigid = np.vstack([np.eye(6)] * len(positions))
    for at, place in enumerate(positions):
        rigid[6 * at : 6 * at + 3, 3:] = np.cross(np.eye(3), place - positions[0]).T
    basis = np.zeros((len(mass), 10))
    basis[:, :6] = rigid
    basis[inside, 6:] = modes
    assert (squares[:4] > 0.0).all()
    return basis.T @ mass @ basis, basis.T @ stiffness @ basis, basis


def test_a_craig_bampton_model_is_its_structure() -> None:
    mass, stiffness, positions = beam()
    reduced_mass, reduced_stiffness, basis = reduced()
    tip = len(positions) - 1
    whole = flexsc.appendage_from_matrices(
        mass, stiffness, positions, {"tip": tip}, clamped=[0], damping=0.01, keep=4, root=0
    )
    recovery = basis[6 * tip : 6 * tip + 6]
    order = [6, 7, 8, 9, 0, 1, 2, 3, 4, 5]
    found = flexsc.appendage_from_craig_bampton(
        reduced_mass[np.ix_(order, order)],
        reduced_stiffness[np.ix_(order, order)],
        [4, 5, 6, 7, 8, 9],
        positions=[positions[0]],
        root=positions[0],
        points={"tip": (positions[tip], recovery[:, order])},
        damping=0.01,
    )
    for key in ("mass", "centre", "inertia"):
        np.testing.assert_allclose(found[key], whole[key], rtol=1e-6, atol=1e-6)
    for own, expected in zip(found["modes"], whole["modes"], strict=True):
        assert own["frequency"] == pytest.approx(expected["frequency"], rel=1e-6)
        t, r = (np.array([mode[key] for mode in (own, expected)]) for key in ("translation", "rotation"))
        np.testing.assert_allclose(
            np.linalg.norm(t, axis=1)[0], np.linalg.norm(t, axis=1)[1], rtol=1e-5, atol=1e-6
        )
        np.testing.assert_allclose(
            np.linalg.norm(r, axis=1)[0], np.linalg.norm(r, axis=1)[1], rtol=1e-5, atol=1e-6
        )
        tips = [np.linalg.norm(mode["shapes"]["tip"]["translation"]) for mode in (own, expected)]
        assert tips[0] == pytest.approx(tips[1], rel=1e-4)


def test_matrices_that_are_not_reduced_are_told() -> None:
    mass, stiffness, _ = reduced()

    def told(**keys: Any) -> str:
        given: dict[str, Any] = {"mass": mass, "stiffness": stiffness, "damping": 0.01} | keys
        with pytest.raises(ValueError, match=":") as error:
            flexsc.appendage_from_craig_bampton(**given)
        return str(error.value)

    coupled = stiffness.copy()
    coupled[0, 6] = coupled[6, 0] = 1.0
    assert "must be 0 between interface and modes" in told(stiffness=coupled)
    grounded = stiffness + np.diag([5.0] * 6 + [0.0] * 4)
    assert "must meet no rigid motion" in told(stiffness=grounded)
    assert "interface: must be six rows for each node" in told(interface=[0, 1, 2])
    assert "interface: must be rows from 0 to 9" in told(interface=[0, 1, 2, 3, 4, 10])
    heavier = mass.copy()
    heavier[:6, 6:] *= 3.0
    heavier[6:, :6] *= 3.0
    assert "carried twice" in told(mass=heavier)
    assert "recovery matrix of shape" in told(points={"tip": ([0, 0, 0], np.eye(3))})


def test_files_that_hold_none_are_told(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"must end in \.npz"):
        flexsc.read_matrices(tmp_path / "a.txt")
    with pytest.raises(FileNotFoundError):
        flexsc.read_matrices(tmp_path / "a.npz")
    (tmp_path / "b.npz").write_bytes(b"no archive")
    with pytest.raises(ValueError, match=r"cannot be read as \.npz"):
        flexsc.read_matrices(tmp_path / "b.npz")
    np.savez(tmp_path / "c.npz", a=np.arange(3.0))
    with pytest.raises(ValueError, match="must have a matrix of numbers, and has a"):
        flexsc.read_matrices(tmp_path / "c.npz")
