//! Analyses of a scenario's linear body and loop: margins, tuning, noise, budgets and bounds.

use flexsc_core::analysis::bound::{OutputBound, RangeRow};
use flexsc_core::analysis::budget::PointingBudget;
use flexsc_core::analysis::linear_loop::LinearLoop;
use flexsc_core::analysis::margins::SingularValues;
use flexsc_core::analysis::noise::{NoiseError, NoiseReport, NoiseRequest, Window};
use flexsc_core::analysis::scenario_margins::{MarginsFault, ScenarioMargins};
use flexsc_core::analysis::structured_tuning::{ScenarioTuning, TuningFault, TuningReport};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::json;

use super::{Answer, FoundScenario, Scenario, Subject, loop_break};
use crate::aside::aside;

/// Stability margins of the loop, cut open at a point.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Margins {
    opened: String,
}

/// Margins of a stable loop: of each signal at the break, and of all together.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "StabilityMargins")]
pub struct MarginsOverFrequency {
    #[serde(flatten)]
    margins: ScenarioMargins,
    /// Largest singular values over frequency.
    #[schemars(extend("x-flat" = "{}"))]
    singular_values: Vec<SingularValues>,
}

impl Margins {
    pub fn run(self, on: &Subject<'_, '_>) -> PyResult<Answer<MarginsOverFrequency>> {
        let scenario = on.scenario()?;
        let (inner, opened) = (scenario.inner.clone(), loop_break(&self.opened)?);
        let margins = aside(on.py, move |_| ScenarioMargins::from_scenario(&inner, opened))?;
        let margins = margins.map_err(|fault| match fault {
            MarginsFault::Key(fault) => scenario.key_error(fault),
            MarginsFault::Unstable(unstable) => scenario.error(&unstable),
        })?;
        let singular_values = margins.stability.singular_values.clone();
        Ok(MarginsOverFrequency { margins, singular_values }.into())
    }
}

/// Parts of the loop that the keys do not hold as numbers.
pub fn loop_parts(on: &Subject<'_, '_>) -> PyResult<Answer> {
    let scenario = on.scenario()?;
    let parts = LinearLoop::from_scenario(&scenario.inner).map_err(|fault| scenario.key_error(fault))?;
    Ok(json!(parts).into())
}

/// Keys tuned for an objective within limits.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Tune {
    keys: Vec<(String, [f64; 2])>,
    opened: String,
    objective: String,
    keep: Vec<String>,
    bandwidth: Option<f64>,
    is_nominal: bool,
}

/// Tuned scenario, with the margins of its plants before and after.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "TunedScenario")]
pub struct Tuned {
    /// Scenario with the tuned keys.
    scenario: FoundScenario,
    #[serde(flatten)]
    report: TuningReport,
}

impl Tune {
    pub fn run(self, on: &Subject<'_, '_>) -> PyResult<Answer<Tuned>> {
        let scenario = on.scenario()?;
        let Self { keys, opened, objective, keep, bandwidth, is_nominal } = self;
        let objective =
            objective.parse().map_err(|why: String| PyValueError::new_err(format!("objective: {why}")))?;
        let limits = keep.iter().map(|limit| limit.parse()).collect::<Result<_, String>>();
        let limits = limits.map_err(|why| PyValueError::new_err(format!("keep: {why}")))?;
        let tuning =
            ScenarioTuning { keys, opened: loop_break(&opened)?, objective, limits, bandwidth, is_nominal };
        let inner = scenario.inner.clone();
        let tuned = aside(on.py, move |_| {
            let tuned = tuning.run(&inner)?;
            Ok((tuned.report(), tuned.scenario()))
        })?;
        let (report, found) = tuned.map_err(|fault: TuningFault| match fault {
            TuningFault::Key(fault) => scenario.key_error(fault),
            fault => scenario.error(&fault),
        })?;
        let result = Tuned { scenario: FoundScenario, report };
        Ok(Answer { result, scenario: Some(Scenario::new(&scenario.inner.name, found)?) })
    }
}

/// Noise of some outputs of the loop, over windows, and at speeds of the wheels.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Spectrum {
    signals: Vec<String>,
    window: Option<f64>,
    separation: Option<f64>,
    pixel: Option<f64>,
    smear: Option<f64>,
    diffraction: Option<f64>,
    speeds: Option<Vec<f64>>,
}

impl Spectrum {
    pub fn run(self, on: &Subject<'_, '_>) -> PyResult<Answer<NoiseReport>> {
        let scenario = on.scenario()?;
        let Self { signals, window, separation, pixel, smear, diffraction, speeds } = self;
        let window = window.map(|length| Window { length, separation });
        let request = NoiseRequest { signals, window, pixel, smear, diffraction, speeds };
        let inner = scenario.inner.clone();
        let report = aside(on.py, move |_| NoiseReport::from_scenario(&inner, &request))?;
        let report = report.map_err(|fault| match fault {
            NoiseError::Key(fault) => scenario.key_error(fault),
            NoiseError::Request(why) => PyValueError::new_err(why),
            fault => scenario.error(&fault),
        })?;
        Ok(report.into())
    }
}

/// Pointing budget of the requirements over some runs, on some threads (0: one per core).
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Budget {
    runs: u64,
    jobs: u16,
}

impl Budget {
    pub fn run(self, on: &Subject<'_, '_>) -> PyResult<Answer<PointingBudget>> {
        let inner = on.scenario()?.inner.clone();
        let budget = aside(on.py, move |_| flexsc_cli::pointing_budget(inner, self.runs, self.jobs))?;
        Ok(budget.map_err(PyValueError::new_err)?.into())
    }
}

/// Guaranteed range of an output over sets of states, inputs and parameters, and the verdict.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "OutputBound")]
pub struct BoundOverTime {
    #[serde(flatten)]
    bound: OutputBound,
    /// Range at instants. The output may leave it between two instants, but not `range`.
    rows: Vec<RangeRow>,
}

/// Guaranteed ranges of the outputs that the scenario claims, with their witnesses as scenario files.
pub fn bounds(on: &Subject<'_, '_>) -> PyResult<Answer<Vec<BoundOverTime>>> {
    let scenario = on.scenario()?;
    let own = scenario.inner.clone();
    let bounds = aside(on.py, move |_| OutputBound::from_scenario(&own))?;
    let bounds = bounds.map_err(|fault| scenario.key_error(fault))?;
    let over_time = |mut bound: OutputBound| {
        let text = bound.witness_text(&scenario.inner);
        if let Some(witness) = &mut bound.witness {
            witness.scenario = text;
        }
        BoundOverTime { rows: bound.rows.clone(), bound }
    };
    Ok(bounds.into_iter().map(over_time).collect::<Vec<_>>().into())
}
