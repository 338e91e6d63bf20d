//! What an attitude filter written in Python knows, beside the truth, for the log.

use flexsc_core::attitude::Vector;
use flexsc_core::estimator::attitude::Filter;
use flexsc_core::record::{AttitudeEstimate, AxisEstimate};
use flexsc_core::sensor::Orientation;
use nalgebra::{Matrix6, Quaternion};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use super::object::{exactly, numbers};

/// The filter that a part tells of: attitude, bias and covariance; nothing before it knows any.
pub fn told(of: &Bound<'_, PyAny>) -> PyResult<Option<Filter>> {
    if of.is_none() {
        return Ok(None);
    }
    let (q, bias, covariance): (Bound<'_, PyAny>, Bound<'_, PyAny>, Bound<'_, PyAny>) = of.extract()?;
    let [w, x, y, z] = exactly::<4>(&q, "an attitude")?;
    let q = Quaternion::new(w, x, y, z);
    let bias = Vector::from(exactly::<3>(&bias, "a bias")?);
    let rows = covariance.try_iter()?.map(|row| numbers(&row?)).collect::<PyResult<Vec<_>>>()?;
    if rows.len() != 6 || rows.iter().any(|row| row.len() != 6) {
        return Err(PyValueError::new_err("the covariance of attitude and bias must be of shape (6, 6)"));
    }
    let covariance = Matrix6::from_fn(|row, column| rows[row][column]);
    Ok(Some(Filter { attitude: q / q.norm(), bias, covariance, swinging: None }))
}

/// Its row of the log, where these are the true orientation and the true bias of the gyro (rad/s).
pub fn row(filter: &Filter, truth: &Orientation, bias: [f64; 3]) -> Option<AttitudeEstimate> {
    let Orientation::Attitude(truth) = truth else { return None };
    let bias = Vector::from(bias);
    let [angle_sd, bias_sd] = filter.deviations();
    let [angle_error, bias_error] = filter.error(truth, &bias);
    let axis = |axis: usize| AxisEstimate {
        angle_error_rad: -angle_error[axis],
        angle_sd_rad: angle_sd[axis],
        bias_rad_s: filter.bias[axis],
        bias_error_rad_s: -bias_error[axis],
        bias_sd_rad_s: bias_sd[axis],
        innovation_rad: 0.0,
    };
    Some(AttitudeEstimate {
        q_w: filter.attitude.w,
        q_x: filter.attitude.i,
        q_y: filter.attitude.j,
        q_z: filter.attitude.k,
        axes: [0, 1, 2].map(axis).into(),
        nees: filter.nees(truth, &bias),
        nis: 0.0,
        numbers: 0,
        measured: false.into(),
    })
}
