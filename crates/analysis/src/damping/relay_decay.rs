//! Decay of a mode under a relay: its amplitude over time, with and without a threshold. Derived for this project.

use std::f64::consts::FRAC_PI_2;

use flexsc_numerics::quadrature;

/// The amplitude V of the elastic rate under a relay that pushes while V exceeds a threshold g:
/// dV/dt = -r V - s sqrt(1 - (g/V)²).
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Decay {
    /// Decrease rate s of the amplitude by the relay (rad/s²): 2 a E/pi, negative where the relay drives the mode.
    pub slope: f64,
    /// Decay rate r of the free mode, zeta w (1/s).
    pub rate: f64,
}

impl Decay {
    /// Creates the decay under the damping part a E of an acceleration (rad/s²), with the decay rate zeta w of the free
    /// mode (1/s).
    pub fn new(effective: f64, rate: f64) -> Self {
        Self { slope: effective / FRAC_PI_2, rate }
    }

    /// Returns the amplitude (rad/s) after `time` (s) without a threshold: (V0 + s/r) exp(-r t) - s/r, at least 0.
    pub fn amplitude(&self, start: f64, time: f64) -> f64 {
        let turn = self.rate * time;
        let mean = if turn > 0.0 { -libm::expm1(-turn) / turn } else { 1.0 };
        (start * libm::exp(-turn) - self.slope * time * mean).max(0.0)
    }

    /// Returns the amplitude (rad/s) after `time` (s) with a threshold and without natural damping: sqrt(V² - g²) =
    /// sqrt(V0² - g²) - s t, at least g.
    pub fn amplitude_above(&self, start: f64, threshold: f64, time: f64) -> f64 {
        let remaining = f64::sqrt((start - threshold) * (start + threshold)) - self.slope * time;
        libm::hypot(remaining.max(0.0), threshold)
    }

    /// Returns the time (s) in which the amplitude falls from `start` to a threshold, which may be 0; `None` if it does
    /// not.
    pub fn threshold_time(&self, start: f64, threshold: f64) -> Option<f64> {
        if start <= threshold {
            return Some(0.0);
        }
        let Self { slope, rate } = *self;
        if slope <= 0.0 {
            return None;
        }
        if threshold == 0.0 {
            let ratio = rate * start / slope;
            return Some(if ratio > 0.0 { libm::log1p(ratio) / rate } else { start / slope });
        }
        if rate == 0.0 {
            return Some(f64::sqrt((start - threshold) * (start + threshold)) / slope);
        }
        Some(self.integral(start, threshold, |_| 1.0))
    }

    /// Returns the integral of a function of V/g over the time in which the amplitude falls from `start` to a
    /// threshold.
    fn integral(&self, start: f64, threshold: f64, integrand: impl Fn(f64) -> f64) -> f64 {
        // With V = g cosh u the integrand is smooth at the threshold.
        let part = |_, u: f64| {
            let (tanh, cosh) = (libm::tanh(u), libm::cosh(u));
            integrand(cosh) * threshold * tanh / (self.rate * threshold + self.slope * tanh / cosh)
        };
        quadrature::integral(&[0.0, libm::acosh(start / threshold)], 0.5, part)
    }

    /// Returns the fraction of the time under thrust at an amplitude: (2/pi) acos(g/V).
    pub fn duty(amplitude: f64, threshold: f64) -> f64 {
        if amplitude <= threshold { 0.0 } else { libm::acos(threshold / amplitude) / FRAC_PI_2 }
    }

    /// Returns the time under thrust (s) until the amplitude reaches the threshold; `None` if it does not. Without
    /// natural damping the time is (2 g/(pi s)) (theta tan(theta) + ln cos(theta)) with cos(theta) = g/V0.
    pub fn thrust_time(&self, start: f64, threshold: f64) -> Option<f64> {
        let whole = self.threshold_time(start, threshold)?;
        if threshold == 0.0 || start <= threshold {
            return Some(whole);
        }
        if self.rate > 0.0 {
            return Some(self.integral(start, threshold, |ratio| Self::duty(ratio, 1.0)));
        }
        let cos = threshold / start;
        let angle = libm::acos(cos);
        Some(threshold / (FRAC_PI_2 * self.slope) * (angle * libm::tan(angle) + libm::log(cos)))
    }
}
