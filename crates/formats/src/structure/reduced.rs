//! What the solvers of the reduced eigenproblem have in common: its result, and why there is none.

use nalgebra::DMatrix;

/// The eigenvalues w⁻² of B B' in any order, and y' L⁻¹ c for each eigenvector and functional.
pub struct Reduced {
    pub squares: Vec<f64>,
    pub values: DMatrix<f64>,
}

/// Why there are no modes.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Unsolved {
    /// The stiffness matrix is not positive definite.
    Stiffness,
    /// The mass matrix is not positive definite.
    Mass,
    /// The numbers leave the range of double precision.
    Range,
    /// The order is above 100, and this build is without the feature `matrices`.
    #[cfg(not(feature = "matrices"))]
    LeftOut,
}

/// Whether the pivots of a Cholesky factor, each with the diagonal element that it comes from, are more than what
/// rounding leaves of zero.
pub fn is_definite(pivots: impl ExactSizeIterator<Item = (f64, f64)>) -> bool {
    let rounding = pivots.len() as f64 * f64::EPSILON;
    pivots.into_iter().all(|(pivot, diagonal)| pivot * pivot > rounding * diagonal)
}
