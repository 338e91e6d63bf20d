"""Matrices in files: NumPy's archives, MATLAB's, MatrixMarket and Nastran's OP4."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from flexsc import _native as engine
from flexsc._numpy import np

# Dense matrices above this order take minutes.
DENSE = 4000


def read_matrices(path: str | os.PathLike[str]) -> dict[str, Any]:
    """The matrices of a file by their names, for `flexsc.appendage_from_matrices`.

    ========  ==================================================================================
    `.npz`    NumPy's, with arrays under their names, or one sparse matrix of SciPy as `matrix`
    `.mat`    MATLAB's up to version 7.2, by SciPy: `pip install flexsc[matlab]`
    `.mtx`    MatrixMarket's, with one matrix as `matrix`, sparse as the file is if SciPy is there
    `.op4`    Nastran's OUTPUT4, text or binary, by pyNastran: `pip install flexsc[nastran]`
    ========  ==================================================================================

    Returns:
        Names and matrices: NumPy arrays, or sparse matrices of SciPy where the file has them sparse. What is
        no matrix of numbers is left out.

    Raises:
        ImportError: The package that reads such files is not installed.
        OSError: The file cannot be read.
        ValueError: It is no such file, or has no matrix.

    >>> import flexsc, numpy as np, pathlib, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder) / "panel.npz"
    ...     np.savez(path, M=np.eye(6), K=3 * np.eye(6))
    ...     matrices = flexsc.read_matrices(path)
    >>> sorted(matrices)
    ['K', 'M']
    """
    path = Path(path)
    readers = {".npz": _npz, ".mat": _mat, ".mtx": _mtx, ".op4": _op4}
    if path.suffix.lower() not in readers:
        raise ValueError(f"{path}: must end in {', '.join(readers)}")
    path.open("rb").close()
    try:
        found = readers[path.suffix.lower()](path)
    except (ImportError, OSError):
        raise
    except Exception as error:  # each reader has its own kinds
        raise ValueError(f"{path}: cannot be read as {path.suffix}: {error}") from error
    matrices = {name: matrix for name, matrix in found.items() if _is_matrix(matrix)}
    if not matrices:
        raise ValueError(f"{path}: must have a matrix of numbers, and has {', '.join(found) or 'nothing'}")
    return matrices


def _is_matrix(value: Any) -> bool:
    return getattr(value, "ndim", 0) == 2 and value.dtype.kind in "fiu"


def _npz(path: Path) -> dict[str, Any]:
    with np.load(path, allow_pickle=False) as archive:
        if {"format", "shape", "data"} <= set(archive.files):
            from scipy.sparse import load_npz

            return {"matrix": load_npz(path)}
        return {name: archive[name] for name in archive.files}


def _mat(path: Path) -> dict[str, Any]:
    try:
        from scipy.io import loadmat
    except ImportError as error:
        raise ImportError("files of MATLAB need SciPy: pip install flexsc[matlab]") from error
    found = loadmat(path)
    return {name: value for name, value in found.items() if not name.startswith("__")}


def _mtx(path: Path) -> dict[str, Any]:
    shape, listed, rows, columns, values = engine.matrix_market(path)
    try:
        from scipy.sparse import coo_array
    except ImportError as error:
        if max(shape) > DENSE:
            raise ImportError(
                f"matrices above {DENSE} rows need SciPy: pip install flexsc[matlab]"
            ) from error
    else:
        if listed:
            return {"matrix": coo_array((values, (rows, columns)), shape=shape)}
    matrix = np.zeros(shape)
    np.add.at(matrix, (rows, columns), values)
    return {"matrix": matrix}


def _op4(path: Path) -> dict[str, Any]:
    from flexsc.structure._nastran import _pynastran

    found = _pynastran("op4.op4").read_op4(str(path))
    return {name: _plain(matrix) for name, matrix in found.items()}


def _plain(found: Any) -> Any:
    """The matrix of an entry: pyNastran keeps its form beside it."""
    matrix = found[1] if isinstance(found, tuple) else found
    return getattr(matrix, "data", matrix) if not hasattr(matrix, "ndim") else matrix
