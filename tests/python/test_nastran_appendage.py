"""Clamped appendages from Nastran: participations and first moments against integrals that others made."""

import csv
from pathlib import Path
from typing import Any

import flexsc
import numpy as np
import numpy.typing as npt
import pytest

pytest.importorskip(
    "pyNastran", reason="pyNastran reads Nastran's files, and is not installed", exc_type=ImportError
)

from test_nastran import op2

Numbers = npt.NDArray[np.float64]

FE = Path(__file__).parents[1] / "golden" / "fe"
# By the lumped masses of the decks: mass (kg), centre (m), inertia about the root (kg m²), and the first
# mode at grid point 14, as MYSTRAN printed it.
RIGID: dict[str, tuple[float, list[float], list[list[float]]]] = {
    "bars": (
        14.4,
        [2.375, 0.266666667, 0.888888889],
        [[27.196, -11.52, -38.4], [-11.52, 116.95, -7.68], [-38.4, -7.68, 97.946]],
    ),
    "feet": (
        15.9620499,
        [2.167047, 0.269928674, 0.801902015],
        [[27.477169, -11.52, -38.4], [-11.52, 117.145256, -7.68], [-38.4, -7.68, 98.4224252]],
    ),
}
TIPS = {
    "bars": ([-0.04118546, 0.3687698, -0.1968875], [-0.1364885, 0.01592753, 0.06131487]),
    "feet": ([0.03663659, 0.3501904, -0.2530619], [-0.1512204, 0.04408074, 0.04097566]),
}


def expected(structure: str) -> Numbers:
    """Frequency, t, r and N of each mode."""
    lines = [line for line in (FE / "expected.csv").read_text().splitlines() if not line.startswith("#")]
    rows = [row for row in csv.reader(lines) if row[0] == structure]
    return np.array([[float(number) for number in row[1:]] for row in rows])


def columns(appendage: dict[str, Any]) -> tuple[Numbers, Numbers, Numbers, Numbers]:
    modes = appendage["modes"]
    keys = ("frequency", "translation", "rotation", "moments")
    frequency, t, r, n = (np.array([mode[key] for mode in modes]) for key in keys)
    return frequency, t, r, n


def agree(appendage: dict[str, Any], structure: str, tolerance: float) -> None:
    table = expected(structure)
    frequency, t, r, n = columns(appendage)
    assert len(frequency) == len(table) == 10
    np.testing.assert_allclose(frequency, table[:, 0], rtol=1e-6)
    np.testing.assert_allclose(t, table[:, 1:4], rtol=0.0, atol=tolerance * np.sqrt(appendage["mass"]))
    for mode, row in enumerate(table):
        largest = np.abs(row[7:]).max()
        np.testing.assert_allclose(r[mode], row[4:7], rtol=0.0, atol=tolerance * largest)
        np.testing.assert_allclose(n[mode], row[7:].reshape(3, 3), rtol=0.0, atol=tolerance * largest)


def punched(name: str) -> tuple[list[int], list[float], Numbers]:
    """Grid points, frequencies and shapes of a punch file, by its columns."""
    lines = [line[:72] for line in (FE / f"{name}.pch").read_text().splitlines()]
    numbers: dict[int, list[list[float]]] = {}
    frequencies = []
    for at, line in enumerate(lines):
        if line.startswith("$EIGENVALUE"):
            frequencies.append(float(line.split("=")[1].split()[0]) ** 0.5)
        elif not line.startswith(("$", "-")):
            row = [float(field) for field in (line[18:] + lines[at + 1][18:]).split()]
            numbers.setdefault(int(line[:10]), []).append(row)
    return list(numbers), frequencies, np.array(list(numbers.values())).transpose(1, 0, 2)


