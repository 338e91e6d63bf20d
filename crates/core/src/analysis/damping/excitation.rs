//! Whether what an observer saw tells its parameters apart.

use nalgebra::{DMatrix, SymmetricEigen};

/// Persistence of excitation: the least eigenvalue of the Gram matrix of the sensitivities of the prediction to each
/// parameter, each normalised to length 1. One row a sample, one column a parameter. 1 where the parameters are told apart
/// as well as can be, 0 where some combination of them is never seen; none if there are no numbers, rows of different
/// length or a parameter that was never excited.
pub fn persistence(sensitivities: &[Vec<f64>]) -> Option<f64> {
    let count = sensitivities.first()?.len();
    if count == 0 || sensitivities.iter().any(|row| row.len() != count) {
        return None;
    }
    let gram =
        DMatrix::from_fn(count, count, |i, j| sensitivities.iter().map(|row| row[i] * row[j]).sum::<f64>());
    let lengths: Vec<f64> = (0..count).map(|i| libm::sqrt(gram[(i, i)])).collect();
    if lengths.iter().any(|length| !(length.is_finite() && *length > 0.0)) {
        return None;
    }
    let normal = DMatrix::from_fn(count, count, |i, j| gram[(i, j)] / (lengths[i] * lengths[j]));
    let values = SymmetricEigen::new(normal).eigenvalues;
    Some(values.iter().copied().fold(f64::INFINITY, f64::min))
}
