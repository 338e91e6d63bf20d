//! The motion of a run at instants of one's own choice.

use std::sync::{Arc, Mutex, PoisonError};

use flexsc_core::SimulationError;
use flexsc_core::record::{Detail, Trace};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::Scenario;
use super::aside::aside;
use super::columns;
use super::commands::Commands;
use super::error::simulation_error;

/// The motion of a run, simulated again as far as it is asked for, with snapshots from which later calls go on.
#[pyclass(frozen, module = "flexsc._native")]
pub struct MotionSampler {
    sampler: Arc<Mutex<flexsc_core::campaign::MotionSampler>>,
    name: String,
}

#[pymethods]
impl MotionSampler {
    #[new]
    fn new(scenario: &Scenario, run: u64, stepped: Option<&Commands>) -> Self {
        let Commands { commands, .. } = Commands::from_stepped(stepped);
        let sampler = flexsc_core::campaign::MotionSampler::new(scenario.run(run), commands);
        Self { sampler: Arc::new(Mutex::new(sampler)), name: scenario.inner.name.clone() }
    }

    /// The rows of the motion at times (s) that grow.
    fn sample<'py>(&self, py: Python<'py>, times: Vec<f64>) -> PyResult<Bound<'py, PyDict>> {
        let sampler = Arc::clone(&self.sampler);
        let trace = aside(py, move |mut stop| -> Result<Trace, SimulationError> {
            let mut trace = Trace::new(Detail::Full);
            // Samples do not depend on those before: what a panic left is as good.
            let mut sampler = sampler.lock().unwrap_or_else(PoisonError::into_inner);
            sampler.sample(&times, &mut stop, &mut trace)?;
            Ok(trace)
        })?;
        let trace = trace.map_err(|error| simulation_error(&self.name, error))?;
        columns::topics_to_dict(py, trace.into_columns())
    }
}