@pytest.mark.parametrize("name", ["bars", "feet"])
def test_a_boom_of_bars_from_its_punch_file(name: str) -> None:
    # The clamp of `feet` has two grid points; its factors in the printed file are wrong, these are not.
    appendage = flexsc.appendage_from_nastran(
        FE / f"{name}.pch", FE / f"{name}.bdf", {"tip": 14}, damping=0.005
    )
    agree(appendage, name, 1e-7)
    mass, centre, about_root = RIGID[name]
    c = np.array(appendage["centre"])
    np.testing.assert_allclose(appendage["mass"], mass, rtol=1e-8)
    np.testing.assert_allclose(c, centre, rtol=1e-8)
    moved = np.array(appendage["inertia"]) + mass * (c @ c * np.eye(3) - np.outer(c, c))
    np.testing.assert_allclose(moved, about_root, rtol=1e-7)
    assert appendage["points"] == [{"name": "tip", "position": [3.0, 1.2, 2.0]}]
    tip = appendage["modes"][0]["shapes"]["tip"]
    np.testing.assert_allclose(tip["translation"], TIPS[name][0], rtol=1e-6)
    np.testing.assert_allclose(tip["rotation"], TIPS[name][1], rtol=1e-6)
    assert {mode["damping"] for mode in appendage["modes"]} == {0.005}


def test_an_op2_file_of_shapes_scaled_to_their_largest(tmp_path: Path) -> None:
    grids, frequencies, shapes = punched("bars")
    scale = 1.0 / np.abs(shapes).max(axis=(1, 2))
    results = op2(
        tmp_path / "run.op2",
        frequencies=frequencies,
        masses=(scale**2).tolist(),
        grids=grids,
        shapes=shapes * scale[:, None, None],
    )
    # It is in single precision.
    appendage = flexsc.appendage_from_nastran(results, FE / "bars.bdf", damping=0.0)
    agree(appendage, "bars", 1e-6)
    assert appendage["points"] == []


def test_about_another_root_and_with_fewer_modes() -> None:
    files = (FE / "bars.pch", FE / "bars.bdf")
    whole = flexsc.appendage_from_nastran(*files, damping=0.005)
    some = flexsc.appendage_from_nastran(
        *files, {"root": 3, "tip": 14}, damping=[0.01, 0.02, 0.03], root=3, keep=3, name="boom"
    )
    assert some["name"] == "boom"
    assert [mode["damping"] for mode in some["modes"]] == [0.01, 0.02, 0.03]
    b = np.array([1.0, 0.0, 0.0])
    (_, t, r, n), (_, t3, r3, n3) = columns(whole), columns(some)
    np.testing.assert_array_equal(t3, t[:3])
    np.testing.assert_allclose(n3, n[:3] - b[:, None] * t[:3, None, :], atol=1e-12)
    np.testing.assert_allclose(r3, r[:3] - np.cross(b, t[:3]), atol=1e-12)
    np.testing.assert_allclose(some["centre"], np.array(whole["centre"]) - b)
    np.testing.assert_allclose(some["inertia"], whole["inertia"], rtol=1e-12)
    assert [point["position"] for point in some["points"]] == [[0.0, 0.0, 0.0], [2.0, 1.2, 2.0]]
    other = flexsc.appendage_from_nastran(*files, damping=0.005, root=(1.0, 0.0, 0.0), keep=3)
    assert other["modes"][0]["moments"] == some["modes"][0]["moments"]


def card(name: str, *fields: object) -> str:
    """A card of large fields, 16 columns each."""
    lines = [fields[at : at + 4] for at in range(0, len(fields), 4)]
    heads = [f"{name}*", *["*"] * (len(lines) - 1)]
    rows = [
        f"{head:8s}"
        + "".join(f"{field:<#16.9g}" if isinstance(field, float) else f"{field:<16}" for field in row)
        for head, row in zip(heads, lines, strict=True)
    ]
    return "\n".join(rows if len(rows) % 2 == 0 else [*rows, "*"]) + "\n"


def turned(about: int, by: float) -> Numbers:
    """A coordinate system's axes as rows."""
    c, s, j, k = np.cos(by), np.sin(by), (about + 1) % 3, (about + 2) % 3
    axes = np.eye(3)
    axes[j, j], axes[j, k], axes[k, j], axes[k, k] = c, s, -s, c
    return axes


