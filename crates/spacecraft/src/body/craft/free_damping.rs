//! Damping of free modes, computed from the damping ratios of the clamped modes.

use flexsc_dynamics::three_axis::FreeModes;
use nalgebra::DMatrix;

/// Off-diagonal damping coupling below which neglecting it causes only a small error of the response.
const SMALL: f64 = 0.05;
/// Ratio of two clamped damping ratios up to which little passes a damper that the diagonal does not have.
const ALIKE: f64 = 10.0;

/// Damping matrix of free modes, Dq = Y' D Y with D = 2 zeta O of the clamped ones.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeModeDamping {
    /// Full matrix Dq (1/s).
    pub matrix: DMatrix<f64>,
    /// Damping ratios of the diagonal of Dq, Dq_ii/(2 W_i).
    pub ratios: Vec<f64>,
    /// Largest |Dq_ij| W/|W_i² - W_j²|: the approximate relative error of a mode if only the diagonal is kept.
    pub coupling: f64,
    /// True if a clamped damping ratio is more than [`ALIKE`] times another: the modes of an isolator.
    has_isolator: bool,
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
        let least = ratios.iter().copied().fold(f64::INFINITY, f64::min);
        let has_isolator = ratios.iter().any(|ratio| *ratio > ALIKE * least);
        let ratios = own.iter().enumerate().map(|(mode, frequency)| matrix[(mode, mode)] / (2.0 * frequency));
        Self { ratios: ratios.collect(), coupling, has_isolator, matrix }
    }

    /// Returns true if the entries of the matrix off its diagonal are not negligible.
    pub fn couples_modes(&self) -> bool {
        self.coupling > SMALL || self.has_isolator
    }
}
