//! What an attitude filter takes: the noise of a gyro, and what corrects an attitude.

use nalgebra::{Quaternion, SMatrix};

use crate::attitude::Vector;
use crate::sensor::VectorSight;

/// Noise of a gyro as the filter knows it, the same about each axis.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct GyroNoise {
    /// Angle random walk (rad/sqrt(s)).
    pub angle_random_walk: f64,
    /// Rate random walk (rad/s^1.5).
    pub rate_random_walk: f64,
}

/// What corrects an attitude.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum AttitudeMeasurement {
    /// An attitude.
    Attitude(Quaternion<f64>),
    /// A vector.
    Vector(VectorSight),
}

impl AttitudeMeasurement {
    /// How many numbers it has: a direction has two.
    pub fn numbers(&self) -> u64 {
        if matches!(self, Self::Vector(VectorSight { is_direction: true, .. })) { 2 } else { 3 }
    }
}

/// Two unit vectors across a vector and each other, as rows.
pub fn across(v: &Vector) -> SMatrix<f64, 2, 3> {
    let first = v.cross(&Vector::ith(v.iamin(), 1.0)).normalize();
    let second = v.cross(&first).normalize();
    SMatrix::from_rows(&[first.transpose(), second.transpose()])
}
