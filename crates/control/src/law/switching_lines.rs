//! Switching lines in the phase plane of one axis: the rate that the body shall have at an angle, and how far off it may be.
//!
//! With the jets' acceleration m, the angle e beyond the target, and d what of it lies outside an edge c just within the dead
//! zone, the body shall return at the rate
//!
//! ```text
//! r(d) = min(rate_limit, max(k d, min(slow, steep d, sqrt(2 b m d)))),   k = min(slope, b m/rate_limit)
//! slow = max(switch_off, 2 least),   steep = max(slope, 2 least/(dead_zone - c))
//! ```
//!
//! with b = `braking` and least, what the smallest pulse changes: along k d it brakes in time from the largest rate; jets for
//! which that line is flat do not wait on it, but return at the rate slow until sqrt(2 b m d), from which they can brake.
//! Beyond the edge half of r is the least rate of return that is left alone: of slow, it is never less than a pulse can change,
//! so that no body rests beyond the dead zone. Within it a rate outwards is left alone as long as the jets can stop the body
//! before the edge, and none above `switch_on` is. Where a pulse changes more than `switch_on` or half of `rate_limit`, these are
//! raised to it. Parabolas are as in \[Wie08\]; the rest is ours.

use super::{Authority, PhasePlane};

/// The switching lines of an axis.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct SwitchingLines {
    /// From this angle on the body is turned back (rad).
    edge: f64,
    rate_limit: f64,
    /// Rates for each rad beyond the edge: at most, and as far as jets can brake along it from the largest rate (1/s).
    slope: f64,
    flat: f64,
    /// Twice the deceleration (rad/s²).
    parabola: f64,
    on: f64,
    off: f64,
    /// What the smallest pulse changes (rad/s): less is not worth one.
    least: f64,
    /// Rate of the return that is wanted however weak the jets are (rad/s).
    slow: f64,
}

impl SwitchingLines {
    /// The lines about an axis on which an actuator has this authority.
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
            // At the end of the dead zone the return is worth the smallest pulse.
            slope: slope.max(2.0 * least / (zone - edge)),
            flat: slope.min(braking / rate_limit),
            parabola: 2.0 * braking,
            on: on.max(least),
            off,
            least,
            slow,
        }
    }

    /// The rate that the body shall have at an angle (rad/s).
    pub fn wanted(&self, angle: f64) -> f64 {
        -self.returning(angle.abs() - self.edge).copysign(angle)
    }

    /// Rate of the return from so far beyond the edge (rad/s).
    fn returning(&self, beyond: f64) -> f64 {
        if beyond <= 0.0 {
            return 0.0;
        }
        let slow = self.slow.min(self.slope * beyond).min(f64::sqrt(self.parabola * beyond));
        (self.flat * beyond).max(slow).min(self.rate_limit)
    }

    /// How far the rate may be above, and below, the one that it shall have at an angle (rad/s).
    pub fn allowed(&self, angle: f64) -> [f64; 2] {
        [angle, -angle].map(|ahead| self.allowed_above(ahead))
    }

    /// How far the rate may be above the one that it shall have at an angle (rad/s).
    #[inline]
    pub fn allowed_above(&self, angle: f64) -> f64 {
        let beyond = angle - self.edge;
        let allowed =
            if beyond > 0.0 { 0.5 * self.returning(beyond) } else { f64::sqrt(-self.parabola * beyond) };
        allowed.clamp(self.least, self.on)
    }

    /// Below which excess of the rate the jets end to fire, where so much is allowed (rad/s).
    pub fn release(&self, allowed: f64) -> f64 {
        self.off.min(0.5 * allowed)
    }
}

/// No rate below this part of `switch_on` is worth a pulse, however short pulses may be.
const LEAST: f64 = 1e-3;

/// What the smallest pulse of the stronger sign changes (rad/s).
fn smallest_change(authority: &Authority) -> f64 {
    let [plus, minus] = authority.accelerations;
    plus.max(minus) * authority.width.shortest()
}

/// How near to its target the law keeps the body about an axis (rad): the dead zone, and what the smallest pulse turns it
/// until the next one can act.
pub fn band(spec: &PhasePlane, authority: &Authority) -> f64 {
    let period = spec.period.seconds();
    let cycles = libm::round(authority.delay / period) + 2.0;
    spec.dead_zone.get() + smallest_change(authority) * cycles * period
}
