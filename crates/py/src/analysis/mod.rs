//! Analyses by name: each takes options from a dictionary, and returns its result as JSON.

mod damping;
mod loops;
mod plan;
mod sampled;
mod tables;
mod worst_case;

use flexsc_core::analysis::open_loop::LoopBreak;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::Value as Json;

pub use damping::persistence;
pub use plan::plan_torque;

use super::Scenario;

/// Question about a scenario, or about numbers alone. Its fields are the options.
trait Analysis {
    fn run(self, on: &Subject<'_, '_>) -> PyResult<Answer>;
}

/// Scenario that a question is about, if it is about one.
struct Subject<'py, 'a> {
    py: Python<'py>,
    scenario: Option<&'a Scenario>,
}

impl<'a> Subject<'_, 'a> {
    fn scenario(&self) -> PyResult<&'a Scenario> {
        self.scenario.ok_or_else(|| PyValueError::new_err("the analysis is of a scenario"))
    }
}

/// Result of an analysis, with the scenario that it found.
struct Answer {
    result: Json,
    scenario: Option<Scenario>,
}

impl From<Json> for Answer {
    fn from(result: Json) -> Self {
        Self { result, scenario: None }
    }
}

/// Declares the analyses by name: those with options by the type of them, and those without as functions.
macro_rules! analyses {
    ($($name:literal => $options:ty,)* ; $($plain:literal => $function:path,)*) => {
        fn answer(name: &str, options: &Bound<'_, PyDict>, on: &Subject<'_, '_>) -> PyResult<Answer> {
            match name {
                $($name => options.extract::<$options>()?.run(on),)*
                $($plain => $function(on),)*
                _ => Err(PyValueError::new_err(format!("there is no analysis `{name}`"))),
            }
        }
    };
}

analyses! {
    "budget" => loops::Budget,
    "estimate" => tables::Estimate,
    "gain_region" => sampled::GainRegion,
    "identify" => damping::Identify,
    "margins" => loops::Margins,
    "observer_margin" => damping::ObserverMargin,
    "observer_region" => damping::ObserverRegion,
    "plan" => plan::Planned,
    "relay_damping" => damping::RelayDamping,
    "rivals" => plan::Rivals,
    "robust_gains" => sampled::RobustGains,
    "spectrum" => loops::Spectrum,
    "stability_map" => sampled::StabilityMap,
    "tune" => loops::Tune,
    "worst" => worst_case::Worst,
    ;
    "bounds" => loops::bounds,
    "loop_parts" => loops::loop_parts,
    "metrics" => tables::metric_descriptions,
    "rigid_cycles" => tables::rigid_cycles,
    "schema" => tables::schema,
    "topics" => tables::topics,
}

/// Runs the analysis of this name, and returns its result as JSON, with the scenario that it found.
#[pyfunction]
pub fn analysis(
    py: Python<'_>,
    name: &str,
    scenario: Option<&Scenario>,
    options: &Bound<'_, PyDict>,
) -> PyResult<(String, Option<Scenario>)> {
    let Answer { result, scenario } = answer(name, options, &Subject { py, scenario })?;
    Ok((result.to_string(), scenario))
}

/// The point of this name at which a loop is cut open.
pub fn loop_break(name: &str) -> PyResult<LoopBreak> {
    LoopBreak::from_name(name).ok_or_else(|| {
        let accepted = LoopBreak::ALL.map(|point| format!("'{}'", point.name())).join(", ");
        PyValueError::new_err(format!("loop must be one of {accepted}, got '{name}'"))
    })
}
