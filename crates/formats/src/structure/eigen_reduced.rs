//! Result and errors of the solvers of the reduced eigenproblem.

use nalgebra::DMatrix;

/// Eigenvalues w⁻² of B B' in any order, and y' L⁻¹ c for each eigenvector and functional.
pub struct ReducedEigen {
    pub squares: Vec<f64>,
    pub values: DMatrix<f64>,
}

/// Reason why there are no modes.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum EigenError {
    /// Stiffness matrix that is not positive definite.
    Stiffness,
    /// Mass matrix that is not positive definite.
    Mass,
    /// Numbers that leave the range of double precision.
    Range,
    /// Order above 100 in a build without the feature `matrices`.
    #[cfg(not(feature = "matrices"))]
    LeftOut,
}

/// Returns true if the pivots of a Cholesky factor, each given with its diagonal element, are larger than rounding
/// errors of zero.
pub fn is_definite(pivots: impl ExactSizeIterator<Item = (f64, f64)>) -> bool {
    let rounding = pivots.len() as f64 * f64::EPSILON;
    pivots.into_iter().all(|(pivot, diagonal)| pivot * pivot > rounding * diagonal)
}
