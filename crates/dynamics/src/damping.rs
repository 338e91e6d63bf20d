//! Free motion of a mode about its equilibrium, undamped or below critical damping, for single numbers and SIMD lanes
//! alike.
//!
//! Damping is a type parameter, so that undamped modes cost no more in a program that also supports damped ones.

#![allow(clippy::inline_always, reason = "inside functions with a target feature nothing else is inlined")]

use std::fmt::Debug;

use flexsc_numerics::exp_branch_free::{exp, exp_short};
use flexsc_numerics::lanes::LaneFloat;
use flexsc_numerics::trig::{sincos, sincos_short};

/// Angle (rad) below which a rotation is computed by a polynomial of order 5, exact to rounding.
pub const TINY: f64 = 3e-3;

/// Damping rule of a mode; its deviation is the displacement from equilibrium and the rate divided by the frequency
/// (rad).
pub trait DampingRule<R: LaneFloat>: Copy + Debug {
    /// True if modes of this kind can be damped.
    const IS_DAMPED: bool;

    /// Returns no damping; `kind` only determines the number type.
    fn undamped(kind: R) -> Self;

    /// Sets the damping in one lane to that of a mode with the given frequency (rad/s) and damping ratio.
    #[must_use]
    fn with_lane(self, lane: usize, frequency: f64, ratio: f64) -> Self;

    /// Returns the deviation after the time `t` (s).
    fn advance(self, frequency: R, deviation: [R; 2], t: R) -> [R; 2];

    /// Returns the deviation after `t` (s), for at most 3/4 rad of phase, forwards or backwards.
    fn advance_short(self, frequency: R, deviation: [R; 2], t: R) -> [R; 2];

    /// Returns the deviation after `t` (s), for a phase below [`TINY`].
    fn advance_tiny(self, frequency: R, deviation: [R; 2], t: R) -> [R; 2];

    /// Returns the derivatives x', -x'', -x''' and x'''' of the displacement x.
    fn derivatives(self, frequency: R, deviation: [R; 2]) -> [R; 4];

    /// Returns a bound of |x''| per unit distance from equilibrium (1/s²).
    fn stiffness(self, frequency: R) -> R;

    /// Returns the frequency of the motion (rad/s), reduced by damping.
    fn frequency(self, frequency: R) -> R;

    /// Returns the decay rate (1/s); `kind` only determines the number type.
    fn decay_rate(self, kind: R) -> R;
}

/// Rule of a mode without damping.
#[derive(Copy, Clone, Debug, Default)]
pub struct Undamped;

/// Rule of a mode with damping below critical, or none.
#[derive(Copy, Clone, Debug)]
pub struct Damped<R> {
    /// Decay rate, zeta w (1/s).
    pub decay: R,
    /// Damped frequency, w sqrt(1 - zeta²) (rad/s).
    pub frequency: R,
    /// Ratio zeta/sqrt(1 - zeta²).
    pub tilt: R,
    /// Ratio 1/sqrt(1 - zeta²).
    pub inverse_root: R,
    /// Twice the decay rate (1/s).
    pub drag: R,
    /// Bound of |x''| per unit distance from equilibrium (1/s²).
    pub stiffness: R,
}

impl Damped<f64> {
    /// Creates the rule of a mode with the given frequency (rad/s) and damping ratio below 1.
    pub fn new(frequency: f64, ratio: f64) -> Self {
        let root = f64::sqrt((1.0 - ratio) * (1.0 + ratio));
        Self {
            decay: ratio * frequency,
            frequency: frequency * root,
            tilt: ratio / root,
            inverse_root: 1.0 / root,
            drag: 2.0 * ratio * frequency,
            // Here x'' = -w² (x + 2 zeta y) with (x, y) of length 1.
            stiffness: frequency * frequency * f64::sqrt(1.0 + 4.0 * ratio * ratio),
        }
    }
}

impl<R: LaneFloat> Damped<R> {
    /// Returns the 2 x 2 transition matrix of the deviation, row by row, from sine and cosine of the damped phase and
    /// the factor of decay.
    #[inline(always)]
    pub fn transition(&self, (sin, cos): (R, R), decay_factor: R) -> [R; 4] {
        let (c, s) = (decay_factor * cos, decay_factor * sin);
        let (along, across) = (self.tilt * s, self.inverse_root * s);
        [c + along, across, -across, c - along]
    }

    #[inline(always)]
    fn pass(&self, [x, y]: [R; 2], turn: (R, R), decay_factor: R) -> [R; 2] {
        let [xx, xy, yx, yy] = self.transition(turn, decay_factor);
        [xx * x + xy * y, yx * x + yy * y]
    }
}

