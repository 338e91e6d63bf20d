//! Plans of manoeuvres.

use flexsc_core::dynamics::axis_model::AxisModel;
use flexsc_core::numerics::quantity::{Fraction, Positive};
use flexsc_core::spacecraft::manoeuvre::{
    CommandCost, ComparisonBasis, Manoeuvre, Plan, PlanReport, compare,
};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde_json::Value as Json;

use super::{Answer, Scenario, Subject};
use crate::aside::aside;
use crate::error::scenario_error;

/// The manoeuvre of a scenario, its plan and its body.
fn planned(scenario: &Scenario) -> PyResult<(&Manoeuvre, &Plan, &AxisModel)> {
    let body = scenario.inner.one_angle().map_err(scenario_error)?;
    match (&scenario.inner.manoeuvre, &scenario.inner.plan) {
        (Some(manoeuvre), Some(plan)) => Ok((manoeuvre, plan, body)),
        _ => Err(scenario.error(&"there is no manoeuvre to plan")),
    }
}

fn checked_band(band: f64) -> PyResult<f64> {
    let none = || PyValueError::new_err(format!("band must be between 0 and 1, got {band}"));
    Fraction::new(band).map(Fraction::get).ok_or_else(none)
}

/// Plan of the manoeuvre, with residuals for a relative frequency error.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Planned {
    band: f64,
}

impl Planned {
    pub fn run(self, on: &Subject<'_, '_>) -> PyResult<Answer> {
        let (_, plan, body) = planned(on.scenario()?)?;
        Ok(PlanReport::new(plan, body, checked_band(self.band)?).to_json(plan, body).into())
    }
}

/// Plans with every command for the same body.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Rivals {
    band: f64,
    peak_torque: Option<f64>,
}

impl Rivals {
    pub fn run(self, on: &Subject<'_, '_>) -> PyResult<Answer> {
        let (manoeuvre, plan, body) = planned(on.scenario()?)?;
        let band = checked_band(self.band)?;
        let none = |peak| PyValueError::new_err(format!("peak_torque must be a positive number, got {peak}"));
        let limit = self.peak_torque.map(|peak| Positive::new(peak).ok_or_else(|| none(peak))).transpose()?;
        let common = ComparisonBasis::from_manoeuvre(manoeuvre, limit, plan);
        let (manoeuvre, body) = (manoeuvre.clone(), manoeuvre.planned_for(body).into_owned());
        let rows = aside(on.py, move |_| compare(&manoeuvre, common, &body, band))?;
        Ok(Json::from(rows.iter().map(CommandCost::to_json).collect::<Vec<_>>()).into())
    }
}

/// The torque of the plan at some times (s).
#[pyfunction]
pub fn plan_torque<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    times: PyReadonlyArray1<'py, f64>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let (_, plan, _) = planned(scenario)?;
    let values: Vec<f64> = times.as_array().iter().map(|t| plan.waveform.at(*t)).collect();
    Ok(values.into_pyarray(py))
}
