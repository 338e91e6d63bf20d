//! Whether the measurements of an observer distinguish its parameters.

use nalgebra::{DMatrix, SymmetricEigen};

/// The Gram matrix of the sensitivities of the prediction to each parameter, summed over samples.
#[derive(Clone, Debug)]
pub struct Excitation(DMatrix<f64>);

impl Excitation {
    /// Of so many parameters, nothing seen yet.
    pub fn new(parameters: usize) -> Self {
        Self(DMatrix::zeros(parameters, parameters))
    }

    /// Takes the sensitivities at a sample, one for each parameter.
    pub fn add(&mut self, sensitivities: &[f64]) {
        for (i, a) in sensitivities.iter().enumerate() {
            for (j, b) in sensitivities.iter().enumerate() {
                self.0[(i, j)] += a * b;
            }
        }
    }

    /// Persistence of excitation: the least eigenvalue of the matrix, each parameter's sensitivities normalised to
    /// length 1. It is 1 where the parameters are distinguished as well as can be, 0 where some combination of them is never
    /// seen; none if there are no parameters, or one that was never excited.
    pub fn persistence(&self) -> Option<f64> {
        let count = self.0.nrows();
        let lengths: Vec<f64> = (0..count).map(|i| f64::sqrt(self.0[(i, i)])).collect();
        if count == 0 || lengths.iter().any(|length| !(length.is_finite() && *length > 0.0)) {
            return None;
        }
        let normal = DMatrix::from_fn(count, count, |i, j| self.0[(i, j)] / (lengths[i] * lengths[j]));
        let values = SymmetricEigen::new(normal).eigenvalues;
        Some(values.iter().copied().fold(f64::INFINITY, f64::min))
    }
}

/// The persistence of excitation of these sensitivities, one row a sample, one column a parameter; none if there are no
/// numbers, rows of different length or a parameter that was never excited.
pub fn persistence(sensitivities: &[Vec<f64>]) -> Option<f64> {
    let count = sensitivities.first()?.len();
    if sensitivities.iter().any(|row| row.len() != count) {
        return None;
    }
    let mut excitation = Excitation::new(count);
    for row in sensitivities {
        excitation.add(row);
    }
    excitation.persistence()
}
