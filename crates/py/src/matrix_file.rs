//! Matrices of files that the engine reads, for Python.

use std::path::PathBuf;

use flexsc_core::formats::structure::{MatrixElements, read_matrix_market};
use numpy::{IntoPyArray, PyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Largest number of rows and columns.
const MOST: usize = 10_000_000;

/// Shape of a matrix, true if its file lists single elements, and row, column and value of each element.
type Elements<'py> =
    ([usize; 2], bool, Bound<'py, PyArray1<usize>>, Bound<'py, PyArray1<usize>>, Bound<'py, PyArray1<f64>>);

/// Returns the elements of a `MatrixMarket` file.
#[pyfunction]
pub fn matrix_market(py: Python<'_>, path: PathBuf) -> PyResult<Elements<'_>> {
    let MatrixElements { shape, sparse, rows, columns, values } =
        py.detach(|| read_matrix_market(&path, MOST)).map_err(PyValueError::new_err)?;
    Ok((shape, sparse, rows.into_pyarray(py), columns.into_pyarray(py), values.into_pyarray(py)))
}
