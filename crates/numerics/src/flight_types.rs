//! Vectors and matrices of linear algebra as flight code has them.

use flexsc_flight::matrix3::Matrix3 as PlainMatrix3;
use flexsc_flight::vector3::Vector3;
use nalgebra::Matrix3;

use crate::attitude::Vector;

/// Returns a vector as flight code has it.
#[inline]
pub fn flight_vector(v: &Vector) -> Vector3 {
    Vector3 { x: v.x, y: v.y, z: v.z }
}

/// Returns a matrix as flight code has it.
#[inline]
pub fn flight_matrix(m: &Matrix3<f64>) -> PlainMatrix3 {
    PlainMatrix3 { rows: [0, 1, 2].map(|row| [0, 1, 2].map(|column| m[(row, column)])) }
}