@pytest.mark.parametrize("system", ["basic", "turned", "place", "cylinder", "sphere"])
def test_offsets_inertias_coordinate_systems_and_units(tmp_path: Path, system: str) -> None:
    """A CONM2 with its inertia and an offset bar are the mass points that they are made of; mm and tonnes."""
    rng = np.random.default_rng(7)
    b5, b6 = turned(2, 0.7) @ turned(0, 0.4), turned(1, -0.9) @ turned(2, 0.3)
    root, grid, offset = (
        np.array([10.0, 20.0, 30.0]),
        np.array([510.0, -80.0, 230.0]),
        np.array([0.0, 40.0, 9.0]),
    )
    # A body of five mass points, about the grid point in the card's axes.
    points, masses = rng.uniform(-90.0, 90.0, (5, 3)), rng.uniform(1e-3, 4e-3, 5)
    axes = b6 if system == "turned" else np.eye(3)
    mean = masses @ points / masses.sum()
    arms = points - mean
    tensor: Any = sum(m * (a @ a * np.eye(3) - np.outer(a, a)) for m, a in zip(masses, arms, strict=True))
    at = mean + grid if system == "place" else mean
    number = {"turned": 6, "place": -1}.get(system, 0)
    products = (tensor[0, 0], -tensor[1, 0], tensor[1, 1], -tensor[2, 0], -tensor[2, 1], tensor[2, 2])
    deck = card("GRID", 1, "", *root) + card("GRID", 2, "", *grid, 5)
    for system_number, rows in ((5, b5), (6, b6)):
        deck += card("CORD2R", system_number, "", 0.0, 0.0, 0.0, *rows[2], *rows[0])
    deck += card("CONM2", 7, 2, number, float(masses.sum()), *at, "", *products)
    # A bar of 0.2 kg/m, its end at grid point 2 offset in that one's axes.
    deck += card("CBAR", 1, 1, 1, 2, 0.0, 0.0, 1.0, "", "", "", 0.0, 0.0, 0.0, *offset)
    deck += card("PBAR", 1, 1, 100.0, 1.0, 1.0, 1.0) + card("MAT1", 1, 7e4, "", 0.3, 2e-9) + "ENDDATA\n"
    model = tmp_path / "model.bdf"
    model.write_text(deck)
    if system in ("cylinder", "sphere"):
        # The same in a system of polar coordinates about a place of its own; the axes follow from it.
        away = np.array([100.0, 50.0, -20.0])
        kind = {"cylinder": "CORD2C", "sphere": "CORD2S"}[system]
        polar = card(kind, 5, "", *away, *(away + b5[2]), *(away + b5[0]))
        deck = deck.replace(card("CORD2R", 5, "", 0.0, 0.0, 0.0, *b5[2], *b5[0]), polar)
        model.write_text(deck)
        radial = grid - away
        round_it = np.cross(b5[2], radial)
        round_it /= np.linalg.norm(round_it)
        first = radial / np.linalg.norm(radial) if system == "sphere" else np.cross(round_it, b5[2])
        second, third = (np.cross(round_it, first), round_it) if system == "sphere" else (round_it, b5[2])
        b5 = np.array([first, second, third])
    end = offset @ b5
    bar = 2e-7 * np.linalg.norm(grid + end - root)
    everything = [*zip(masses, points @ axes, strict=True), (bar / 2.0, end)]
    # One mode; the row is in system 5, single precision.
    row = rng.uniform(-1.0, 1.0, 6) * [1.0, 1.0, 1.0, 0.02, 0.02, 0.02]
    row = row.astype(np.float32).astype(np.float64)
    phi, theta = row[:3] @ b5, row[3:] @ b5
    moved = [(m, grid - root + d, phi + np.cross(theta, d)) for m, d in everything]
    generalised = sum(m * u @ u for m, _, u in moved)
    results = op2(
        tmp_path / "run.op2",
        frequencies=(3.0,),
        masses=(float(generalised),),
        grids=(1, 2),
        shapes=np.array([[np.zeros(6), row]]),
    )
    appendage = flexsc.appendage_from_nastran(
        results, model, {"tip": 2}, damping=0.0, root=1, length_unit=1e-3, mass_unit=1e3
    )
    unit = np.sqrt(1e3) / np.sqrt(generalised)
    t = unit * sum(m * u for m, _, u in moved)
    n = unit * 1e-3 * sum(m * np.outer(p, u) for m, p, u in moved)
    r = unit * 1e-3 * sum(m * np.cross(p, u) for m, p, u in moved)
    (mode,) = appendage["modes"]
    np.testing.assert_allclose(mode["translation"], t, rtol=0.0, atol=1e-7 * np.abs(t).max())
    np.testing.assert_allclose(mode["moments"], n, rtol=0.0, atol=1e-7 * np.abs(n).max())
    np.testing.assert_allclose(mode["rotation"], r, rtol=0.0, atol=1e-7 * np.abs(n).max())
    tip = mode["shapes"]["tip"]
    f, psi = phi / np.sqrt(1e3 * generalised), 1e3 * theta / np.sqrt(1e3 * generalised)
    np.testing.assert_allclose(tip["translation"], f, rtol=0.0, atol=1e-7 * np.abs(f).max())
    np.testing.assert_allclose(tip["rotation"], psi, rtol=0.0, atol=1e-7 * np.abs(psi).max())
    everywhere = [(m, p) for m, p, _ in moved] + [(bar / 2.0, np.zeros(3))]
    mass = sum(m for m, _ in everywhere)
    centre = sum(m * p for m, p in everywhere) / mass
    inertia = sum(
        m * ((p - centre) @ (p - centre) * np.eye(3) - np.outer(p - centre, p - centre))
        for m, p in everywhere
    )
    np.testing.assert_allclose(appendage["mass"], 1e3 * mass, rtol=1e-8)
    np.testing.assert_allclose(appendage["centre"], 1e-3 * centre, rtol=1e-7)
    np.testing.assert_allclose(appendage["inertia"], 1e-3 * inertia, rtol=1e-6, atol=1e-9)


