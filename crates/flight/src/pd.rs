//! The sampled PD law, u = -k_p (y - y_goal) - k_d (y' - y'_goal), held between its samples.
//!
//! y is the measured angle, or with an extra loop y = x + gain x_d, where x_d is the estimated displacement of the
//! dominant mode (\[Wheel11, Sukhanov\], equations (5), (7) and (8)).

use crate::axis_motion::{AxisMotion, AxisReference};
use crate::error_measure::ErrorMeasure;
use crate::gain_schedule::{SchedulePoint, scheduled_gain};
use crate::maths::clamp;

/// Derivative of the error.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum ErrorDerivative {
    /// The measured rate.
    Measured,
    /// The difference of two samples divided by their period.
    Difference,
    /// The difference of two samples: the derivative gain then has the unit of the proportional one.
    Raw,
}

/// State of the PD law about an axis.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct PdLaw {
    /// Proportional gain (N m/rad; for a wheel, units of its command per rad).
    pub k_p: f64,
    /// Derivative gain (N m s/rad; without the second where the difference is raw).
    pub k_d: f64,
    /// Largest torque (N m).
    pub limit: f64,
    /// Period of its samples (s).
    pub period: f64,
    /// Measure of the error.
    pub measure: ErrorMeasure,
    /// Derivative of the error.
    pub derivative: ErrorDerivative,
    /// True from the first sample on.
    pub has_last: bool,
    /// Error that was fed back at the last sample (rad).
    pub last: f64,
}

impl PdLaw {
    /// Returns the torque (N m) for the estimated motion, with the points of the extra loop's gain; none without that loop.
    #[inline]
    pub fn step(
        &mut self,
        motion: &AxisMotion,
        reference: &AxisReference,
        schedule: &[SchedulePoint],
    ) -> f64 {
        let gain: f64 = scheduled_gain(schedule, motion.frequency);
        let measured: f64 = self.measure.error(motion.angle, motion.total_angle);
        let error: f64 = measured - reference.angle + gain * motion.displacement;
        let rate_error: f64 = motion.rate - reference.rate + gain * motion.displacement_rate;
        self.torque(error, rate_error)
    }

    /// Returns the torque (N m) for an error of the angle (rad) and of the rate (rad/s).
    #[inline]
    fn torque(&mut self, error: f64, rate_error: f64) -> f64 {
        let last: f64 = if self.has_last { self.last } else { error };
        let difference: f64 = error - last;
        let derivative: f64 = match self.derivative {
            ErrorDerivative::Measured => rate_error,
            ErrorDerivative::Difference => difference / self.period,
            ErrorDerivative::Raw => difference,
        };
        // After an error that is not finite the difference starts again.
        self.has_last = error.is_finite();
        self.last = error;
        let torque: f64 = -self.k_p * error - self.k_d * derivative;
        clamp(torque, -self.limit, self.limit)
    }
}
