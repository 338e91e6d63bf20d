//! The motion of a run at instants of one's own choice.

use flexsc_core::record::{Detail, Trace};
use flexsc_core::{Simulation, SimulationError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::Scenario;
use super::aside::aside;
use super::columns;
use super::error::simulation_error;

/// The rows of the motion at times (s) that grow, of a run that is simulated again.
#[pyfunction]
pub fn sample<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    run: u64,
    times: Vec<f64>,
) -> PyResult<Bound<'py, PyDict>> {
    let inner = scenario.inner.clone();
    let seen = aside(py, move |mut stop| -> Result<Trace, SimulationError> {
        let (mut simulation, mut trace) = (Simulation::new(&inner, run), Trace::new(Detail::Full));
        for time in times {
            simulation.run_to(time, &mut stop)?;
            simulation.tell_now(&mut trace)?;
        }
        Ok(trace)
    })?;
    let seen = seen.map_err(|error| simulation_error(&scenario.inner.name, error))?;
    let topics = PyDict::new(py);
    for (name, rows) in seen.into_columns() {
        topics.set_item(name, columns::of_rows(py, rows)?)?;
    }
    Ok(topics)
}