def test_a_plate_shares_its_mass_among_its_corners(tmp_path: Path) -> None:
    model = tmp_path / "plate.bdf"
    corners = ((0, 0), (2, 0), (2, 1), (0, 1))
    grids = "".join(f"GRID,{at},,{x}.,{y}.,0.\n" for at, (x, y) in enumerate(corners, 1))
    plate = "CQUAD4,1,1,1,2,3,4\nPSHELL,1,1,0.01\nMAT1,1,7.+10,,0.3,2000.\nPARAM,WTMASS,0.5\n"
    model.write_text(f"{grids}{plate}ENDDATA\n")
    shapes = np.zeros((1, 4, 6))
    shapes[0, 1:3, 2] = 1.0
    # 20 kg by the half, a quarter at each corner.
    results = op2(tmp_path / "run.op2", frequencies=(3.0,), masses=(10.0,), grids=(1, 2, 3, 4), shapes=shapes)
    appendage = flexsc.appendage_from_nastran(results, model, damping=0.0)
    assert appendage["mass"] == pytest.approx(20.0)
    assert appendage["centre"] == pytest.approx([1.0, 0.5, 0.0])
    np.testing.assert_allclose(appendage["modes"][0]["translation"], [0.0, 0.0, 10.0 / np.sqrt(10.0)])
    np.testing.assert_allclose(
        appendage["modes"][0]["rotation"], [5.0 / np.sqrt(10.0), -20.0 / np.sqrt(10.0), 0]
    )


