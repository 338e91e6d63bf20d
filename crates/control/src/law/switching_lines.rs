//! Switching lines of the phase-plane law for an axis, from its settings and the authority of the actuator.

use flexsc_flight::switching_lines::SwitchingLines;

use super::{Authority, PhasePlane};

/// Returns the lines about an axis with this actuator authority.
pub fn switching_lines(spec: &PhasePlane, authority: &Authority) -> SwitchingLines {
    let [plus, minus] = authority.accelerations;
    let (on, off) = (spec.switch_on.get(), spec.switch_off.get());
    let (slope, zone) = (spec.slope.get(), spec.dead_zone.get());
    let braking = spec.braking.get() * plus.min(minus);
    let least = smallest_change(authority).max(LEAST * on);
    let slow = off.max(2.0 * least);
    let edge = (zone - slow / slope).max(0.5 * zone);
    let rate_limit = spec.rate_limit.get().max(2.0 * least);
    SwitchingLines {
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
