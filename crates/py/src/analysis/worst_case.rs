//! Worst case of a scenario over its uncertain keys.

use flexsc_core::analysis::noise::{WheelOutput, Window};
use flexsc_core::campaign::{Campaign, CampaignRun};
use flexsc_core::metrics::Selection;
use flexsc_core::record::StopFlag;
use flexsc_core::uncertain::UncertainKey;
use flexsc_core::worst_case::{
    ContrastSearch, LineSearch, MarginKind, MarginSearch, MetricSearch, RunQuantity, WorstCaseFault,
    WorstCaseReport,
};
use pyo3::exceptions::{PyKeyboardInterrupt, PyValueError};
use pyo3::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;

use super::{Answer, FoundScenario, Scenario, Subject, loop_break};
use crate::aside::aside;
use crate::error::scenario_error;

/// Worst case of a quantity, with its witness. `kind` is `metric`, `requirement`, `margin` or `signal`.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Worst {
    kind: String,
    name: String,
    opened: String,
    window: Option<f64>,
    is_least: bool,
    points: usize,
    jobs: usize,
}

/// Worst point of the ranges of the uncertain keys that a search found.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "WorstCase")]
pub struct WorstCaseOverPoints {
    #[serde(flatten)]
    report: WorstCaseReport,
    /// Range of each uncertain key.
    #[schemars(extend("x-names" = "keys"))]
    ranges: Vec<[f64; 2]>,
    /// Points that were assessed, one in each row, with the keys as columns.
    #[schemars(extend("x-name" = "points"))]
    rows: Vec<Vec<f64>>,
    /// Value at each point; NaN at a point without one.
    values: Vec<f64>,
    /// Scenario with the keys of the worst point, and without uncertain ones.
    scenario: FoundScenario,
}

impl Worst {
    pub fn run(self, on: &Subject<'_, '_>) -> PyResult<Answer<WorstCaseOverPoints>> {
        let scenario = on.scenario()?;
        let Self { kind, name, opened, window, is_least, points, jobs } = self;
        if points == 0 {
            return Err(PyValueError::new_err("points must be 1 or more, got 0"));
        }
        let inner = scenario.inner.clone();
        let found = if kind == "margin" {
            let Some(kind) = MarginKind::ALL.into_iter().find(|kind| kind.word() == name) else {
                let accepted = MarginKind::ALL.map(|kind| format!("'{}'", kind.word())).join(", ");
                return Err(PyValueError::new_err(format!("margin must be one of {accepted}, got '{name}'")));
            };
            let search = MarginSearch { kind, opened: loop_break(&opened)?, most_loops: points };
            aside(on.py, move |stop| search.run(&inner, || stop.is_requested()))?
        } else if kind == "signal" {
            let window = window.map(|length| Window { length, separation: None });
            let search = LineSearch { output: WheelOutput { name, window }, most_loops: points };
            aside(on.py, move |stop| search.run(&inner, || stop.is_requested()))?
        } else if let Some(own) =
            inner.study.contrasts.iter().find(|own| kind == "requirement" && own.name == name).cloned()
        {
            let search = ContrastSearch { requirement: own, most_loops: points };
            aside(on.py, move |stop| search.run(&inner, || stop.is_requested()))?
        } else {
            let quantity =
                if kind == "metric" { RunQuantity::Metric(name) } else { RunQuantity::Requirement(name) };
            let search =
                MetricSearch { quantity, is_least, most_runs: points, threads: jobs, starts: Vec::new() };
            aside(on.py, move |stop: StopFlag| {
                let record = stop.clone();
                let work = move |run: &CampaignRun, selection: &Selection| {
                    Ok(Campaign::simulate_metrics(run, selection, record.clone())?)
                };
                search.run(&inner, &inner.name, work, || stop.is_requested())
            })?
        };
        let found = found.map_err(|fault| match fault {
            WorstCaseFault::Key(fault) => scenario.key_error(fault),
            WorstCaseFault::Scenario(error) => scenario_error(error),
            WorstCaseFault::Request(why) => scenario.error(&why),
            WorstCaseFault::Interrupted => PyKeyboardInterrupt::new_err(()),
        })?;
        let result = WorstCaseOverPoints {
            report: found.report(),
            ranges: found.ranges.keys.iter().map(UncertainKey::limits).collect(),
            rows: (0..found.points.len()).map(|point| found.key_values(point)).collect(),
            values: found.points.iter().map(|point| point.assessed.value).collect(),
            scenario: FoundScenario,
        };
        let witness = Scenario { origin: scenario.inner.name.clone(), inner: found.witness };
        Ok(Answer { result, scenario: Some(witness) })
    }
}
