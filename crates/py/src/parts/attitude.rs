//! Estimates of an attitude filter written in Python, next to the true values, for the log.

use flexsc_core::control::estimator::attitude::AttitudeFilterState;
use flexsc_core::control::sensor::Orientation;
use flexsc_core::numerics::attitude::Vector;
use flexsc_core::record::{AttitudeEstimate, AxisEstimate};
use nalgebra::{Cholesky, DMatrix, DVector, Matrix6, Quaternion};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use super::object::{exactly, numbers};

/// Result of a part: the state of its filter, and the innovation of its last sample, if that measured the attitude.
type FilterUpdate = (AttitudeFilterState, Option<Innovation>);

/// Innovation of a sample.
#[derive(Copy, Clone, Debug, Default)]
pub struct Innovation {
    /// Measured less expected; 0 where there is no third number.
    off: [f64; 3],
    /// Normalised square of the innovation, of two numbers times 3/2.
    nis: f64,
    /// How many numbers it has.
    numbers: u64,
}

/// An innovation and its covariance: three angles, or the two numbers of a direction.
fn innovation(object: &Bound<'_, PyAny>) -> PyResult<Innovation> {
    let (values, covariance): (Bound<'_, PyAny>, Bound<'_, PyAny>) = object.extract()?;
    let values = numbers(&values)?;
    let rows = covariance.try_iter()?.map(|row| numbers(&row?)).collect::<PyResult<Vec<_>>>()?;
    let count = values.len();
    if !(2..=3).contains(&count) || rows.len() != count || rows.iter().any(|row| row.len() != count) {
        let why = "an innovation must have 2 or 3 numbers, and a covariance of as many rows and columns";
        return Err(PyValueError::new_err(why));
    }
    let off = DVector::from_column_slice(&values);
    let factor = Cholesky::new(DMatrix::from_fn(count, count, |row, column| rows[row][column]));
    let nis = factor.map_or(f64::NAN, |factor| 3.0 / count as f64 * off.dot(&factor.solve(&off)));
    let angles = [0, 1, 2].map(|axis| values.get(axis).copied().unwrap_or(0.0));
    Ok(Innovation { off: angles, nis, numbers: count as u64 })
}

/// Reads the filter state that a part returns: attitude, bias and covariance, and the innovation of a sample that
/// measured the attitude; `None` before there is one.
pub fn from_python(object: &Bound<'_, PyAny>) -> PyResult<Option<FilterUpdate>> {
    if object.is_none() {
        return Ok(None);
    }
    let items = object.try_iter()?.collect::<PyResult<Vec<_>>>()?;
    let (q, bias, covariance, learnt) = match &items[..] {
        [q, bias, covariance] => (q, bias, covariance, None),
        [q, bias, covariance, learnt] => (q, bias, covariance, Some(learnt)),
        _ => {
            let why = "attitude returns an attitude, a bias and a covariance, and an innovation with its covariance";
            return Err(PyValueError::new_err(why));
        }
    };
    let [w, x, y, z] = exactly::<4>(q, "an attitude")?;
    let q = Quaternion::new(w, x, y, z);
    let bias = Vector::from(exactly::<3>(bias, "a bias")?);
    let rows = covariance.try_iter()?.map(|row| numbers(&row?)).collect::<PyResult<Vec<_>>>()?;
    if rows.len() != 6 || rows.iter().any(|row| row.len() != 6) {
        return Err(PyValueError::new_err("the covariance of attitude and bias must be of shape (6, 6)"));
    }
    let covariance = Matrix6::from_fn(|row, column| rows[row][column]);
    let learnt = learnt.filter(|learnt| !learnt.is_none()).map(innovation).transpose()?;
    Ok(Some((AttitudeFilterState { attitude: q / q.norm(), bias, covariance }, learnt)))
}

/// Returns the filter's row of the log, for this true orientation and true bias of the gyro (rad/s).
pub fn row((filter, learnt): &FilterUpdate, truth: &Orientation, bias: [f64; 3]) -> Option<AttitudeEstimate> {
    let Orientation::Attitude(truth) = truth else { return None };
    let bias = Vector::from(bias);
    let reported = learnt.unwrap_or_default();
    let [angle_sd, bias_sd] = filter.deviations();
    let [angle_error, bias_error] = filter.error(truth, &bias);
    let axis = |axis: usize| AxisEstimate {
        angle_error_rad: -angle_error[axis],
        angle_sd_rad: angle_sd[axis],
        bias_rad_s: filter.bias[axis],
        bias_error_rad_s: -bias_error[axis],
        bias_sd_rad_s: bias_sd[axis],
        innovation_rad: reported.off[axis],
    };
    Some(AttitudeEstimate {
        q_w: filter.attitude.w,
        q_x: filter.attitude.i,
        q_y: filter.attitude.j,
        q_z: filter.attitude.k,
        axes: [0, 1, 2].map(axis).into(),
        nees: filter.nees(truth, &bias) / AttitudeEstimate::STATES,
        nis: reported.nis / AttitudeEstimate::MEASUREMENTS,
        numbers: reported.numbers,
        measured: learnt.is_some().into(),
    })
}
