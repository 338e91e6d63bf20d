"""Nastran's punch files: eigenvectors, a grid point in two lines of 80 columns."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from flexsc._numpy import np, npt

if TYPE_CHECKING:
    Numbers = npt.NDArray[np.float64]

_EIGENVALUE = re.compile(r"\$EIGENVALUE\s*=\s*(\S+)\s+MODE\s*=\s*(\d+)")
_EXPONENT = re.compile(r"(\d)([+-]\d{3})$")
_SUBCASE = re.compile(r"\$SUBCASE ID\s*=\s*(\d+)")


@dataclass(frozen=True, eq=False)
class Solution:
    """A normal-modes solution in the model's units."""

    frequencies: Numbers
    """Natural frequencies (rad/s), shape (modes,)."""
    shapes: dict[int, Numbers]
    """By grid point, mass-normalised displacements and rotations in its output system, shape (modes, 6)."""


def read_punch(path: Path, subcase: int | None = None) -> Solution:
    """Read the eigenvectors of a punch file, which must be mass-normalised.

    Raises:
        OSError: The file cannot be read.
        ValueError: It has no valid eigenvectors; the text names the line.
    """
    squares: dict[int, float] = {}
    rows: dict[int, dict[int, list[float]]] = {}
    current, mode, wanted = 1, None, subcase
    vectors = False
    last: list[float] | None = None
    for number, whole in enumerate(path.read_text(encoding="latin-1").splitlines(), 1):
        line = whole[:72].rstrip()  # what follows is the line's number
        if line.startswith("$"):
            last = None
            if found := _SUBCASE.match(line):
                current = int(found[1])
            elif line.startswith(("$EIGENVECTOR", "$DISPLACEMENTS")):
                vectors, mode = True, None
            elif found := _EIGENVALUE.match(line):
                mode = int(found[2]) if vectors else None
                wanted = current if wanted is None else wanted
                if mode is not None and current == wanted:
                    squares[mode] = _number(path, number, found[1])
            elif line.startswith(("$ELEMENT", "$SPCF", "$MPCF", "$OLOADS")):
                vectors, mode = False, None
            continue
        if mode is None or current != wanted:
            continue
        fields = line.split()
        if fields and fields[0] == "-CONT-":
            if last is not None:
                last.extend(_number(path, number, field) for field in fields[1:])
        elif len(fields) >= 3 and fields[1] == "G":
            last = [_number(path, number, field) for field in fields[2:]]
            of_grid = rows.setdefault(int(fields[0]), {})
            if mode in of_grid:
                raise ValueError(
                    f"{path}: line {number}: must have each grid point once in a mode, got {fields[0]} again "
                    f"in mode {mode}"
                )
            of_grid[mode] = last
        else:
            last = None  # a scalar point
    if not squares:
        of_subcase = "" if subcase is None else f" of subcase {subcase}"
        raise ValueError(f"{path}: must have eigenvectors{of_subcase}, and has none")
    shapes = {}
    for grid, by_mode in rows.items():
        if set(by_mode) == set(squares) and all(len(row) == 6 for row in by_mode.values()):
            shapes[grid] = np.array([by_mode[mode] for mode in squares])
    # A rigid body's eigenvalue may be a little below 0.
    return Solution(np.sqrt(np.maximum(list(squares.values()), 0.0)), shapes)


def _number(path: Path, line: int, field: str) -> float:
    try:
        # Fortran leaves the E out before an exponent of three digits.
        return float(_EXPONENT.sub(r"\1E\2", field))
    except ValueError:
        raise ValueError(f"{path}: line {line}: must have numbers, got `{field}`") from None
