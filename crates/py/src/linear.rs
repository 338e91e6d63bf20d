//! Linear models of bodies and loops.

use flexsc_core::analysis::linear_model::Signal;
use flexsc_core::analysis::margins::CommonMargins;
use flexsc_core::analysis::open_loop::TransferMatrices;
use flexsc_core::analysis::open_loop::sampling::SampledSystem;
use flexsc_core::analysis::state_space::StateSpaceModel;
use nalgebra::DMatrix;
use numpy::{PyArray2, PyArrayMethods, PyReadonlyArray2, ToPyArray};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use super::Scenario;
use super::analysis::loop_break;

/// Matrix as a NumPy array.
type Array<'py> = Bound<'py, PyArray2<f64>>;
/// Matrices a, b, c and d as NumPy arrays.
type Matrices<'py> = (Array<'py>, Array<'py>, Array<'py>, Array<'py>);
/// Names and units of signals.
type Signals = Vec<(String, String)>;
/// A model: matrices, states, inputs and outputs, and period.
type Model<'py> = (Matrices<'py>, (Signals, Signals, Signals), Option<f64>);

fn array<'py>(py: Python<'py>, matrix: &DMatrix<f64>) -> PyResult<Array<'py>> {
    let rows: Vec<f64> = matrix.transpose().iter().copied().collect();
    rows.to_pyarray(py).reshape([matrix.nrows(), matrix.ncols()])
}

fn matrix(values: &PyReadonlyArray2<'_, f64>) -> DMatrix<f64> {
    let values = values.as_array();
    DMatrix::from_fn(values.nrows(), values.ncols(), |row, column| values[(row, column)])
}

/// The body of a scenario as a linear model at a time (s), in continuous time or sampled; or its loop, cut open.
#[pyfunction]
pub fn linearise<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    at: f64,
    period: Option<f64>,
    delay: Option<f64>,
    opened: Option<&str>,
) -> PyResult<Model<'py>> {
    let inner = &scenario.inner;
    let model = match (opened.map(loop_break).transpose()?, period) {
        (Some(_), Some(_)) => {
            let why = "period must be left out where a loop is cut open: it is the law's own";
            return Err(PyValueError::new_err(why));
        }
        (Some(opened), None) => {
            checked_times(1.0, delay)?;
            StateSpaceModel::from_loop(inner, opened, delay)
        }
        (None, Some(period)) => {
            checked_times(period, delay)?;
            StateSpaceModel::from_sampled_body(inner, at, period, delay)
        }
        (None, None) if delay.is_some() => return Err(PyValueError::new_err("delay needs a period")),
        (None, None) => StateSpaceModel::from_body(inner, at),
    };
    let StateSpaceModel { matrices: TransferMatrices { a, b, c, d }, states, inputs, outputs, period } =
        model.map_err(|fault| scenario.key_error(fault))?;
    let named = |all: Vec<Signal>| all.into_iter().map(|signal| (signal.name, signal.unit)).collect();
    let matrices = (array(py, &a)?, array(py, &b)?, array(py, &c)?, array(py, &d)?);
    Ok((matrices, (named(states), named(inputs), named(outputs)), period))
}

fn checked_times(period: f64, delay: Option<f64>) -> PyResult<()> {
    let delay = delay.unwrap_or(0.0);
    if period > 0.0 && period.is_finite() && (0.0..f64::INFINITY).contains(&delay) {
        return Ok(());
    }
    let why = format!("period must be positive and delay 0 or more, got {period:?} and {delay:?}");
    Err(PyValueError::new_err(why))
}

/// The matrices a and b of x' = a x + b u at samples `period` (s) apart, whose inputs act `delay` (s) late: the last states
/// are the inputs of the returned number of earlier samples.
#[pyfunction]
pub fn sampled<'py>(
    py: Python<'py>,
    a: PyReadonlyArray2<'py, f64>,
    b: PyReadonlyArray2<'py, f64>,
    period: f64,
    delay: f64,
) -> PyResult<(Array<'py>, Array<'py>, usize)> {
    checked_times(period, Some(delay))?;
    let sampled = SampledSystem::new(&matrix(&a), &matrix(&b), period, delay);
    Ok((array(py, &sampled.a)?, array(py, &sampled.b)?, sampled.waiting))
}

/// The margins of some inputs of a loop that is cut open, which are off together: factor below 1, factor above 1, and phase
/// (rad).
#[pyfunction]
pub fn common_margins(
    matrices: [PyReadonlyArray2<'_, f64>; 4],
    period: Option<f64>,
    signals: Vec<String>,
    inputs: Vec<usize>,
) -> PyResult<(f64, f64, f64)> {
    let [a, b, c, d] = matrices.each_ref().map(matrix);
    let found = CommonMargins::from_transfer(TransferMatrices { a, b, c, d }, period, signals, &inputs);
    let found = found.map_err(|fault| PyValueError::new_err(fault.to_string()))?;
    Ok((found.gain_below, found.gain_above.unwrap_or(f64::INFINITY), found.phase_rad))
}
