//! Logs for Python: a file in memory, its metadata, and its topics as columns.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use flexsc_core::record;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use super::aside::aside;
use super::columns;
use super::error::log_error;

/// A log in memory.
#[pyclass(frozen, module = "flexsc._native")]
pub struct Log(pub Arc<record::Log>);

#[pymethods]
impl Log {
    #[staticmethod]
    fn open(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let log = aside(py, move |_| record::Log::open(&path))?.map_err(log_error)?;
        Ok(Self(Arc::new(log)))
    }

    /// A log from the bytes of its file; errors call it `path`.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf, contents: &[u8]) -> PyResult<Self> {
        let contents = contents.to_vec();
        let log = aside(py, move |_| record::Log::read(&path, contents))?.map_err(log_error)?;
        Ok(Self(Arc::new(log)))
    }

    #[getter]
    fn path(&self) -> &Path {
        self.0.path()
    }

    #[getter]
    fn contents<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, self.0.bytes())
    }

    #[getter]
    fn topics(&self) -> &[String] {
        self.0.topics()
    }

    #[getter]
    fn metadata(&self) -> &BTreeMap<String, String> {
        self.0.metadata()
    }

    #[getter]
    fn scenario(&self) -> Option<&str> {
        self.0.scenario()
    }

    fn columns<'py>(&self, py: Python<'py>, topic: &str) -> PyResult<Bound<'py, PyDict>> {
        let (log, topic) = (self.0.clone(), topic.to_owned());
        columns::rows_to_dict(py, aside(py, move |_| log.columns(&topic))?.map_err(log_error)?)
    }
}
