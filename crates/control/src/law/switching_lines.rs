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

use super::{Authority, PhasePlane};

/// Switching lines of an axis.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct SwitchingLines {
    /// Angle from which on the body is returned (rad).
    edge: f64,
    rate_limit: f64,
    /// Slopes of the rate beyond the edge (1/s): the steepest one, and one along which jets can brake from the largest
    /// rate.
    slope: f64,
    flat: f64,
    /// Twice the deceleration of braking (rad/s²).
    parabola: f64,
    on: f64,
    off: f64,
    /// Rate change by the smallest pulse (rad/s), below which a pulse is not worthwhile.
    least: f64,
    /// Smallest target rate of return, whatever the authority of the jets (rad/s).
    slow: f64,
}

impl SwitchingLines {
    /// Creates the lines about an axis with this actuator authority.
    pub fn new(spec: &PhasePlane, authority: &Authority) -> Self {
        let [plus, minus] = authority.accelerations;
        let (on, off) = (spec.switch_on.get(), spec.switch_off.get());
        let (slope, zone) = (spec.slope.get(), spec.dead_zone.get());
        let braking = spec.braking.get() * plus.min(minus);
        let least = smallest_change(authority).max(LEAST * on);
        let slow = off.max(2.0 * least);
        let edge = (zone - slow / slope).max(0.5 * zone);
        let rate_limit = spec.rate_limit.get().max(2.0 * least);
        Self {
            edge,
            rate_limit,
            // At the boundary of the dead zone the return is worth the smallest pulse.
            slope: slope.max(2.0 * least / (zone - edge)),
            flat: slope.min(braking / rate_limit),
            parabola: 2.0 * braking,
            on: on.max(least),
            off,
            least,
            slow,
        }
    }

    /// Returns the target rate at an angle (rad/s).
    pub fn target_rate(&self, angle: f64) -> f64 {
        -self.returning(angle.abs() - self.edge).copysign(angle)
    }

    /// Returns the target rate of return at an angle `beyond` the edge (rad/s).
    fn returning(&self, beyond: f64) -> f64 {
        if beyond <= 0.0 {
            return 0.0;
        }
        let slow = self.slow.min(self.slope * beyond).min(f64::sqrt(self.parabola * beyond));
        (self.flat * beyond).max(slow).min(self.rate_limit)
    }

    /// Returns the tolerances of the rate above and below the target rate at an angle (rad/s).
    pub fn rate_tolerance(&self, angle: f64) -> [f64; 2] {
        [angle, -angle].map(|ahead| self.upper_tolerance(ahead))
    }

    /// Returns the tolerance of the rate above the target rate at an angle (rad/s).
    #[inline]
    pub fn upper_tolerance(&self, angle: f64) -> f64 {
        let beyond = angle - self.edge;
        let allowed =
            if beyond > 0.0 { 0.5 * self.returning(beyond) } else { f64::sqrt(-self.parabola * beyond) };
        allowed.clamp(self.least, self.on)
    }

    /// Returns the rate error below which the jets stop firing, for a tolerance (rad/s).
    pub fn release_level(&self, allowed: f64) -> f64 {
        self.off.min(0.5 * allowed)
    }
}

/// Fraction of `switch_on` below which a rate error is not worth a pulse, however short pulses may be.
const LEAST: f64 = 1e-3;

/// Returns the rate change by the smallest pulse in the stronger direction (rad/s).
fn smallest_change(authority: &Authority) -> f64 {
    let [plus, minus] = authority.accelerations;
    plus.max(minus) * authority.width.shortest()
}

/// Returns the expected error band about an axis (rad): the dead zone, plus the rotation by the smallest pulse until
/// the next one can act.
pub fn error_band(spec: &PhasePlane, authority: &Authority) -> f64 {
    let period = spec.period.seconds();
    let cycles = libm::round(authority.delay / period) + 2.0;
    spec.dead_zone.get() + smallest_change(authority) * cycles * period
}
