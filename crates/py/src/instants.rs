//! The motion of a run at instants of one's own choice.

use flexsc_core::SimulationError;
use flexsc_core::record::{Detail, Trace};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::Scenario;
use super::aside::aside;
use super::columns;
use super::commands::Commands;
use super::error::simulation_error;

/// The rows of the motion at times (s) that grow, of a run that is simulated again.
#[pyfunction]
pub fn sample<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    run: u64,
    times: Vec<f64>,
    stepped: Option<&Commands>,
) -> PyResult<Bound<'py, PyDict>> {
    let (run, Commands { commands, .. }) = (scenario.run(run), Commands::from_stepped(stepped));
    let trace = aside(py, move |mut stop| -> Result<Trace, SimulationError> {
        let mut trace = Trace::new(Detail::Full);
        commands.sample_motion(&run, &times, &mut stop, &mut trace)?;
        Ok(trace)
    })?;
    let trace = trace.map_err(|error| simulation_error(&scenario.inner.name, error))?;
    let topics = PyDict::new(py);
    for (name, rows) in trace.into_columns() {
        topics.set_item(name, columns::rows_to_dict(py, rows)?)?;
    }
    Ok(topics)
}
