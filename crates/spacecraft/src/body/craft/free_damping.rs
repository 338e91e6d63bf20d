//! Damping of free modes, computed from the damping ratios of the clamped modes.

use flexsc_dynamics::three_axis::FreeModes;
use nalgebra::DMatrix;

/// Off-diagonal damping coupling below which neglecting it causes only a small error of the response.
const SMALL: f64 = 0.05;

/// Damping matrix of free modes, Dq = Y' D Y with D = 2 zeta O of the clamped ones.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeModeDamping {
    /// Full matrix Dq (1/s).
    pub matrix: DMatrix<f64>,
    /// Damping ratios of the diagonal of Dq, Dq_ii/(2 W_i).
    pub ratios: Vec<f64>,
    /// Largest |Dq_ij| W/|W_i² - W_j²|: the approximate relative error of a mode if only the diagonal is kept.
    pub coupling: f64,
}

impl FreeModeDamping {
    /// Computes the damping of free modes from the frequencies and damping ratios of the clamped modes.
    pub fn new(free: &FreeModes, frequencies: &[f64], ratios: &[f64]) -> Self {
        let mut scaled = free.shapes.clone();
        for (mut row, (frequency, ratio)) in scaled.row_iter_mut().zip(frequencies.iter().zip(ratios)) {
            row *= 2.0 * ratio * frequency;
        }
        let matrix = free.shapes.tr_mul(&scaled);
        let matrix = 0.5 * (&matrix + matrix.transpose());
        let own = &free.frequencies;
        let mut coupling: f64 = 0.0;
        for row in 0..own.len() {
            for column in 0..row {
                let apart = (own[row] * own[row] - own[column] * own[column]).abs();
                let damped = matrix[(row, column)].abs() * own[row].max(own[column]);
                // Any damping at all couples modes of equal frequency.
                if damped > 0.0 {
                    coupling = coupling.max(damped / apart);
                }
            }
        }
        let ratios = own.iter().enumerate().map(|(mode, frequency)| matrix[(mode, mode)] / (2.0 * frequency));
        Self { ratios: ratios.collect(), coupling, matrix }
    }

    /// Returns the full matrix if the coupling is not small, or if `asked` requires it.
    pub fn full_matrix(&self, requested: bool) -> Option<DMatrix<f64>> {
        (requested || self.coupling > SMALL).then(|| self.matrix.clone())
    }
}
