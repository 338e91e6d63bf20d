//! Persistence of excitation: a measure of how well an observer's measurements distinguish its parameters.

use nalgebra::{DMatrix, SymmetricEigen};

/// Gram matrix of the sensitivities of the prediction to each parameter, summed over samples.
#[derive(Clone, Debug)]
pub struct Excitation(DMatrix<f64>);

impl Excitation {
    /// Creates the matrix for a number of parameters, before the first sample.
    pub fn new(parameters: usize) -> Self {
        Self(DMatrix::zeros(parameters, parameters))
    }

    /// Adds the sensitivities at a sample, one for each parameter.
    pub fn add(&mut self, sensitivities: &[f64]) {
        for (i, a) in sensitivities.iter().enumerate() {
            for (j, b) in sensitivities.iter().enumerate() {
                self.0[(i, j)] += a * b;
            }
        }
    }

    /// Returns the persistence of excitation: the least eigenvalue of the matrix, with each parameter's sensitivities
    /// normalised to length 1. It is 1 where the parameters are distinguished as well as possible, and 0 where some
    /// combination of them is not observable; `None` if there are no parameters, or if one was never excited.
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

/// Returns the persistence of excitation of sensitivities, with a row for each sample and a column for each parameter;
/// `None` if there are no numbers, if rows differ in length, or if a parameter was never excited.
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
