"""Structures that others published, as they are: tests/golden/foreign/public has sources and licences."""

import re
from pathlib import Path
from typing import Any

import flexsc
import numpy as np
import numpy.typing as npt
import pytest

pytest.importorskip(
    "pyNastran", reason="pyNastran reads Nastran's files, and is not installed", exc_type=ImportError
)

PUBLIC = Path(__file__).parents[1] / "golden" / "foreign" / "public"
BEAM = PUBLIC / "pynastran" / "beam_modes_m1.op2", PUBLIC / "pynastran" / "beam_modes.dat"
INCH, SLINCH = 0.0254, 175.126835
# Where the interface of pyYeti's launch vehicle is (in), and the axes of its second grid point: CORD2R 10.
INTERFACE = np.array([[600.0, 0.0, 300.0], [600.0, 300.0, 300.0], [600.0, 300.0, 0.0], [600.0, 0.0, 0.0]])
TURNED = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])


def frequencies(appendage: dict[str, Any]) -> list[float]:
    return [mode["frequency"] for mode in appendage["modes"]]


@pytest.mark.parametrize("keep", [4, None])
def test_msc_lumps_a_beam_with_torsional_inertia_and_no_other(keep: int | None) -> None:
    """Ten modes of MSC Nastran, of bending, torsion and extension, have the masses of its table."""
    beam = flexsc.appendage_from_nastran(*BEAM, {"tip": 11}, damping=0.005, keep=keep)
    printed = [2869.2815, 2869.2815, 16804.93, 16804.93, 22336.24, 28321.377, 41633.04, 41633.04]
    np.testing.assert_allclose(frequencies(beam)[:8], printed[:keep], rtol=1e-6)


def test_simcenter_writes_millimetres_and_kilograms() -> None:
    op2, deck = (PUBLIC / "pynastran" / f"pn_mwe_s-solution_1.{ending}" for ending in ("op2", "dat"))
    satellite = flexsc.appendage_from_nastran(op2, deck, {}, damping=0.005, length_unit=1e-3, mass_unit=1.0)
    assert satellite["mass"] == pytest.approx(5.085, abs=5e-4)
    # rad/s, as the table of eigenvalues of the file has them.
    np.testing.assert_allclose(frequencies(satellite), [562.72675, 562.72675, 6564.418], rtol=1e-6)


def reduced(name: str) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """MXX and KXX, with the interface in the basic coordinate system."""
    found = flexsc.read_matrices(PUBLIC / "pyyeti" / f"{name}.op4")
    turn = np.eye(found["MXX"].shape[0])
    turn[6:9, 6:9] = turn[9:12, 9:12] = TURNED
    mass, stiffness = (turn @ found[matrix] @ turn.T for matrix in ("MXX", "KXX"))
    return mass, stiffness


def printed(name: str) -> list[float]:
    """Frequencies (rad/s) of the modes that are clamped at the interface, from the printed results."""
    text = (PUBLIC / "pyyeti" / f"{name}.out").read_text(encoding="latin-1")
    table = text.split("(AFTER AUGMENTATION OF RESIDUAL VECTORS)", 1)[1]
    rows = re.findall(r"^ +\d+ +\d+ +\S+ +(\S+) +\S+ +1\.0+E\+00 ", table, re.MULTILINE)
    return [float(row) for row in rows]


@pytest.mark.parametrize(("name", "modes"), [("inboard", 8), ("outboard", 22)])
def test_external_superelements_have_the_modes_that_nastran_printed(name: str, modes: int) -> None:
    mass, stiffness = reduced(name)
    found = flexsc.appendage_from_craig_bampton(
        mass,
        stiffness,
        range(24),
        positions=INTERFACE,
        root=(600.0, 150.0, 150.0),
        damping=0.005,
        length_unit=INCH,
        mass_unit=SLINCH,
    )
    assert len(frequencies(found)) == modes
    np.testing.assert_allclose(frequencies(found), printed(name)[:modes], rtol=1e-6)


def test_a_superelement_has_the_mass_that_nastran_printed() -> None:
    """GRID POINT WEIGHT of the inboard structure, with its mode shapes between interface and tip."""
    mass, stiffness = reduced("inboard")
    found = flexsc.appendage_from_craig_bampton(
        mass, stiffness, range(24), positions=INTERFACE, damping=0.005, length_unit=INCH, mass_unit=SLINCH
    )
    assert found["mass"] == pytest.approx(1.755052 * SLINCH, rel=1e-6)
    np.testing.assert_allclose(np.array(found["centre"]) / INCH, [1039.998, 150.0, 150.0], rtol=1e-5)
    about = np.array(found["inertia"]) / (SLINCH * INCH**2)
    np.testing.assert_allclose(np.diag(about), [3.590520e4, 3.682012e5, 3.682012e5], rtol=1e-5)


def test_axes_of_the_interface_matter() -> None:
    found = flexsc.read_matrices(PUBLIC / "pyyeti" / "inboard.op4")
    with pytest.raises(ValueError, match="rigid motion of the interface"):
        flexsc.appendage_from_craig_bampton(
            found["MXX"], found["KXX"], range(24), positions=INTERFACE, damping=0.005
        )
