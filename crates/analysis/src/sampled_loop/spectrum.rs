//! Spectral radius of a closed loop, and the pair of motions that decays last.

use nalgebra::{Complex, DVector};
use serde::Serialize;

use super::ClosedLoop;
use crate::eigenvalues::{eigenvector, schur_eigenvalues};

/// Slowest motion of a loop: a pair of eigenvalues, or a real one.
#[derive(Copy, Clone, Debug, PartialEq, Serialize)]
pub struct SlowestMode {
    /// Absolute value of the eigenvalue: the decay factor of the motion per sample.
    pub radius: f64,
    /// Angle of the eigenvalue: the rotation of the motion per sample (rad).
    pub turn_rad: f64,
    /// Initial amplitude of the motion in the angle (rad).
    pub amplitude_rad: f64,
    /// Time at which the envelope of the motion enters the band (s), smooth in the parameters; none if it grows.
    pub settling_s: Option<f64>,
}

impl ClosedLoop {
    /// Returns the eigenvalues of the linear loop, in no particular order; `None` if the search does not converge.
    pub fn eigenvalues(&self) -> Option<Vec<Complex<f64>>> {
        schur_eigenvalues(&self.matrix())
    }

    /// Returns the spectral radius of the linear loop, which is stable below 1. Infinite where a number is not finite.
    pub fn spectral_radius(&self) -> f64 {
        let values = self.eigenvalues();
        values.map_or(f64::INFINITY, |values| values.into_iter().map(modulus).fold(0.0, f64::max))
    }

    /// Returns the slowest motion, and the time at which it alone has settled within `band` (rad).
    pub fn slowest(&self, band: f64) -> Option<SlowestMode> {
        let values = self.eigenvalues()?;
        let mut value = *values.first()?;
        for other in values {
            // The upper eigenvalue of a pair.
            if modulus(other) > modulus(value) || (modulus(other) == modulus(value) && other.im > value.im) {
                value = other;
            }
        }
        let radius = modulus(value);
        let matrix = self.matrix();
        let right_vector = eigenvector(&matrix, value)?;
        let left_vector = eigenvector(&matrix.transpose(), value)?;
        let dot = |a: &DVector<Complex<f64>>, b: &DVector<Complex<f64>>| {
            a.iter().zip(b.iter()).map(|(a, b)| a * b).sum::<Complex<f64>>()
        };
        let complex = |v: &[f64]| DVector::from_iterator(v.len(), v.iter().map(|v| Complex::new(*v, 0.0)));
        let shown = dot(&complex(self.angle.as_slice()), &right_vector);
        let initial = dot(&left_vector, &complex(self.start.as_slice()));
        let pair = if value.im == 0.0 { 1.0 } else { 2.0 };
        let amplitude = pair * modulus(shown * initial / dot(&left_vector, &right_vector));
        let settling = if amplitude <= band {
            Some(0.0)
        } else {
            (radius < 1.0).then(|| -libm::log(amplitude / band) / libm::log(radius) * self.period)
        };
        Some(SlowestMode {
            radius,
            turn_rad: libm::atan2(value.im, value.re),
            amplitude_rad: amplitude,
            settling_s: settling,
        })
    }
}

fn modulus(value: Complex<f64>) -> f64 {
    libm::hypot(value.re, value.im)
}
