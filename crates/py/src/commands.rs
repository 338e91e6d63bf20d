//! Commands of a stepped run and the instant that it reached: enough to repeat it.

use flexsc_core::campaign::CommandLog;
use flexsc_core::numerics::time::Instant;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// The commands of a run, and until when it has run.
#[pyclass(frozen, module = "flexsc._native")]
#[derive(Clone)]
pub struct Commands {
    pub commands: CommandLog,
    pub until: Instant,
}

impl Commands {
    /// Of a run as it is in its scenario, unless it was stepped.
    pub fn from_stepped(stepped: Option<&Self>) -> Self {
        stepped.cloned().unwrap_or_else(|| Self { commands: CommandLog::default(), until: Instant::END })
    }
}

#[pymethods]
impl Commands {
    /// From whole seconds and femtoseconds past them, and the commands as text.
    #[new]
    fn new(until: (u64, u64), text: &str) -> PyResult<Self> {
        let commands =
            CommandLog::parse(text).ok_or_else(|| PyValueError::new_err("not the text of commands"))?;
        Ok(Self { commands, until: Instant::from_parts(until.0, until.1) })
    }

    fn __getnewargs__(&self) -> ((u64, u64), String) {
        (self.until.parts(), self.commands.to_csv())
    }

    /// Whether none was given.
    #[getter]
    fn none(&self) -> bool {
        self.commands.is_empty()
    }
}
