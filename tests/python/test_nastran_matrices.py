"""Matrices of Nastran's OUTPUT4, by pyNastran."""

import struct
from pathlib import Path

import flexsc
import numpy as np
import pytest

pytest.importorskip("pyNastran.op4.op4")

# As Nastran writes it: a column, the first row in it, words; numbers; and a column too many at the end.
TEXT = """       2       2       6       2KGG     1P,3E24.16
       1       1       4
  5.0000000000000000E+00 -2.5000000000000000E-01
       2       1       4
 -2.5000000000000000E-01  7.0000000000000000E+00
       3       1       1
  1.0000000000000000E+00
"""


def test_a_text_as_nastran_writes_it(tmp_path: Path) -> None:
    path = tmp_path / "panel.op4"
    path.write_text(TEXT)
    assert flexsc.read_matrices(path)["KGG"].tolist() == [[5.0, -0.25], [-0.25, 7.0]]


def test_a_binary_as_nastran_writes_it(tmp_path: Path) -> None:
    mass = np.array([[3.0, 0.5, 0.0], [0.5, 2.0, 0.25], [0.0, 0.25, 1.0]])

    def record(data: bytes) -> bytes:
        length = struct.pack("<i", len(data))
        return length + data + length

    columns = [struct.pack("<3i3d", at + 1, 1, 6, *mass[:, at]) for at in range(3)]
    end = struct.pack("<3id", 4, 1, 2, 1.0)
    path = tmp_path / "panel.op4"
    path.write_bytes(b"".join(map(record, [struct.pack("<4i8s", 3, 3, 6, 2, b"MGG     "), *columns, end])))
    assert np.array_equal(flexsc.read_matrices(path)["MGG"], mass)


def test_another_file_is_told(tmp_path: Path) -> None:
    path = tmp_path / "panel.op4"
    path.write_text("no matrices\n")
    with pytest.raises(ValueError, match=r"panel\.op4"):
        flexsc.read_matrices(path)
