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
use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Serialize;
use serde_json::{Value as Json, json};

pub use damping::persistence;
pub use plan::plan_torque;

use super::Scenario;

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
struct Answer<R = Json> {
    result: R,
    scenario: Option<Scenario>,
}

impl<R> From<R> for Answer<R> {
    fn from(result: R) -> Self {
        Self { result, scenario: None }
    }
}

/// Field of a result for the scenario of the [`Answer`].
#[derive(Serialize, JsonSchema)]
#[schemars(extend("x-type" = "Scenario"))]
struct FoundScenario;

/// Function of options and of what a question is about.
type Run<R> = fn(&Bound<'_, PyDict>, &Subject<'_, '_>) -> PyResult<Answer<R>>;

/// Returns the result of a function as JSON, with the scenario that it found.
fn called<R: Serialize>(
    run: Run<R>,
    options: &Bound<'_, PyDict>,
    on: &Subject<'_, '_>,
) -> PyResult<(String, Option<Scenario>)> {
    let Answer { result, scenario } = run(options, on)?;
    Ok((json!(result).to_string(), scenario))
}

/// Returns the schema of the results of a function, which is not called.
fn schema_of<R: JsonSchema>(_: Run<R>, generator: &mut SchemaGenerator) -> Schema {
    generator.subschema_for::<R>()
}

/// Declares the analyses by name: those with options by the type of them, and those without as functions.
/// `crates/py/result_classes.py` makes classes of their results.
macro_rules! analyses {
    ($($name:literal => $options:ty,)* ; $($plain:literal => $function:path,)*) => {
        analyses! { @
            $($name => |options, on| options.extract::<$options>()?.run(on),)*
            $($plain => |_, on| $function(on),)*
        }
    };
    (@ $($name:literal => $run:expr,)*) => {
        fn answer(
            name: &str,
            options: &Bound<'_, PyDict>,
            on: &Subject<'_, '_>,
        ) -> PyResult<(String, Option<Scenario>)> {
            match name {
                $($name => called($run, options, on),)*
                _ => Err(PyValueError::new_err(format!("there is no analysis `{name}`"))),
            }
        }

        /// JSON Schema of the results of all analyses, by their names.
        fn results(_: &Subject<'_, '_>) -> PyResult<Answer> {
            let mut generator = SchemaSettings::draft2020_12().for_serialize().into_generator();
            let properties = json!({$($name: schema_of($run, &mut generator),)*});
            Ok(json!({"properties": properties, "$defs": generator.take_definitions(true)}).into())
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
    "results" => results,
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
    answer(name, options, &Subject { py, scenario })
}

/// The point of this name at which a loop is cut open.
pub fn loop_break(name: &str) -> PyResult<LoopBreak> {
    LoopBreak::from_name(name).ok_or_else(|| {
        let accepted = LoopBreak::ALL.map(|point| format!("'{}'", point.name())).join(", ");
        PyValueError::new_err(format!("loop must be one of {accepted}, got '{name}'"))
    })
}
