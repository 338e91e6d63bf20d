//! Poles of a loop, and the one that makes a closed loop unstable.

use std::fmt;

use nalgebra::linalg::Schur;
use nalgebra::linalg::balancing::balance_parlett_reinsch;
use nalgebra::{Complex, DMatrix, DVector};
use serde::Serialize;

use super::frequency_response::modulus;
use crate::analysis::open_loop::OpenLoop;

/// Number of sweeps after which the search for eigenvalues is given up.
const SWEEPS: usize = 10_000;
/// Poles this near to the unit circle are on it, within rounding.
pub const ROUNDING: f64 = 1e-8;

/// Loop without margins.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct UnstableLoop {
    /// Largest magnitude of a pole of the closed loop; infinite if its poles cannot be computed.
    pub spectral_radius: f64,
    /// Frequency of that pole (rad/s).
    pub frequency_rad_s: f64,
    /// Damping ratio of that pole, negative.
    pub damping: f64,
    /// Signal at the break in which the motion of that pole is largest.
    pub signal: String,
}

impl fmt::Display for UnstableLoop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "the closed loop is not stable and has no margins: a pole of magnitude {:.7} at {:.4} rad/s, damping {:.3e}, \
             is largest in `{}`",
            self.spectral_radius, self.frequency_rad_s, self.damping, self.signal
        )
    }
}

impl std::error::Error for UnstableLoop {}

/// Returns the eigenvalues of a matrix; `None` if the search does not converge.
pub fn eigenvalues(matrix: &DMatrix<f64>) -> Option<Vec<Complex<f64>>> {
    if matrix.iter().any(|entry| !entry.is_finite()) {
        return None;
    }
    if matrix.is_empty() {
        return Some(Vec::new());
    }
    let mut balanced = matrix.clone();
    balance_parlett_reinsch(&mut balanced);
    let schur = Schur::try_new(balanced, f64::EPSILON, SWEEPS)?;
    Some(schur.complex_eigenvalues().iter().copied().collect())
}

/// Returns the spectral radius of a closed loop with these poles; the pole that makes it unstable as an error.
pub fn require_stable(
    opened: &OpenLoop,
    closed: &DMatrix<f64>,
    poles: &[Complex<f64>],
) -> Result<f64, UnstableLoop> {
    let largest = poles.iter().copied().max_by(|a, b| a.norm_sqr().total_cmp(&b.norm_sqr()));
    let Some(worst) = largest else { return Ok(0.0) };
    let radius = modulus(worst);
    if radius <= 1.0 + ROUNDING {
        return Ok(radius);
    }
    let growth = Complex::new(libm::log(radius), libm::atan2(worst.im, worst.re).abs());
    let size = modulus(growth);
    Err(UnstableLoop {
        spectral_radius: radius,
        frequency_rad_s: size / opened.period,
        damping: -growth.re / size,
        signal: largest_signal(opened, closed, worst).unwrap_or_default(),
    })
}

/// Returns the name of the signal in which the motion of a pole is largest.
fn largest_signal(opened: &OpenLoop, closed: &DMatrix<f64>, pole: Complex<f64>) -> Option<String> {
    let vector = eigenvector(closed, pole)?;
    let shown = opened.transfer.c.map(|entry| Complex::new(entry, 0.0)) * vector;
    let count = opened.signals.len();
    let size = |signal: usize| shown.iter().skip(signal).step_by(count).map(Complex::norm_sqr).sum::<f64>();
    let largest = (0..count).max_by(|a, b| size(*a).total_cmp(&size(*b)))?;
    Some(opened.signals[largest].name.clone())
}

/// Computes an eigenvector by inverse iteration, from a shift close to the eigenvalue.
fn eigenvector(matrix: &DMatrix<f64>, value: Complex<f64>) -> Option<DVector<Complex<f64>>> {
    let order = matrix.nrows();
    let perturbed = value * (1.0 + 1e-11);
    let shifted = matrix.map(|entry| Complex::new(entry, 0.0))
        - DMatrix::from_diagonal_element(order, order, perturbed);
    let factors = shifted.lu();
    let mut vector = DVector::from_fn(order, |row, _| Complex::new(1.0, 0.1 * row as f64));
    for _ in 0..4 {
        vector = factors.solve(&vector)?;
        let size = vector.iter().map(|entry| modulus(*entry)).fold(0.0, f64::max);
        vector.iter_mut().for_each(|entry| *entry /= size);
    }
    Some(vector)
}
