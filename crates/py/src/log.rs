//! Logs for Python: a file in memory, its metadata, its topics as columns, and its run.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use flexsc_core::frames::{FrameFault, FrameRequest, Frames};
use flexsc_core::record;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use serde_json::json;

use super::Scenario;
use super::aside::aside;
use super::columns;
use super::commands::Commands;
use super::error::{log_error, scenario_error};

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

    /// Frames of a camera, and where lines land, as JSON.
    fn frames<'py>(
        &self,
        py: Python<'py>,
        rate: f64,
        exposure: Option<f64>,
    ) -> PyResult<(Bound<'py, PyDict>, String)> {
        let (log, request) = (self.0.clone(), FrameRequest { rate, exposure });
        let found = aside(py, move |_| Frames::from_log(&log, request))?.map_err(|fault| match fault {
            FrameFault::Log(error) => log_error(error),
            FrameFault::Scenario(error) => scenario_error(error),
            FrameFault::Request(why) => PyValueError::new_err(why),
        })?;
        Ok((columns::rows_to_dict(py, found.columns)?, json!(found.lines).to_string()))
    }
}

/// Scenario, number, commands, end (s) and metrics of the run of a log.
type LoggedRun<'py> = (Scenario, u64, Commands, f64, Bound<'py, PyDict>);

/// The run of a log, which is repeated once.
#[pyfunction]
pub fn log_run<'py>(py: Python<'py>, log: &Log) -> PyResult<LoggedRun<'py>> {
    let log = log.0.clone();
    let found = aside(py, move |_| flexsc_cli::run_of_log(&log, log.path()))?;
    let flexsc_cli::LoggedRun { scenario: inner, run, commands, until, metrics } =
        found.map_err(|error| PyValueError::new_err(error.to_string()))?;
    let scenario = Scenario { origin: inner.name.clone(), inner };
    let end = until.seconds();
    Ok((scenario, run, Commands { commands, until }, end, columns::metrics_to_dict(py, &metrics)?))
}
