//! Worst case of a scenario over its uncertain keys.

use flexsc_core::ScenarioError;
use flexsc_core::campaign::{Campaign, CampaignRun};
use flexsc_core::metrics::Selection;
use flexsc_core::record::StopFlag;
use flexsc_core::uncertain::UncertainKey;
use flexsc_core::worst_case::{
    MarginKind, MarginSearch, MetricSearch, RunQuantity, WorstCase, WorstCaseFault,
};
use pyo3::exceptions::{PyKeyboardInterrupt, PyValueError};
use pyo3::prelude::*;
use serde_json::json;

use super::Scenario;
use super::aside::aside;
use super::error::scenario_error;
use super::linear::loop_break;

/// The worst case of a quantity, as JSON, with the witness as a scenario. `kind` is `metric`, `requirement` or
/// `margin`.
#[pyfunction]
pub fn worst_case_json(
    py: Python<'_>,
    scenario: &Scenario,
    quantity: (String, String),
    opened: &str,
    is_least: bool,
    points: usize,
    jobs: usize,
) -> PyResult<(String, Scenario)> {
    let (kind, name) = quantity;
    if points == 0 {
        return Err(PyValueError::new_err("points must be 1 or more, got 0"));
    }
    let inner = scenario.inner.clone();
    let origin = inner.name.clone();
    let found = if kind == "margin" {
        let Some(kind) = MarginKind::ALL.into_iter().find(|kind| kind.word() == name) else {
            let accepted = MarginKind::ALL.map(|kind| format!("'{}'", kind.word())).join(", ");
            return Err(PyValueError::new_err(format!("margin must be one of {accepted}, got '{name}'")));
        };
        let search = MarginSearch { kind, opened: loop_break(opened)?, most_loops: points };
        aside(py, move |stop| search.run(&inner, || stop.is_requested()))?
    } else {
        let quantity =
            if kind == "metric" { RunQuantity::Metric(name) } else { RunQuantity::Requirement(name) };
        let search = MetricSearch { quantity, is_least, most_runs: points, threads: jobs };
        aside(py, move |stop: StopFlag| {
            let record = stop.clone();
            let work = move |run: &CampaignRun, selection: &Selection| {
                Ok(Campaign::simulate_metrics(run, selection, record.clone())?)
            };
            search.run(&inner, &inner.name, work, || stop.is_requested())
        })?
    };
    let found = found.map_err(|fault| match fault {
        WorstCaseFault::Key(fault) => {
            scenario_error(ScenarioError::Key { origin: origin.clone(), key: fault.key, why: fault.why })
        }
        WorstCaseFault::Scenario(error) => scenario_error(error),
        WorstCaseFault::Request(why) => PyValueError::new_err(format!("{origin}: {why}")),
        WorstCaseFault::Interrupted => PyKeyboardInterrupt::new_err(()),
    })?;
    Ok((worst_json(&found), Scenario { origin, inner: found.witness }))
}

/// The JSON of a worst case, with all points.
fn worst_json(found: &WorstCase) -> String {
    let mut object = found.to_json();
    let all: Vec<_> = (0..found.points.len()).map(|point| found.key_values(point)).collect();
    let values: Vec<f64> = found.points.iter().map(|point| point.assessed.value).collect();
    object["ranges"] = json!(found.ranges.keys.iter().map(UncertainKey::limits).collect::<Vec<_>>());
    object["rows"] = json!(all);
    object["values"] = json!(values);
    object.to_string()
}
