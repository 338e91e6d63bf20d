//! The phase-plane law: about an axis a relay with hysteresis on the rate, and pulses of computed length.
//!
//! In \[Timakov14\] the station's jets follow a relay law with pulse-width modulation in the phase plane; its switching
//! lines are not known. Here, s is the rigid rate, queued changes included, minus the target rate of
//! the switching lines at the angle error. If it exceeds their tolerance, the jets fire against s for |s|/m, or for
//! the whole cycle if that is longer, until it is within `switch_off` and half of the tolerance.

use crate::active_damping::{DampingLaw, DampingStatus, ElasticRateEstimate, RateTolerance};
use crate::axis_motion::{AxisMotion, AxisReference};
use crate::pulse_width::PulseQuantum;
use crate::switching_lines::SwitchingLines;

/// Phase-plane law about an axis.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct PhasePlaneLaw {
    /// Switching lines.
    pub lines: SwitchingLines,
    /// Cycle (s).
    pub period: f64,
    /// Largest acceleration in the positive direction (rad/s²).
    pub acceleration_plus: f64,
    /// Largest acceleration in the negative direction (rad/s²).
    pub acceleration_minus: f64,
    /// Quantisation of pulse lengths.
    pub quantum: PulseQuantum,
    /// True while the jets fire.
    pub firing: bool,
    /// True if the law damps elastic motion.
    pub has_damping: bool,
    /// Active damping; not used without it.
    pub damping: DampingLaw,
    /// Status of active damping in the last cycle.
    pub damped: DampingStatus,
}

impl PhasePlaneLaw {
    /// Returns the change of the rate (rad/s) by the pulses of a cycle, for elastic modes that laws may act on if `is_trusted`.
    pub fn step(
        &mut self,
        motion: &AxisMotion,
        reference: &AxisReference,
        modes: &[ElasticRateEstimate],
        is_trusted: bool,
    ) -> f64 {
        let angle: f64 = motion.angle - reference.angle;
        let rate: f64 = motion.rate - reference.rate + motion.queued_rate;
        let excess: f64 = rate - self.lines.target_rate(angle);
        // Tolerance on the side of the excess.
        let side: f64 = if excess < 0.0 { -angle } else { angle };
        let allowed: f64 = self.lines.upper_tolerance(side);
        let mut change: f64 = self.relay(excess, allowed);
        if self.has_damping {
            let tolerance: RateTolerance = RateTolerance {
                above: self.lines.upper_tolerance(angle),
                below: self.lines.upper_tolerance(-angle),
            };
            let is_free: bool = !self.firing && !tolerance.is_exceeded_by(excess);
            self.damped = self.damping.decide(modes, is_trusted, is_free, excess, &tolerance);
            change += self.damped.change;
        }
        change
    }

    /// Returns the change of the rate (rad/s) against an excess (rad/s), and decides whether the jets fire.
    fn relay(&mut self, excess: f64, allowed: f64) -> f64 {
        if excess.abs() > allowed {
            self.firing = true;
        } else if excess.abs() < self.lines.release_level(allowed) {
            self.firing = false;
        }
        if !self.firing {
            return 0.0;
        }
        let acceleration: f64 = if excess > 0.0 { self.acceleration_minus } else { self.acceleration_plus };
        // A change too small for a pulse ends the firing.
        self.firing = self.quantum.on_time(excess.abs() / acceleration, self.period) > 0.0;
        if self.firing { -excess } else { 0.0 }
    }
}