@pytest.mark.parametrize(
    ("cards", "mass", "moving"),
    [
        ("CROD,1,1,1,5\nPROD,1,1,.01\n", 20.0, 10.0),
        ("CBEAM,1,1,1,5,1.,0.,0.\nPBEAM,1,1,.01,1.-6,1.-6,,1.-6,0.5\n", 20.5, 10.25),
        ("CTRIA3,1,1,1,2,5\nPSHELL,1,1,.01\n", 10.0, 10.0 / 3.0),
        ("CTETRA,1,1,1,2,4,5\nPSOLID,1,1\n", 1000.0 / 3.0, 250.0 / 3.0),
        ("CPENTA,1,1,1,2,3,5,6,7\nPSOLID,1,1\n", 1000.0, 500.0),
        ("CHEXA,1,1,1,2,3,4,5,6\n,7,8\nPSOLID,1,1\n", 2000.0, 1000.0),
    ],
)
def test_elements_share_their_mass(tmp_path: Path, cards: str, mass: float, moving: float) -> None:
    """In a unit cube of 2000 kg/m³ whose upper corners move along x, t_x² is the mass that moves."""
    model = tmp_path / "cube.bdf"
    corners = [(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
    grids = "".join(f"GRID,{at},,{x}.,{y}.,{z}.\n" for at, (x, y, z) in enumerate(corners, 1))
    model.write_text(f"{grids}{cards}MAT1,1,7.+10,,0.3,2000.\nENDDATA\n")
    shapes = np.zeros((1, 8, 6))
    shapes[0, 4:, 0] = 1.0
    results = op2(
        tmp_path / "run.op2", frequencies=(3.0,), masses=(moving,), grids=range(1, 9), shapes=shapes
    )
    appendage = flexsc.appendage_from_nastran(results, model, damping=0.0)
    assert appendage["mass"] == pytest.approx(mass)
    assert appendage["modes"][0]["translation"] == pytest.approx([moving**0.5, 0.0, 0.0])
    # At z = 1.
    assert appendage["modes"][0]["moments"][2] == pytest.approx([moving**0.5, 0.0, 0.0])


def craft(appendage: dict[str, Any], force: str = "tip") -> flexsc.Scenario:
    return flexsc.Scenario(
        {
            "duration": 60.0,
            "spacecraft": {"mass": 600.0, "inertia": [[250, 0, 0], [0, 300, 0], [0, 0, 220]]},
            "appendage": [{**appendage, "at": [1.0, 0.0, 0.0]}],
            "disturbance": [{"force": [0.0, 0.0, 1.0], "point": force, "from": 5.0, "to": 15.0}],
            "law": {"attitude": {"period": 0.5, "bandwidth": 0.05}},
            "actuator": {
                "wheels": {"arrangement": "pyramid", "inertia": 0.06, "torque": 0.2, "momentum": 25.0}
            },
        },
        "boom",
    )


def test_a_spacecraft_with_it_runs(tmp_path: Path) -> None:
    appendage = flexsc.appendage_from_nastran(
        FE / "bars.pch", FE / "bars.bdf", {"tip": 14}, damping=0.005, keep=6
    )
    scenario = craft(appendage)
    # With the hub free a mode is faster.
    assert len(scenario.modes["frequency"]) == 6
    assert scenario.modes["frequency"][0] > appendage["modes"][0]["frequency"]
    # The same from the factors that the solver printed, which the engine reads itself.
    printed = {key: appendage[key] for key in ("name", "mass", "centre", "inertia")}
    rival = craft({**printed, "modes": str(FE / "bars.F06"), "damping": 0.005, "keep": 6}, force="hub")
    np.testing.assert_allclose(rival.modes["frequency"], scenario.modes["frequency"], rtol=1e-6)
    run = scenario.simulate(log="none")
    assert run.metrics["elastic_energy_peak_j"] > 0.0
    again = flexsc.Scenario.parse(scenario.to_toml(), "boom").simulate(log="none")
    assert again.metrics == run.metrics
    with pytest.raises(ValueError, match="got `\\[spacecraft\\]`: write `to_toml\\(\\)`"):
        flexsc.structure.write_scenario(scenario, tmp_path / "boom.toml")


def test_what_the_files_do_not_tell_is_refused(tmp_path: Path) -> None:
    shapes, deck = (FE / "bars.pch").read_text(), (FE / "bars.bdf").read_text()
    results, model = tmp_path / "run.pch", tmp_path / "model.bdf"

    def refused(why: str, shapes: str = shapes, deck: str = deck, **keys: Any) -> None:
        results.write_text(shapes)
        model.write_text(deck)
        every: dict[str, Any] = {"damping": 0.005, **keys}
        with pytest.raises(ValueError, match=why):
            flexsc.appendage_from_nastran(results, model, **every)

    # The masses of another deck.
    refused(
        "run.pch: shapes must be normalised by the masses of .*model.bdf", deck=deck.replace("200.", "210.")
    )
    # The mass at the tip is elsewhere.
    lever = "CONM2   50      14              2.0             0.3\n"
    refused(
        "shapes must be .* by the masses", deck=deck.replace("CONM2   50      14      0       2.0\n", lever)
    )
    refused("model.bdf: PARAM COUPMASS: must be left out", deck=deck.replace("GRDPNT  0", "COUPMASS 1"))
    refused(
        "must have elements with density, or CONM2", deck=deck.replace("200.", "0.").replace("2.0\n", "0.0\n")
    )
    lines = shapes.splitlines(keepends=True)
    without = "".join(
        line
        for at, line in enumerate(lines)
        if not line.startswith("        14 ") and not lines[at - 1].startswith("        14 ")
    )
    refused("run.pch: must have shapes at all grid points with mass, .* none at 14$", without)
    refused("points: must be grid points of .*, got 15 for `tip`", points={"tip": 15})
    refused("root: must be a grid point of .*model.bdf, or its place, got 99", root=99)
    refused("keep: must be 1 to 10, the modes of .*run.pch, got 11", keep=11)
    refused("damping: must be one number, or one for each of 4 modes", keep=4, damping=[0.1, 0.2])
    clamped = shapes.replace("         1       G      0.000000E+00", "         1       G      1.000000E-09")
    refused("run.pch: must have a grid point at rest in all modes: clamp the root", clamped)
    slow = shapes.replace("3.8787030E+01", "3.8787030E-09")
    refused("must have no mode at 6.22\\S* rad/s, below a thousandth of the next .* clamp the root", slow)
    twice = shapes.replace("MODE =     2", "MODE =     1")
    refused("run.pch: line 43: must have each grid point once in a mode, got 1 again in mode 1", twice)
    same = "".join(lines[:35]) + "".join(lines[:35]).replace("MODE =     1", "MODE =     2")
    refused("shapes must be orthogonal by the masses .*, and modes 1 and 2 have", same)
    polar = deck.replace("      0       2.0\n", "      5       2.0     1.0\n").replace(
        "SPC1 ", "CORD2C,5,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nSPC1 "
    )
    refused("CONM2 50: CID: must be a rectangular coordinate system, and 5 is CORD2C", deck=polar)
    axial = deck.replace("GRID    1               0.0000  0.0000  0.0000  ", "GRID,1,,0.,0.,0.,5")
    axial = axial.replace("SPC1 ", "CORD2S,5,,0.,0.,-1.,0.,0.,1.\n,1.,0.,0.\nSPC1 ")
    refused("model.bdf: GRID 1: CD: must have axes, and the grid point is on the z axis", deck=axial)
    refused(
        "CBAR 1: must have a property and a material",
        deck=deck.replace("CBAR    1       1", "CBAR    1       9"),
    )
    refused("CONM1 9: must be a CONM2", deck=deck.replace("SPC1 ", "CONM1,9,14,,1.\nSPC1 "))
    refused("model.bdf: pyNastran cannot read it", deck=deck.replace("0.5000", "0.5.00"))


def test_a_beam_lumps_half_of_its_torsional_inertia_at_each_end(tmp_path: Path) -> None:
    """A shaft along x: the closed form of two freedoms, with rho (I1 + I2) L/2 at both ends of a CBEAM."""
    radius, length, tip = 0.02, 0.5, 5e-5
    polar = np.pi * radius**4 / 2
    stiffness, lump = 26.6e9 * polar / length, 2700.0 * polar * length / 2
    m, k = np.diag([2 * lump, lump + tip]), stiffness * np.array([[2.0, -1.0], [-1.0, 1.0]])
    half = np.diag(1.0 / np.sqrt(np.diagonal(m)))
    squares, vectors = np.linalg.eigh(half @ k @ half)
    turns = half @ vectors
    (tmp_path / "shaft.bdf").write_text(
        "SOL 103\nCEND\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,0.5,0.,0.\nGRID,3,,1.,0.,0.\n"
        "CBEAM,1,1,1,2,0.,1.,0.\nCBEAM,2,1,2,3,0.,1.,0.\nPBEAML,1,1,,ROD\n,0.02\nMAT1,1,7.E10,2.66E10,,2700.\n"
        "CONM2,9,3,,1.5\n,5.E-5,,1.E-4,,,1.E-4\nSPC1,1,123456,1\nENDDATA\n"
    )
    lines = ["$EIGENVECTOR", "$REAL OUTPUT", "$SUBCASE ID =           1"]
    for mode in range(2):
        lines.append(f"$EIGENVALUE = {squares[mode]:.7E}  MODE = {mode + 1:5d}")
        for grid, turn in ((1, 0.0), (2, turns[0, mode]), (3, turns[1, mode])):
            lines.append(f"{grid:10d}       G" + f"{0.0:18.6E}" * 3)
            lines.append("-CONT-            " + f"{turn:18.6E}" + f"{0.0:18.6E}" * 2)
    (tmp_path / "shaft.pch").write_text(
        "".join(f"{line:72s}{number:8d}\n" for number, line in enumerate(lines, 1))
    )
    shaft = flexsc.appendage_from_nastran(
        tmp_path / "shaft.pch", tmp_path / "shaft.bdf", damping=0.01, root=1
    )
    for mode, about in zip(shaft["modes"], (m @ turns).sum(axis=0), strict=True):
        np.testing.assert_allclose(mode["rotation"], [about, 0.0, 0.0], rtol=2e-6, atol=1e-12)