/// Returns sine and cosine of an angle below [`TINY`].
#[inline(always)]
fn tiny<R: LaneFloat>(x: R) -> (R, R) {
    let z = x * x;
    let (sixth, half) = (x.splat(1.0 / 6.0), x.splat(0.5));
    let sin = x - x * z * (sixth - z * x.splat(1.0 / 120.0));
    (sin, x.splat(1.0) - z * (half - z * x.splat(1.0 / 24.0)))
}

/// Returns the exponential of a number below [`TINY`].
#[inline(always)]
fn exp_tiny<R: LaneFloat>(x: R) -> R {
    let rest = x.splat(1.0 / 6.0) + x * (x.splat(1.0 / 24.0) + x * x.splat(1.0 / 120.0));
    x.splat(1.0) + (x + x * x * (x.splat(0.5) + x * rest))
}

#[inline(always)]
fn rotated<R: LaneFloat>([x, y]: [R; 2], (sin, cos): (R, R)) -> [R; 2] {
    [cos * x + sin * y, cos * y - sin * x]
}

impl<R: LaneFloat> DampingRule<R> for Undamped {
    const IS_DAMPED: bool = false;

    #[inline(always)]
    fn undamped(_: R) -> Self {
        Self
    }

    #[inline(always)]
    fn with_lane(self, _: usize, _: f64, _: f64) -> Self {
        self
    }

    #[inline(always)]
    fn advance(self, frequency: R, deviation: [R; 2], t: R) -> [R; 2] {
        rotated(deviation, sincos(frequency * t))
    }

    #[inline(always)]
    fn advance_short(self, frequency: R, deviation: [R; 2], t: R) -> [R; 2] {
        rotated(deviation, sincos_short(frequency * t))
    }

    #[inline(always)]
    fn advance_tiny(self, frequency: R, deviation: [R; 2], t: R) -> [R; 2] {
        rotated(deviation, tiny(frequency * t))
    }

    #[inline(always)]
    fn derivatives(self, frequency: R, [x, y]: [R; 2]) -> [R; 4] {
        let (square, v) = (frequency * frequency, frequency * y);
        let a = square * x;
        [v, a, square * v, square * a]
    }

    #[inline(always)]
    fn stiffness(self, frequency: R) -> R {
        frequency * frequency
    }

    #[inline(always)]
    fn frequency(self, frequency: R) -> R {
        frequency
    }

    #[inline(always)]
    fn decay_rate(self, kind: R) -> R {
        kind.splat(0.0)
    }
}

impl<R: LaneFloat> DampingRule<R> for Damped<R> {
    const IS_DAMPED: bool = true;

    #[inline(always)]
    fn undamped(kind: R) -> Self {
        let (zero, one) = (kind.splat(0.0), kind.splat(1.0));
        Self { decay: zero, frequency: one, tilt: zero, inverse_root: one, drag: zero, stiffness: one }
    }

    #[inline(always)]
    fn with_lane(self, lane: usize, frequency: f64, ratio: f64) -> Self {
        let damping = Damped::new(frequency, ratio);
        Self {
            decay: self.decay.with_lane(lane, damping.decay),
            frequency: self.frequency.with_lane(lane, damping.frequency),
            tilt: self.tilt.with_lane(lane, damping.tilt),
            inverse_root: self.inverse_root.with_lane(lane, damping.inverse_root),
            drag: self.drag.with_lane(lane, damping.drag),
            stiffness: self.stiffness.with_lane(lane, damping.stiffness),
        }
    }

    #[inline(always)]
    fn advance(self, _: R, deviation: [R; 2], t: R) -> [R; 2] {
        self.pass(deviation, sincos(self.frequency * t), exp(-(self.decay * t)))
    }

    #[inline(always)]
    fn advance_short(self, _: R, deviation: [R; 2], t: R) -> [R; 2] {
        self.pass(deviation, sincos_short(self.frequency * t), exp_short(-(self.decay * t)))
    }

    #[inline(always)]
    fn advance_tiny(self, _: R, deviation: [R; 2], t: R) -> [R; 2] {
        self.pass(deviation, tiny(self.frequency * t), exp_tiny(-(self.decay * t)))
    }

    #[inline(always)]
    fn derivatives(self, frequency: R, [x, y]: [R; 2]) -> [R; 4] {
        let (square, v) = (frequency * frequency, frequency * y);
        let a = square * x + self.drag * v;
        let j = square * v - self.drag * a;
        [v, a, j, square * a + self.drag * j]
    }

    #[inline(always)]
    fn stiffness(self, _: R) -> R {
        self.stiffness
    }

    #[inline(always)]
    fn frequency(self, _: R) -> R {
        self.frequency
    }

    #[inline(always)]
    fn decay_rate(self, _: R) -> R {
        self.decay
    }
}
