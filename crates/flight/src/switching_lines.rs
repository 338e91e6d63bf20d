//! Switching lines in the phase plane of one axis: target rate as a function of the angle, and its tolerance.
//!
//! With the jets' acceleration m, the angle e relative to the target, and d the part of it outside an edge c just
//! within the dead zone, the target rate of return is
//!
//! ```text
//! r(d) = min(rate_limit, max(k d, min(slow, steep d, sqrt(2 b m d)))),   k = min(slope, b m/rate_limit)
//! slow = max(switch_off, 2 least),   steep = max(slope, 2 least/(dead_zone - c))
//! ```
//!
//! with b = `braking` and `least` the rate change by the smallest pulse. Along k d the body can brake in time from the
//! largest rate. Weak jets, for which that line is flat, do not use it alone: they return at the rate slow until the
//! parabola, from which they can brake. Beyond the edge a return rate of at least r/2 is tolerated; since slow is at
//! least 2 least, no body stops beyond the dead zone. Within the edge a rate outwards is tolerated while the
//! jets can stop the body before the edge, and none above `switch_on`. If a pulse changes more than `switch_on` or half
//! of `rate_limit`, these are raised to it. Parabolas are as in \[Wie08\]; the rest is our design.

use crate::maths::{clamp, max, min};
use crate::square_root::sqrt;

/// Switching lines of an axis.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct SwitchingLines {
    /// Angle from which on the body is returned (rad).
    pub edge: f64,
    /// Largest target rate (rad/s).
    pub rate_limit: f64,
    /// Steepest slope of the rate beyond the edge (1/s).
    pub slope: f64,
    /// Slope of the rate beyond the edge along which jets can brake from the largest rate (1/s).
    pub flat: f64,
    /// Twice the deceleration of braking (rad/s²).
    pub parabola: f64,
    /// Rate error above which the jets begin to fire (rad/s).
    pub on: f64,
    /// Rate error below which the jets stop (rad/s).
    pub off: f64,
    /// Rate change by the smallest pulse (rad/s), below which a pulse is not worthwhile.
    pub least: f64,
    /// Smallest target rate of return, whatever the authority of the jets (rad/s).
    pub slow: f64,
}

impl SwitchingLines {
    /// Returns the target rate at an angle (rad/s).
    #[inline]
    pub fn target_rate(&self, angle: f64) -> f64 {
        -self.returning(angle.abs() - self.edge).copysign(angle)
    }

    /// Returns the target rate of return at an angle `beyond` the edge (rad/s).
    #[inline]
    fn returning(&self, beyond: f64) -> f64 {
        if beyond <= 0.0 {
            return 0.0;
        }
        let slow: f64 = min(min(self.slow, self.slope * beyond), sqrt(self.parabola * beyond));
        min(max(self.flat * beyond, slow), self.rate_limit)
    }

    /// Returns the tolerance of the rate above the target rate at an angle (rad/s); at the negative angle it is the tolerance
    /// below.
    #[inline]
    pub fn upper_tolerance(&self, angle: f64) -> f64 {
        let beyond: f64 = angle - self.edge;
        let allowed: f64 =
            if beyond > 0.0 { 0.5 * self.returning(beyond) } else { sqrt(-self.parabola * beyond) };
        clamp(allowed, self.least, self.on)
    }

    /// Returns the rate error below which the jets stop firing, for a tolerance (rad/s).
    #[inline]
    pub fn release_level(&self, allowed: f64) -> f64 {
        min(self.off, 0.5 * allowed)
    }
}
