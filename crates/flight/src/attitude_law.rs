//! The sampled attitude law: the acceleration about an axis that gives its error a bandwidth and a damping ratio.
//!
//! With e the angle and w the rate relative to the reference, it commands -(wn² (e + z/t) + 2 zeta wn w), with z the
//! integral of e, applies its filters, and adds the reference's acceleration (\[Wie08\], quaternion feedback).

use crate::axis_motion::{AxisMotion, AxisReference};
use crate::biquad::{BiquadFilter, filter_in_series};
use crate::error_measure::ErrorMeasure;
use crate::maths::clamp;

/// Attitude law about an axis.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct AttitudeFeedback {
    /// Bandwidth wn (rad/s).
    pub bandwidth: f64,
    /// Damping ratio zeta of the error.
    pub damping: f64,
    /// Measure of the error.
    pub measure: ErrorMeasure,
    /// Period of the samples (s).
    pub period: f64,
    /// True if there is a rate limit.
    pub has_rate_limit: bool,
    /// Largest rate at which an error is corrected (rad/s).
    pub rate_limit: f64,
    /// True if the error is integrated.
    pub has_integral: bool,
    /// Time constant of the integral (s).
    pub integral_time: f64,
    /// Largest integral (rad s).
    pub integral_limit: f64,
    /// Largest acceleration in the positive direction (rad/s²).
    pub acceleration_plus: f64,
    /// Largest acceleration in the negative direction (rad/s²).
    pub acceleration_minus: f64,
    /// Integral of the error (rad s).
    pub integral: f64,
}

impl AttitudeFeedback {
    /// Returns the acceleration (rad/s²) for the estimated motion. The filters, with their states, are those of this axis.
    #[inline]
    pub fn step(
        &mut self,
        motion: &AxisMotion,
        reference: &AxisReference,
        filters: &mut [BiquadFilter],
    ) -> f64 {
        let error: f64 = self.measure.error(motion.angle, motion.total_angle) - reference.angle;
        let rate_error: f64 = motion.rate - reference.rate;
        let wn: f64 = self.bandwidth;
        let integral_part: f64 = if self.has_integral { self.integral / self.integral_time } else { 0.0 };
        let angle: f64 = error + integral_part;
        let gain: f64 = 2.0 * self.damping * wn;
        let mut is_limited: bool = false;
        let feedback: f64;
        if self.has_rate_limit {
            let target_rate: f64 = 0.5 * wn / self.damping * angle;
            feedback = -gain * (rate_error + clamp(target_rate, -self.rate_limit, self.rate_limit));
            is_limited = target_rate.abs() > self.rate_limit;
        } else {
            feedback = -(wn * wn * angle + gain * rate_error);
        }
        let filtered: f64 = filter_in_series(filters, feedback);
        let acceleration: f64 = filtered + reference.acceleration;
        let is_saturated: bool =
            acceleration > self.acceleration_plus || -acceleration > self.acceleration_minus;
        self.integrate(error, is_limited || is_saturated);
        acceleration
    }

    /// Integrates the error over a period, unless a limit acts and the integral would grow, or the error is not finite.
    #[inline]
    fn integrate(&mut self, error: f64, is_limited: bool) {
        if self.has_integral && !(is_limited && error * self.integral > 0.0) {
            let sum: f64 = self.integral + self.period * error;
            if sum.is_finite() {
                self.integral = clamp(sum, -self.integral_limit, self.integral_limit);
            }
        }
    }
}
