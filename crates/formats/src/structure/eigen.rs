//! Eigenproblem K x = w² M x, exact in the low modes.
//!
//! Both matrices are positive definite. With the Cholesky factors K = L L' and M = R R', and B = L⁻¹ R, it is (B B') y
//! = w⁻² y with x = w L⁻' y: the low modes are the large eigenvalues, which keep all their digits. (With a reduction by
//! the factor of M, the errors would be relative to the highest mode.) x' M x = 1.

use nalgebra::{Cholesky, DMatrix, SymmetricEigen};

#[cfg(feature = "matrices")]
use super::eigen_large::large;
use super::eigen_reduced::{EigenError, ReducedEigen, is_definite};
#[cfg(not(feature = "matrices"))]
use super::unavailable::large;

/// Largest order that nalgebra solves, with the same result on every machine. Above it faer is many times faster, but
/// the last digits of its results depend on the processor.
pub const SMALL: usize = 100;

/// Modes: natural frequencies and the values of some linear functionals.
pub struct EigenModes {
    /// Natural frequencies (rad/s), increasing.
    pub frequencies: Vec<f64>,
    /// Value c' x of each functional c, one row for each mode, with x' M x = 1.
    pub values: DMatrix<f64>,
}

/// Computes the modes of a stiffness and a mass matrix, and the values of the functionals, which are columns.
pub fn modes(
    stiffness: DMatrix<f64>,
    mass: DMatrix<f64>,
    functionals: &DMatrix<f64>,
) -> Result<EigenModes, EigenError> {
    let order = stiffness.nrows();
    let reduced = if order <= SMALL {
        small(stiffness, mass, functionals)?
    } else {
        large(&stiffness, &mass, functionals)?
    };
    let mut falling: Vec<usize> = (0..order).collect();
    falling.sort_by(|a, b| reduced.squares[*b].total_cmp(&reduced.squares[*a]));
    // A square that is lost in rounding gives a frequency beyond every accepted range.
    let frequencies: Vec<f64> =
        falling.iter().map(|n| 1.0 / f64::sqrt(reduced.squares[*n].max(f64::MIN_POSITIVE))).collect();
    let values =
        DMatrix::from_fn(order, functionals.ncols(), |n, c| frequencies[n] * reduced.values[(falling[n], c)]);
    Ok(EigenModes { frequencies, values })
}

/// Returns the eigenvalues of a symmetric matrix, increasing; `None` if an element is not finite. Only its lower half
/// is used.
pub fn values(matrix: &DMatrix<f64>) -> Option<Vec<f64>> {
    if matrix.iter().any(|element| !element.is_finite()) {
        return None;
    }
    // The matrix of a rigid body is empty.
    let mut values =
        if matrix.is_empty() { Vec::new() } else { matrix.symmetric_eigenvalues().as_slice().to_vec() };
    values.sort_by(f64::total_cmp);
    Some(values)
}

fn small(
    stiffness: DMatrix<f64>,
    mass: DMatrix<f64>,
    functionals: &DMatrix<f64>,
) -> Result<ReducedEigen, EigenError> {
    let factor = |matrix: DMatrix<f64>, indefinite| {
        let diagonal = matrix.diagonal();
        let factor = Cholesky::new(matrix).ok_or(indefinite)?.unpack();
        let pivots = (0..diagonal.len()).map(|i| (factor[(i, i)], diagonal[i]));
        if is_definite(pivots) { Ok(factor) } else { Err(indefinite) }
    };
    let l = factor(stiffness, EigenError::Stiffness)?;
    let r = factor(mass, EigenError::Mass)?;
    // The factors have no zeros on their diagonals.
    let b = l.solve_lower_triangular(&r).unwrap_or(r);
    let square = &b * b.transpose();
    if square.iter().any(|element| !element.is_finite()) {
        return Err(EigenError::Range);
    }
    let eigen = SymmetricEigen::new(square);
    let functionals = l.solve_lower_triangular(functionals).unwrap_or_else(|| functionals.clone());
    Ok(ReducedEigen {
        squares: eigen.eigenvalues.as_slice().to_vec(),
        values: eigen.eigenvectors.tr_mul(&functionals),
    })
}
