//! Inverses of matrices: nalgebra's, compiled here once for all crates.

use nalgebra::{DMatrix, Matrix3};

/// Returns the inverse of a matrix; `None` if there is none.
pub fn inverse(matrix: DMatrix<f64>) -> Option<DMatrix<f64>> {
    matrix.try_inverse()
}

/// Returns the inverse of a matrix of order 3; `None` if there is none.
pub fn inverse_3x3(matrix: Matrix3<f64>) -> Option<Matrix3<f64>> {
    matrix.try_inverse()
}
