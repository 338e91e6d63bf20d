//! Poles of a loop, the one limit of stability, and the pole that makes a closed loop unstable.

use std::f64::consts::TAU;
use std::fmt;

use flexsc_formats::reader_units::{number, time};
use nalgebra::{Complex, DMatrix};
use serde::Serialize;

use super::frequency_response::modulus;
use super::sample_components::LoopSamples;
use crate::eigenvalues::eigenvector;
use crate::open_loop::OpenLoop;

/// Rate (1/s) below which a motion neither grows nor decays: by a factor e in three years.
pub(super) const STEADY_RATE: f64 = 1e-8;
/// Distance of a pole from the unit circle that may be rounding, for periods shorter than 1 ms.
const ROUNDING: f64 = 1e-11;

/// Returns the change of a motion, as the logarithm of its size, up to which it neither grows nor decays over a period (s).
pub fn steady_change(period: f64) -> f64 {
    (STEADY_RATE * period).max(ROUNDING)
}

/// Returns true if a loop is stable whose poles over a period (s) have at most this magnitude.
pub fn is_stable(spectral_radius: f64, period: f64) -> bool {
    libm::log(spectral_radius) <= steady_change(period)
}

/// Returns the text of the magnitude of a pole outside the unit circle, in which it differs from 1.
pub fn magnitude_text(magnitude: f64) -> String {
    let beyond = magnitude - 1.0;
    if beyond < 1e-6 { format!("1 + {beyond:.1e}") } else { format!("{magnitude:.7}") }
}

/// Loop without margins.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct UnstableLoop {
    /// Largest magnitude of a pole of the closed loop; infinite if its poles cannot be computed.
    pub spectral_radius: f64,
    /// Time in which the motion of that pole grows by a factor e (s).
    pub growth_time_s: f64,
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
            growth_time_s: 0.0,
            frequency_rad_s: 0.0,
            damping: -1.0,
            signal: signal.to_owned(),
        }
    }
}

impl UnstableLoop {
    /// Returns the reason why a loop without `results`, such as margins, has none.
    pub fn reason(&self, results: &str) -> String {
        if self.spectral_radius.is_infinite() {
            return format!(
                "the poles of the closed loop cannot be computed, and without them it has no {results}"
            );
        }
        let Self { growth_time_s, frequency_rad_s, damping, signal, .. } = self;
        format!(
            "the closed loop is not stable and has no {results}: a pole of magnitude {} at \
             {} Hz, damping {}, grows by e in {} and is largest in `{signal}`",
            magnitude_text(self.spectral_radius),
            number(frequency_rad_s / TAU),
            number(*damping),
            time(*growth_time_s),
        )
    }
}

impl fmt::Display for UnstableLoop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.reason("margins"))
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
    if is_stable(radius, opened.period) {
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
        growth_time_s: opened.period / libm::log(radius),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_limit_is_one_of_time() {
        for period in [1e-3, 0.1, 20.0] {
            let at = |rate: f64| is_stable(libm::exp(rate * period), period);
            assert!(at(-1.0) && at(0.9e-8) && !at(1.1e-8), "{period}");
        }
        // A rounding of the poles is no growth.
        assert!(is_stable(1.0 + 5e-12, 1e-5) && !is_stable(1.0 + 2e-11, 1e-5));
        assert_eq!([magnitude_text(1.0 + 4.2e-9), magnitude_text(1.25)], ["1 + 4.2e-9", "1.2500000"]);
    }
}
