//! Conversions between types of the matrix library and the plain types of flight code.

use flexsc_flight::matrix3::Matrix3;
use flexsc_flight::matrix6::{Matrix6, Matrix6x3};
use flexsc_flight::quaternion::Quaternion;
use flexsc_flight::vector3::Vector3;

/// Converts a vector to that of flight code.
#[inline]
pub fn to_vector3(v: &nalgebra::Vector3<f64>) -> Vector3 {
    Vector3 { x: v.x, y: v.y, z: v.z }
}

/// Converts a vector of flight code.
#[inline]
pub fn from_vector3(v: &Vector3) -> nalgebra::Vector3<f64> {
    nalgebra::Vector3::new(v.x, v.y, v.z)
}

/// Converts a quaternion to that of flight code.
#[inline]
pub fn to_quaternion(q: &nalgebra::Quaternion<f64>) -> Quaternion {
    Quaternion { w: q.w, x: q.i, y: q.j, z: q.k }
}

/// Converts a quaternion of flight code.
#[inline]
pub fn from_quaternion(q: &Quaternion) -> nalgebra::Quaternion<f64> {
    nalgebra::Quaternion::new(q.w, q.x, q.y, q.z)
}

/// Converts a matrix of three rows and columns to that of flight code.
#[inline]
pub fn to_matrix3(matrix: &nalgebra::Matrix3<f64>) -> Matrix3 {
    Matrix3 { rows: [0, 1, 2].map(|row| [0, 1, 2].map(|column| matrix[(row, column)])) }
}

/// Converts a matrix of six rows and columns to that of flight code.
pub fn to_matrix6(matrix: &nalgebra::Matrix6<f64>) -> Matrix6 {
    Matrix6 { rows: std::array::from_fn(|row| std::array::from_fn(|column| matrix[(row, column)])) }
}

/// Converts a matrix of six rows and columns of flight code.
pub fn from_matrix6(matrix: &Matrix6) -> nalgebra::Matrix6<f64> {
    nalgebra::Matrix6::from_fn(|row, column| matrix.rows[row][column])
}

/// Converts a matrix of six rows and three columns to that of flight code.
pub fn to_matrix6x3(matrix: &nalgebra::Matrix6x3<f64>) -> Matrix6x3 {
    Matrix6x3 { rows: std::array::from_fn(|row| [0, 1, 2].map(|column| matrix[(row, column)])) }
}
