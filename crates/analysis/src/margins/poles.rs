//! Poles of a loop, and the one that makes a closed loop unstable.

use std::f64::consts::TAU;
use std::fmt;

use nalgebra::{Complex, DMatrix};
use serde::Serialize;

use super::frequency_response::modulus;
use super::sample_components::LoopSamples;
use crate::eigenvalues::eigenvector;
use crate::open_loop::OpenLoop;

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

impl UnstableLoop {
    /// Creates the fault of a loop whose poles cannot be computed.
    pub fn with_unknown_poles(signal: &str) -> Self {
        Self {
            spectral_radius: f64::INFINITY,
            frequency_rad_s: 0.0,
            damping: -1.0,
            signal: signal.to_owned(),
        }
    }
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
