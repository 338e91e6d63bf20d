//! The engine's errors as Python exceptions, in the words of the command.

use std::io;
use std::path::Path;

use flexsc_core::record::RecordError;
use pyo3::exceptions::{PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

pyo3::create_exception!(
    flexsc,
    ScenarioError,
    PyValueError,
    "A scenario, or a key of it, that is not accepted. `mistakes` has a dictionary for each: `line` and `column` in the text \
     and the path of the `key`, each None where there is none, the `message`, and as `suggestion` the key or the word that was \
     probably meant, or None.\n\n\
     >>> import flexsc\n\
     >>> try:\n\
     ...     flexsc.Scenario({\"durations\": 3.0})\n\
     ... except flexsc.ScenarioError as error:\n\
     ...     print(error.mistakes[0][\"suggestion\"])\n\
     duration\n"
);
pyo3::create_exception!(
    flexsc,
    SimulationError,
    PyRuntimeError,
    "A simulation that cannot go on: its state is no longer finite, or its law switches without end.\n\n\
     >>> import flexsc\n\
     >>> far = flexsc.Scenario.example(\"relay-fixed\").with_(\"body.planar.angle\", 1e308)\n\
     >>> try:\n\
     ...     far.with_(\"body.planar.rate\", 1e308).simulate()\n\
     ... except flexsc.SimulationError as error:\n\
     ...     print(str(error)[:42])\n\
     relay-fixed: the state is no longer finite\n"
);
pyo3::create_exception!(
    flexsc,
    LogError,
    PyOSError,
    "A log that cannot be read or written.\n\n\
     >>> import flexsc\n\
     >>> try:\n\
     ...     flexsc.read_log(\"nowhere.mcap\")\n\
     ... except flexsc.LogError as error:\n\
     ...     print(\"nowhere.mcap\" in str(error))\n\
     True\n"
);

/// The exception of a scenario that is not accepted; its `mistakes` are a dictionary each.
pub fn scenario_error(error: flexsc_core::ScenarioError) -> PyErr {
    let raised = ScenarioError::new_err(error.to_string());
    let mistakes = error.mistakes();
    Python::attach(|py| {
        let each = mistakes.iter().map(|mistake| {
            let reported = PyDict::new(py);
            reported.set_item("line", mistake.place.as_ref().map(|place| place.line))?;
            reported.set_item("column", mistake.place.as_ref().map(|place| place.column))?;
            reported.set_item("key", mistake.key.as_ref())?;
            reported.set_item("message", &mistake.message)?;
            reported.set_item("suggestion", mistake.suggestion)?;
            Ok(reported)
        });
        let set =
            each.collect::<PyResult<Vec<_>>>().and_then(|all| raised.value(py).setattr("mistakes", all));
        // An error while these are written is raised instead.
        set.map_or_else(|error| error, |()| raised)
    })
}

/// Refuses work that costs too much, unless it is wanted.
pub fn allowed(cost: &flexsc_core::scenario::Cost, yes: bool) -> PyResult<()> {
    match cost.limit_exceeded() {
        Some(why) if !yes => Err(PyValueError::new_err(format!("{why}\n\nhint: `yes=True` runs it anyway"))),
        _ => Ok(()),
    }
}

/// The exception of a run that ended; that of a part written in Python is its own.
pub fn simulation_error(name: &str, error: flexsc_core::SimulationError) -> PyErr {
    if let flexsc_core::SimulationError::Own { source, .. } = &error
        && let Some(raised) = source.downcast::<PyErr>()
    {
        return Python::attach(|py| raised.clone_ref(py));
    }
    SimulationError::new_err(format!("{name}: {error}"))
}

pub fn log_error(error: flexsc_core::record::LogError) -> PyErr {
    LogError::new_err(error.to_string())
}

/// Returns a conversion of the error for the file at a path into the `OSError` that Python itself would raise.
pub fn no_file(path: &Path) -> impl FnOnce(io::Error) -> PyErr + '_ {
    move |error| match error.raw_os_error() {
        Some(code) => PyOSError::new_err((code, error.to_string(), path.display().to_string())),
        None => PyOSError::new_err(format!("cannot write {}: {error}", path.display())),
    }
}

/// Why there is no log at a path.
pub fn unwritten(path: &Path, name: &str, error: flexsc_core::SimulationError) -> PyErr {
    match error {
        flexsc_core::SimulationError::Record(RecordError::Io(source)) => {
            LogError::new_err(format!("cannot write {}: {source}", path.display()))
        }
        error => simulation_error(name, error),
    }
}
