//! The motion of a run at instants of one's own choice.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use flexsc_core::campaign::CampaignRun;
use flexsc_core::record::{Column, Columns, Detail, StopFlag, Trace};
use flexsc_core::{Simulation, SimulationError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::Scenario;
use super::aside::aside;
use super::columns;
use super::commands::Commands;
use super::error::simulation_error;
use super::parts::known_thread;

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

/// Returns the number of values in a sample of a run's motion, by topic; empty if the run fails at its start.
#[pyfunction]
pub fn sample_sizes(py: Python<'_>, scenario: &Scenario, run: u64) -> PyResult<BTreeMap<String, usize>> {
    let run = scenario.run(run);
    aside(py, move |stop| sizes(&run, stop))
}

/// Returns the number of values in a sample of a run's motion, by topic, from the one at its start.
pub fn sizes(run: &CampaignRun, mut stop: StopFlag) -> BTreeMap<String, usize> {
    let mut sample = Trace::new(Detail::Full);
    // The error of a run that fails here is raised where it is simulated.
    let _ = known_thread(run.scenario.has_custom_parts(), || {
        let mut simulation = Simulation::new(&run.scenario, run.noise_run);
        simulation.run_to(0.0, &mut stop)?;
        simulation.record_now(&mut sample)
    });
    let each = sample.into_columns().map(|(name, columns)| (name, size(&columns)));
    let mut sizes: BTreeMap<String, usize> = each.collect();
    if !sizes.is_empty() {
        // The guidance of a mode has its rows in that mode alone.
        for topic in run.scenario.custom_topics() {
            let name = topic.name().trim_start_matches('/').to_owned();
            sizes.entry(name).or_insert(topic.fields().len() + 1);
        }
    }
    sizes
}

/// Returns the number of values in the columns of a topic.
fn size(columns: &Columns) -> usize {
    let values = |column: &Column| match column {
        Column::Rows(counts, rows) => counts.len() + size(rows),
        _ => column.len(),
    };
    columns.columns.iter().map(|(_, column)| values(column)).sum()
}
