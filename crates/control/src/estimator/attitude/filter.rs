//! Estimates of an attitude filter with their covariance, as logs and checks read them.

use flexsc_flight::attitude_filter::AttitudeBiasFilter;
use flexsc_flight_precision::Precision;
use flexsc_numerics::attitude::{Vector, rotation_vector};
use flexsc_numerics::flight_types::{
    from_matrix6, from_quaternion, from_vector3, to_matrix6, to_quaternion, to_vector3,
};
use nalgebra::{Cholesky, Matrix6, Quaternion, SMatrix};

/// State of the attitude filter at one instant.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct AttitudeFilterState {
    /// Attitude: the rotation from body axes to inertial axes.
    pub attitude: Quaternion<f64>,
    /// Gyro bias (rad/s).
    pub bias: Vector,
    /// Covariance of the errors of attitude (rad) and bias (rad/s).
    pub covariance: Matrix6<f64>,
}

impl AttitudeFilterState {
    /// Creates a filter with this attitude, bias and standard deviations about each axis (rad, rad/s).
    pub fn new(precision: Precision, attitude: Quaternion<f64>, bias: Vector, deviations: [f64; 2]) -> Self {
        Self::from_flight(&precision.filter(to_quaternion(&attitude), to_vector3(&bias), deviations))
    }

    /// Returns the state of the filter in flight code.
    pub fn from_flight(filter: &AttitudeBiasFilter) -> Self {
        Self {
            attitude: from_quaternion(&filter.attitude),
            bias: from_vector3(&filter.bias),
            covariance: from_matrix6(&filter.covariance),
        }
    }

    /// Returns the filter in flight code.
    pub fn to_flight(&self) -> AttitudeBiasFilter {
        AttitudeBiasFilter {
            attitude: to_quaternion(&self.attitude),
            bias: to_vector3(&self.bias),
            covariance: to_matrix6(&self.covariance),
        }
    }

    /// Returns the errors against a true attitude and bias: truth relative to the estimate (rad, rad/s).
    pub fn error(&self, attitude: &Quaternion<f64>, bias: &Vector) -> [Vector; 2] {
        [rotation_vector(&self.attitude, attitude), bias - self.bias]
    }

    /// Returns the normalised squared error against a true attitude and bias; NaN if the covariance is not positive
    /// definite.
    pub fn nees(&self, attitude: &Quaternion<f64>, bias: &Vector) -> f64 {
        self.normalised(&self.error(attitude, bias))
    }

    /// Returns the normalised square of an error (rad, rad/s); NaN if the covariance is not positive definite.
    pub fn normalised(&self, [angle, rate]: &[Vector; 2]) -> f64 {
        let error = SMatrix::<f64, 6, 1>::from_fn(|row, _| if row < 3 { angle[row] } else { rate[row - 3] });
        Cholesky::new(self.covariance).map_or(f64::NAN, |factor| error.dot(&factor.solve(&error)))
    }

    /// Returns the standard deviations of attitude (rad) and bias (rad/s) about each axis.
    pub fn deviations(&self) -> [[f64; 3]; 2] {
        [0, 3].map(|from| [0, 1, 2].map(|axis| f64::sqrt(self.covariance[(from + axis, from + axis)])))
    }
}
