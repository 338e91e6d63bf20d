//! Poles of a loop, and the one that makes a closed loop unstable.

use std::f64::consts::TAU;
use std::fmt;

use nalgebra::linalg::Schur;
use nalgebra::linalg::balancing::balance_parlett_reinsch;
use nalgebra::{Complex, DMatrix, DVector};
use serde::Serialize;

use super::frequency_response::modulus;
use super::sample_components::LoopSamples;
use crate::open_loop::OpenLoop;

/// Number of sweeps after which the search for eigenvalues is given up.
const SWEEPS: usize = 10_000;
/// Shifts with which the search is tried again, over the norm of the matrix, and whether of its transpose.
const SHIFTS: [(f64, bool); 6] =
    [(1.0, false), (0.0, true), (1.0, true), (-1.0, false), (0.618, true), (2.414, false)];
/// Largest entries below the diagonal that the search takes for 0, relative to those on it: its own rounding of equal loops can
/// exceed the first.
const NEGLIGIBLE: [f64; 2] = [f64::EPSILON, 8.0 * f64::EPSILON];
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
        if self.spectral_radius.is_infinite() {
            return write!(
                f,
                "the poles of the closed loop cannot be computed, so that its margins are not known"
            );
        }
        write!(
            f,
            "the closed loop is not stable and has no margins: a pole of magnitude {:.7} at {:.4} rad/s ({:.4} Hz), damping \
             {:.3e}, is largest in `{}`",
            self.spectral_radius,
            self.frequency_rad_s,
            self.frequency_rad_s / TAU,
            self.damping,
            self.signal
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
    let values = |matrix: DMatrix<f64>, negligible: f64| -> Option<Vec<Complex<f64>>> {
        let schur = Schur::try_new(matrix, negligible, SWEEPS)?;
        Some(schur.complex_eigenvalues().iter().copied().collect())
    };
    // The search compares entries below the diagonal with those on it, and never ends for a defective eigenvalue 0, such as
    // that of delays. A shifted matrix has none: the error is a rounding of the whole matrix, as LAPACK's is. Equal loops
    // about several axes can keep the search in a cycle, which another shift or the transposed matrix leaves.
    let (size, order) = (balanced.norm(), balanced.nrows());
    let searched = |negligible: f64| {
        values(balanced.clone(), negligible).or_else(|| {
            SHIFTS.iter().find_map(|(factor, is_transposed)| {
                let shift = factor * size;
                let matrix = if *is_transposed { balanced.transpose() } else { balanced.clone() };
                let shifted =
                    values(matrix + DMatrix::from_diagonal_element(order, order, shift), negligible)?;
                Some(shifted.into_iter().map(|value| value - shift).collect())
            })
        })
    };
    NEGLIGIBLE.into_iter().find_map(searched)
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
    let vector = eigenvector(closed, worst);
    let shown = vector.map(|vector| opened.transfer.c.map(|entry| Complex::new(entry, 0.0)) * vector);
    let motion = shown.as_ref().map_or(&[][..], |shown| shown.as_slice());
    let samples = LoopSamples { period: opened.period, count: opened.samples };
    let (frequency, _) = samples.frequency(libm::atan2(worst.im, worst.re).abs(), motion);
    let growth = Complex::new(libm::log(radius) / opened.period, frequency);
    let size = modulus(growth);
    Err(UnstableLoop {
        spectral_radius: radius,
        frequency_rad_s: size,
        damping: -growth.re / size,
        signal: largest_signal(opened, motion).unwrap_or_default(),
    })
}

/// Returns the name of the signal that is largest in a motion, sample after sample.
fn largest_signal(opened: &OpenLoop, motion: &[Complex<f64>]) -> Option<String> {
    let count = opened.signals.len();
    let size = |signal: usize| motion.iter().skip(signal).step_by(count).map(Complex::norm_sqr).sum::<f64>();
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

#[cfg(test)]
mod tests {
    use nalgebra::dmatrix;

    use super::*;

    /// Three samples of delay, twice, beside an integrator and a slow pole.
    #[test]
    fn delays_have_the_eigenvalue_0() {
        let mut matrix = DMatrix::<f64>::zeros(8, 8);
        for (row, column) in [(1, 0), (2, 1), (4, 3), (5, 4), (6, 2), (6, 5)] {
            matrix[(row, column)] = 1.0;
        }
        (matrix[(6, 6)], matrix[(7, 7)], matrix[(7, 6)]) = (1.0, 0.5, 0.3);
        let mut sizes: Vec<f64> = eigenvalues(&matrix).expect("values").into_iter().map(modulus).collect();
        sizes.sort_by(f64::total_cmp);
        for (size, expected) in sizes.iter().zip([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.5, 1.0]) {
            // A defective value of order three has an error of the third root of the rounding.
            assert!((size - expected).abs() < 1e-4, "{sizes:?}");
        }
        let turn = dmatrix![0.0, -2.0; 2.0, 0.0];
        assert!(eigenvalues(&turn).expect("values").iter().all(|value| (value.im.abs() - 2.0).abs() < 1e-15));
    }
}
