//! Inputs of an attitude filter: the gyro's noise, and the measurements that correct an attitude.

use flexsc_numerics::attitude::Vector;
use nalgebra::{Quaternion, SMatrix};

use crate::sensor::VectorMeasurement;

/// Gyro noise in the filter's model, the same about each axis.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct GyroNoise {
    /// Angle random walk (rad/sqrt(s)).
    pub angle_random_walk: f64,
    /// Rate random walk (rad/s^1.5).
    pub rate_random_walk: f64,
}

/// Measurement that corrects an attitude.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum AttitudeMeasurement {
    /// Measured attitude.
    Attitude(Quaternion<f64>),
    /// Measured vector.
    Vector(VectorMeasurement),
}

impl AttitudeMeasurement {
    /// Returns the number of components: 2 of a direction, else 3.
    pub fn dimension(&self) -> u64 {
        if matches!(self, Self::Vector(VectorMeasurement { is_direction: true, .. })) { 2 } else { 3 }
    }
}

/// Returns two unit vectors perpendicular to `v` and to each other, as rows.
pub fn perpendicular_pair(v: &Vector) -> SMatrix<f64, 2, 3> {
    let first = v.cross(&Vector::ith(v.iamin(), 1.0)).normalize();
    let second = v.cross(&first).normalize();
    SMatrix::from_rows(&[first.transpose(), second.transpose()])
}
