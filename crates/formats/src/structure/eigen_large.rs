//! Eigenproblem of large matrices, solved by faer.

use faer::linalg::matmul::triangular::{BlockStructure, matmul};
use faer::{Mat, Side};
use nalgebra::DMatrix;

use super::eigen_reduced::{EigenError, ReducedEigen, is_definite};

/// Solves the reduced problem for matrices of any order.
pub fn large(
    stiffness: &DMatrix<f64>,
    mass: &DMatrix<f64>,
    functionals: &DMatrix<f64>,
) -> Result<ReducedEigen, EigenError> {
    let factor = |matrix: &DMatrix<f64>, indefinite| {
        let factor = to_faer(matrix).llt(Side::Lower).map_err(|_| indefinite)?;
        let pivots = (0..matrix.nrows()).map(|i| (factor.L()[(i, i)], matrix[(i, i)]));
        if is_definite(pivots) { Ok(factor) } else { Err(indefinite) }
    };
    let l = factor(stiffness, EigenError::Stiffness)?;
    let mut b = factor(mass, EigenError::Mass)?.L().to_owned();
    l.L().solve_lower_triangular_in_place(&mut b);
    let mut square = Mat::zeros(b.nrows(), b.nrows());
    matmul(
        &mut square,
        BlockStructure::TriangularLower,
        faer::Accum::Replace,
        &b,
        BlockStructure::Rectangular,
        b.transpose(),
        BlockStructure::Rectangular,
        1.0,
        faer::Par::Seq,
    );
    if !square.is_all_finite() {
        return Err(EigenError::Range);
    }
    let eigen = square.self_adjoint_eigen(Side::Lower).map_err(|_| EigenError::Range)?;
    let mut functionals = to_faer(functionals);
    l.L().solve_lower_triangular_in_place(&mut functionals);
    let values = eigen.U().transpose() * &functionals;
    Ok(ReducedEigen {
        squares: eigen.S().column_vector().iter().copied().collect(),
        values: DMatrix::from_fn(values.nrows(), values.ncols(), |i, j| values[(i, j)]),
    })
}

fn to_faer(matrix: &DMatrix<f64>) -> Mat<f64> {
    Mat::from_fn(matrix.nrows(), matrix.ncols(), |i, j| matrix[(i, j)])
}
