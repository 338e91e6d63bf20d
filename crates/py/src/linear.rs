//! Linear models of bodies, and the exponential that samples them.

use flexsc_core::ScenarioError;
use flexsc_core::analysis::bound::{OutputBound, RangeRow};
use flexsc_core::analysis::linear_loop::LinearLoop;
use flexsc_core::analysis::linear_model::LinearModel;
use flexsc_core::analysis::margins::{self, SingularValues};
use flexsc_core::analysis::noise::{NoiseError, NoiseReport, NoiseRequest, Window};
use flexsc_core::analysis::open_loop::LoopBreak;
use flexsc_core::analysis::scenario_margins::{MarginsFault, ScenarioMargins};
use flexsc_core::analysis::structured_tuning::{ScenarioTuning, TuningFault};
use flexsc_core::formats::document::ConfigError;
use flexsc_core::numerics::exponential::exponential as of_matrix;
use nalgebra::DMatrix;
use numpy::{PyArray2, PyArrayMethods, PyReadonlyArray2, ToPyArray};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde_json::json;

use super::Scenario;
use super::aside::aside;
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

/// The point of this name at which a loop is cut open.
pub fn loop_break(name: &str) -> PyResult<LoopBreak> {
    LoopBreak::from_name(name).ok_or_else(|| {
        let accepted = LoopBreak::ALL.map(|point| format!("'{}'", point.name())).join(", ");
        PyValueError::new_err(format!("loop must be one of {accepted}, got '{name}'"))
    })
}

/// The stability margins of a scenario's loop, cut open at a point.
#[pyfunction]
pub fn margins_json(py: Python<'_>, scenario: &Scenario, opened: &str) -> PyResult<String> {
    let (inner, opened) = (scenario.inner.clone(), loop_break(opened)?);
    let margins = aside(py, move |_| ScenarioMargins::from_scenario(&inner, opened))?;
    let name = &scenario.inner.name;
    let margins = margins.map_err(|fault| match fault {
        MarginsFault::Key(ConfigError { key, why, .. }) => {
            scenario_error(ScenarioError::Key { origin: name.clone(), key, why })
        }
        MarginsFault::Unstable(unstable) => PyValueError::new_err(format!("{name}: {unstable}")),
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
    Ok(object.to_string())
}

/// Keys of a scenario tuned for an objective within limits, as JSON, and the text of the tuned scenario.
#[pyfunction]
pub fn tuned_json(
    py: Python<'_>,
    scenario: &Scenario,
    keys: Vec<(String, [f64; 2])>,
    opened: &str,
    goal: (String, Vec<String>),
    bandwidth: Option<f64>,
    is_nominal: bool,
) -> PyResult<(String, String)> {
    let (objective, limits) = goal;
    let objective =
        objective.parse().map_err(|why: String| PyValueError::new_err(format!("objective: {why}")))?;
    let limits = limits.iter().map(|limit| limit.parse()).collect::<Result<_, String>>();
    let limits = limits.map_err(|why| PyValueError::new_err(format!("keep: {why}")))?;
    let tuning =
        ScenarioTuning { keys, opened: loop_break(opened)?, objective, limits, bandwidth, is_nominal };
    let inner = scenario.inner.clone();
    let tuned = aside(py, move |_| {
        let tuned = tuning.run(&inner)?;
        let text = tuned.scenario().map(|scenario| scenario.to_toml());
        Ok((tuned.to_json().to_string(), text))
    })?;
    let name = &scenario.inner.name;
    let (table, text) = tuned.map_err(|fault: TuningFault| match fault {
        TuningFault::Key(fault) => {
            scenario_error(ScenarioError::Key { origin: name.clone(), key: fault.key, why: fault.why })
        }
        fault => PyValueError::new_err(format!("{name}: {fault}")),
    })?;
    Ok((table, text.map_err(scenario_error)?))
}

/// The noise of a scenario's loop: of some outputs, over windows, and at speeds of its wheels.
#[pyfunction]
pub fn spectrum_json(
    py: Python<'_>,
    scenario: &Scenario,
    signals: Vec<String>,
    window: Option<f64>,
    separation: Option<f64>,
    speeds: Option<Vec<f64>>,
) -> PyResult<String> {
    let window = window.map(|length| Window { length, separation });
    let request = NoiseRequest { signals, window, speeds };
    let name = &scenario.inner.name;
    let inner = scenario.inner.clone();
    let report = aside(py, move |_| NoiseReport::from_scenario(&inner, &request))?;
    let report = report.map_err(|fault| match fault {
        NoiseError::Key(fault) => {
            scenario_error(ScenarioError::Key { origin: name.clone(), key: fault.key, why: fault.why })
        }
        NoiseError::Request(why) => PyValueError::new_err(why),
        fault => PyValueError::new_err(format!("{name}: {fault}")),
    })?;
    Ok(json!(report).to_string())
}

/// The pointing budget of a scenario's requirements over some runs, on some threads (0: one per core).
#[pyfunction]
pub fn budget_json(py: Python<'_>, scenario: &Scenario, runs: u64, jobs: u16) -> PyResult<String> {
    let inner = scenario.inner.clone();
    aside(py, move |_| flexsc_cli::budget_json(inner, runs, jobs))?.map_err(PyValueError::new_err)
}

/// The guaranteed ranges of the outputs that a scenario claims, with their rows as columns and their witnesses as
/// scenario files.
#[pyfunction]
pub fn bounds_json(py: Python<'_>, scenario: &Scenario) -> PyResult<String> {
    let inner = &scenario.inner;
    let own = inner.clone();
    let bounds = aside(py, move |_| OutputBound::from_scenario(&own))?.map_err(|fault| {
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

/// The change of a motion, as the logarithm of its size, up to which it neither grows nor decays over a period (s).
#[pyfunction]
pub fn steady_change(period: f64) -> f64 {
    margins::steady_change(period)
}
