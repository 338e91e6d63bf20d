//! Files that Python writes: their endings, and their bytes.

use std::path::PathBuf;

use flexsc_core::record::atomic_file;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use super::error::no_file;

/// Writes a file, which is whole or not there.
#[pyfunction]
pub fn write(path: PathBuf, data: &[u8]) -> PyResult<()> {
    atomic_file::write(&path, data).map_err(no_file(&path))
}

/// The ending of the one file in which `out` wants the rows of a campaign; `None` for a directory.
#[pyfunction]
pub fn table_ending(out: PathBuf) -> PyResult<Option<&'static str>> {
    let refused = |why| PyValueError::new_err(format!("out: {} {why}", out.display()));
    flexsc_cli::table_ending(&out).map_err(refused)
}
