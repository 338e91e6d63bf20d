//! Analyses of a scenario's linear body and loop: margins, tuning, noise, budgets and bounds.

use flexsc_core::analysis::bound::{OutputBound, RangeRow};
use flexsc_core::analysis::linear_loop::LinearLoop;
use flexsc_core::analysis::margins::SingularValues;
use flexsc_core::analysis::noise::{NoiseError, NoiseReport, NoiseRequest, Window};
use flexsc_core::analysis::scenario_margins::{MarginsFault, ScenarioMargins};
use flexsc_core::analysis::structured_tuning::{ScenarioTuning, TuningFault};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde_json::json;

use super::{Analysis, Answer, Scenario, Subject, loop_break};
use crate::aside::aside;

/// Stability margins of the loop, cut open at a point.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Margins {
    opened: String,
}

impl Analysis for Margins {
    fn run(self, on: &Subject<'_, '_>) -> PyResult<Answer> {
        let scenario = on.scenario()?;
        let (inner, opened) = (scenario.inner.clone(), loop_break(&self.opened)?);
        let margins = aside(on.py, move |_| ScenarioMargins::from_scenario(&inner, opened))?;
        let margins = margins.map_err(|fault| match fault {
            MarginsFault::Key(fault) => scenario.key_error(fault),
            MarginsFault::Unstable(unstable) => scenario.error(&unstable),
        })?;
        let mut object = json!(margins);
        let column = |of: fn(&SingularValues) -> f64| {
            margins.stability.singular_values.iter().map(of).collect::<Vec<f64>>()
        };
        object["singular_values"] = json!({
            "frequency": column(|at| at.frequency_rad_s),
            "sensitivity": column(|at| at.sensitivity),
            "complementary": column(|at| at.complementary),
        });
        Ok(object.into())
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

impl Analysis for Tune {
    fn run(self, on: &Subject<'_, '_>) -> PyResult<Answer> {
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
            Ok((tuned.to_json(), tuned.scenario()))
        })?;
        let (result, found) = tuned.map_err(|fault: TuningFault| match fault {
            TuningFault::Key(fault) => scenario.key_error(fault),
            fault => scenario.error(&fault),
        })?;
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
    speeds: Option<Vec<f64>>,
}

impl Analysis for Spectrum {
    fn run(self, on: &Subject<'_, '_>) -> PyResult<Answer> {
        let scenario = on.scenario()?;
        let Self { signals, window, separation, speeds } = self;
        let window = window.map(|length| Window { length, separation });
        let request = NoiseRequest { signals, window, speeds };
        let inner = scenario.inner.clone();
        let report = aside(on.py, move |_| NoiseReport::from_scenario(&inner, &request))?;
        let report = report.map_err(|fault| match fault {
            NoiseError::Key(fault) => scenario.key_error(fault),
            NoiseError::Request(why) => PyValueError::new_err(why),
            fault => scenario.error(&fault),
        })?;
        Ok(json!(report).into())
    }
}

/// Pointing budget of the requirements over some runs, on some threads (0: one per core).
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Budget {
    runs: u64,
    jobs: u16,
}

impl Analysis for Budget {
    fn run(self, on: &Subject<'_, '_>) -> PyResult<Answer> {
        let inner = on.scenario()?.inner.clone();
        let budget = aside(on.py, move |_| flexsc_cli::pointing_budget(inner, self.runs, self.jobs))?;
        Ok(budget.map_err(PyValueError::new_err)?.into())
    }
}

/// Guaranteed ranges of the outputs that the scenario claims, with their rows as columns and their witnesses as scenario
/// files.
pub fn bounds(on: &Subject<'_, '_>) -> PyResult<Answer> {
    let scenario = on.scenario()?;
    let own = scenario.inner.clone();
    let bounds = aside(on.py, move |_| OutputBound::from_scenario(&own))?;
    let bounds = bounds.map_err(|fault| scenario.key_error(fault))?;
    let object = |bound: &OutputBound| {
        let column = |of: fn(&RangeRow) -> f64| bound.rows.iter().map(of).collect::<Vec<f64>>();
        let mut object = json!(bound);
        object["rows"] = json!({
            "time": column(|row| row.time_s),
            "low": column(|row| row.low),
            "high": column(|row| row.high),
        });
        object["witness_scenario"] = json!(bound.witness_text(&scenario.inner));
        object
    };
    Ok(json!(bounds.iter().map(object).collect::<Vec<_>>()).into())
}
