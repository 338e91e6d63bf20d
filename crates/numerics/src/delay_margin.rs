//! Largest stable gain of a delayed rate feedback, x'' + 2 zeta w x' + w² x + k x'(t - h) = 0, and the limit cycle of
//! a relay in its place.
//!
//! On the stability boundary x = exp(i y t): w = zeta y tan(h y) + y sqrt(zeta² tan²(h y) + 1) and k = -2 zeta
//! w/cos(h y) (D-partition, \[Timakov14\], page 50). With k > 0 the cosine is negative: in each such interval of h y
//! one y belongs to w, and the interval with the least k is the boundary.

use std::f64::consts::{FRAC_PI_2, PI};

/// Number of halvings of an interval: more than its bits.
const HALVINGS: u32 = 100;

/// Stability boundary of the loop.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct DelayMargin {
    /// Gain k up to which the loop is stable (1/s).
    pub gain: f64,
    /// Frequency of the oscillation at that gain (rad/s).
    pub frequency: f64,
}

impl DelayMargin {
    /// Returns the rate amplitude (rad/s) of the limit cycle of a relay with the given acceleration (rad/s²), at this
    /// frequency: by its describing function, 4 a/(pi k). Simulated amplitudes are a fifth larger. Ours.
    pub fn limit_cycle(&self, acceleration: f64) -> f64 {
        4.0 * acceleration / (PI * self.gain)
    }
}

/// Returns the stability boundary for a natural frequency (rad/s), a delay (s) and a damping ratio; `None` without a
/// delay, where every gain is stable.
pub fn delay_margin(frequency: f64, delay: f64, damping: f64) -> Option<DelayMargin> {
    if delay <= 0.0 {
        return None;
    }
    let ends = |branch: f64| [0.5, 1.5].map(|part| (part + 2.0 * branch) * PI / delay);
    // The gain k is at least |y² - w²|/y: intervals further from w cannot be the boundary.
    let least = |y: f64| (y * y - frequency * frequency).abs() / y;
    let middle = libm::floor((frequency * delay - FRAC_PI_2) / (2.0 * PI)).max(0.0);
    let mut best = on(ends(middle), frequency, delay, damping);
    let mut branch = middle + 1.0;
    while ends(branch)[0] <= frequency || least(ends(branch)[0]) < best.gain {
        best = lower(best, on(ends(branch), frequency, delay, damping));
        branch += 1.0;
    }
    branch = middle - 1.0;
    while branch >= 0.0 && least(ends(branch)[1]) < best.gain {
        best = lower(best, on(ends(branch), frequency, delay, damping));
        branch -= 1.0;
    }
    Some(best)
}

fn lower(a: DelayMargin, b: DelayMargin) -> DelayMargin {
    if b.gain < a.gain { b } else { a }
}

/// Returns the point of an interval that belongs to a natural frequency, which increases along it from 0 to infinity.
fn on([mut low, mut high]: [f64; 2], frequency: f64, delay: f64, damping: f64) -> DelayMargin {
    // Both sides of the equation of w times a positive number, which avoids overflow and cancellation.
    let above = |y: f64| {
        let (sin, cos) = libm::sincos(delay * y);
        let root = libm::hypot(cos, damping * sin);
        if sin >= 0.0 {
            -y * cos > frequency * (damping * sin + root)
        } else {
            y * (root - damping * sin) > -frequency * cos
        }
    };
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if above(middle) { high = middle } else { low = middle }
    }
    let y = 0.5 * (low + high);
    let (sin, cos) = libm::sincos(delay * y);
    // The imaginary and the real part of the characteristic equation give the same k; each is accurate where the
    // other is not.
    let gain = if cos < -0.5 {
        -2.0 * damping * frequency / cos
    } else {
        (y - frequency) * (y + frequency) / (y * sin)
    };
    DelayMargin { gain: gain.max(0.0), frequency: y }
}
