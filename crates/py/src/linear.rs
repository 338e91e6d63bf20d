//! Linear models of bodies, and the exponential that samples them.

use flexsc_core::ScenarioError;
use flexsc_core::analysis::bound::{OutputBound, RangeRow};
use flexsc_core::analysis::linear_loop::LinearLoop;
use flexsc_core::analysis::linear_model::LinearModel;
use flexsc_core::analysis::margins::StabilityMargins;
use flexsc_core::analysis::open_loop::{LoopBreak, OpenLoop};
use flexsc_core::numerics::exponential::exponential as of_matrix;
use nalgebra::DMatrix;
use numpy::{PyArray2, PyArrayMethods, PyReadonlyArray2, ToPyArray};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde_json::json;

use super::Scenario;
use super::error::scenario_error;

/// The body of a scenario as a linear system, with natural frequencies as they are at a time (s).
#[pyfunction]
pub fn linear_json(scenario: &Scenario, at: f64) -> PyResult<String> {
    let model = LinearModel::from_scenario(&scenario.inner, at).map_err(|fault| {
        let origin = scenario.inner.name.clone();
        scenario_error(ScenarioError::Key { origin, key: fault.key, why: fault.why })
    })?;
    Ok(json!(model).to_string())
}

/// The parts of a scenario's loop that its keys do not hold as numbers.
#[pyfunction]
pub fn loop_json(scenario: &Scenario) -> PyResult<String> {
    let parts = LinearLoop::from_scenario(&scenario.inner).map_err(|fault| {
        let origin = scenario.inner.name.clone();
        scenario_error(ScenarioError::Key { origin, key: fault.key, why: fault.why })
    })?;
    Ok(json!(parts).to_string())
}

/// The stability margins of a scenario's loop, cut open at a point.
#[pyfunction]
pub fn margins_json(py: Python<'_>, scenario: &Scenario, opened: &str) -> PyResult<String> {
    let Some(point) = LoopBreak::from_name(opened) else {
        let accepted = LoopBreak::ALL.map(|point| format!("'{}'", point.name())).join(", ");
        return Err(PyValueError::new_err(format!("loop must be one of {accepted}, got '{opened}'")));
    };
    let opened = OpenLoop::from_scenario(&scenario.inner, point).map_err(|fault| {
        let origin = scenario.inner.name.clone();
        scenario_error(ScenarioError::Key { origin, key: fault.key, why: fault.why })
    })?;
    let margins = py.detach(|| StabilityMargins::new(&opened));
    let name = &scenario.inner.name;
    let margins = margins.map_err(|fault| PyValueError::new_err(format!("{name}: {fault}")))?;
    Ok(json!(margins).to_string())
}

/// The guaranteed ranges of the outputs that a scenario claims, with their rows as columns and their witnesses as
/// scenario files.
#[pyfunction]
pub fn bounds_json(py: Python<'_>, scenario: &Scenario) -> PyResult<String> {
    let inner = &scenario.inner;
    let bounds = py.detach(|| OutputBound::from_scenario(inner)).map_err(|fault| {
        let origin = inner.name.clone();
        scenario_error(ScenarioError::Key { origin, key: fault.key, why: fault.why })
    })?;
    let object = |bound: &OutputBound| {
        let column = |of: fn(&RangeRow) -> f64| bound.rows.iter().map(of).collect::<Vec<f64>>();
        let mut object = json!(bound);
        object["rows"] = json!({
            "time": column(|row| row.time_s),
            "low": column(|row| row.low),
            "high": column(|row| row.high),
        });
        object["witness_scenario"] = json!(bound.witness_text(inner));
        object
    };
    Ok(json!(bounds.iter().map(object).collect::<Vec<_>>()).to_string())
}

/// The exponential of a square matrix.
#[pyfunction]
pub fn exponential<'py>(
    py: Python<'py>,
    matrix: PyReadonlyArray2<'py, f64>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let matrix = matrix.as_array();
    let (order, columns) = matrix.dim();
    if order != columns || !matrix.iter().all(|entry| entry.is_finite()) {
        return Err(PyValueError::new_err("must be a square matrix of finite numbers"));
    }
    let found = of_matrix(&DMatrix::from_fn(order, order, |row, column| matrix[(row, column)]));
    let flat: Vec<f64> = (0..order * order).map(|index| found[(index / order, index % order)]).collect();
    flat.to_pyarray(py).reshape([order, order])
}
