//! How a mode moves on about its equilibrium, undamped or below critical damping: the same arithmetic for one number and for lanes.
//!
//! A mode is damped or not by its type, so that an undamped one costs no more where others are damped.

#![allow(clippy::inline_always, reason = "inside functions with a target feature nothing else is inlined")]

use std::fmt::Debug;

use crate::lanes::Real;
use crate::numerics::decay::{exp, exp_short};
use crate::numerics::trig::{sincos, sincos_short};

/// Below this angle (rad) a turn is a polynomial of order 5, exact to rounding.
pub const TINY: f64 = 3e-3;

/// What damping does to a mode, whose deviation is its displacement from equilibrium and its rate divided by the frequency (rad).
pub trait Damping<R: Real>: Copy + Debug {
    /// Whether modes of this kind may be damped.
    const IS_DAMPED: bool;

    /// None; `kind` only says of which kind numbers are.
    fn none(kind: R) -> Self;

    /// Other than before in one lane: that of a mode of this frequency (rad/s) and damping ratio.
    #[must_use]
    fn with_lane(self, lane: usize, frequency: f64, ratio: f64) -> Self;

    /// The deviation after a time (s).
    fn go(self, frequency: R, deviation: [R; 2], t: R) -> [R; 2];

    /// The same after at most 3/4 of a radian, forwards or back.
    fn go_short(self, frequency: R, deviation: [R; 2], t: R) -> [R; 2];

    /// The same after less than [`TINY`].
    fn go_tiny(self, frequency: R, deviation: [R; 2], t: R) -> [R; 2];

    /// Of the displacement x: x', -x'', -x''' and x''''.
    fn derivatives(self, frequency: R, deviation: [R; 2]) -> [R; 4];

    /// Bound of |x''| for a unit distance from equilibrium (1/s²).
    fn stiffness(self, frequency: R) -> R;

    /// The frequency of the motion (rad/s).
    fn turning(self, frequency: R) -> R;

    /// The decay rate (1/s); `kind` only says of which kind numbers are.
    fn decay(self, kind: R) -> R;
}

/// No damping.
#[derive(Copy, Clone, Debug, Default)]
pub struct Undamped;

/// Damping below the critical one, or none.
#[derive(Copy, Clone, Debug)]
pub struct Damped<R> {
    /// The decay rate, zeta w (1/s).
    pub decay: R,
    /// The damped frequency, w sqrt(1 - zeta²) (rad/s).
    pub frequency: R,
    /// zeta/sqrt(1 - zeta²).
    pub tilt: R,
    /// 1/sqrt(1 - zeta²).
    pub stretch: R,
    /// Twice the decay rate.
    pub drag: R,
    /// Bound of |x''| for a unit distance from equilibrium (1/s²).
    pub stiffness: R,
}

impl Damped<f64> {
    /// The damping of a mode of this frequency (rad/s) and damping ratio below 1.
    pub fn new(frequency: f64, ratio: f64) -> Self {
        let root = f64::sqrt((1.0 - ratio) * (1.0 + ratio));
        Self {
            decay: ratio * frequency,
            frequency: frequency * root,
            tilt: ratio / root,
            stretch: 1.0 / root,
            drag: 2.0 * ratio * frequency,
            // x'' = -w² (x + 2 zeta y) in (x, y) of length 1.
            stiffness: frequency * frequency * f64::sqrt(1.0 + 4.0 * ratio * ratio),
        }
    }
}

impl<R: Real> Damped<R> {
    /// The 2 x 2 transition matrix of the deviation, row by row, by sine and cosine of the damped turn and by what is left of a
    /// unit.
    #[inline(always)]
    pub fn transition(&self, (sin, cos): (R, R), left: R) -> [R; 4] {
        let (c, s) = (left * cos, left * sin);
        let (along, across) = (self.tilt * s, self.stretch * s);
        [c + along, across, -across, c - along]
    }

    #[inline(always)]
    fn pass(&self, [x, y]: [R; 2], turn: (R, R), left: R) -> [R; 2] {
        let [xx, xy, yx, yy] = self.transition(turn, left);
        [xx * x + xy * y, yx * x + yy * y]
    }
}

/// Sine and cosine of an angle below [`TINY`].
#[inline(always)]
fn tiny<R: Real>(x: R) -> (R, R) {
    let z = x * x;
    let (sixth, half) = (x.of(1.0 / 6.0), x.of(0.5));
    let sin = x - x * z * (sixth - z * x.of(1.0 / 120.0));
    (sin, x.of(1.0) - z * (half - z * x.of(1.0 / 24.0)))
}

/// The exponential of a number below [`TINY`].
#[inline(always)]
fn exp_tiny<R: Real>(x: R) -> R {
    let rest = x.of(1.0 / 6.0) + x * (x.of(1.0 / 24.0) + x * x.of(1.0 / 120.0));
    x.of(1.0) + (x + x * x * (x.of(0.5) + x * rest))
}

#[inline(always)]
fn turned<R: Real>([x, y]: [R; 2], (sin, cos): (R, R)) -> [R; 2] {
    [cos * x + sin * y, cos * y - sin * x]
}

impl<R: Real> Damping<R> for Undamped {
    const IS_DAMPED: bool = false;

    #[inline(always)]
    fn none(_: R) -> Self {
        Self
    }

    #[inline(always)]
    fn with_lane(self, _: usize, _: f64, _: f64) -> Self {
        self
    }

    #[inline(always)]
    fn go(self, frequency: R, deviation: [R; 2], t: R) -> [R; 2] {
        turned(deviation, sincos(frequency * t))
    }

    #[inline(always)]
    fn go_short(self, frequency: R, deviation: [R; 2], t: R) -> [R; 2] {
        turned(deviation, sincos_short(frequency * t))
    }

    #[inline(always)]
    fn go_tiny(self, frequency: R, deviation: [R; 2], t: R) -> [R; 2] {
        turned(deviation, tiny(frequency * t))
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
    fn turning(self, frequency: R) -> R {
        frequency
    }

    #[inline(always)]
    fn decay(self, kind: R) -> R {
        kind.of(0.0)
    }
}

impl<R: Real> Damping<R> for Damped<R> {
    const IS_DAMPED: bool = true;

    #[inline(always)]
    fn none(kind: R) -> Self {
        let (zero, one) = (kind.of(0.0), kind.of(1.0));
        Self { decay: zero, frequency: one, tilt: zero, stretch: one, drag: zero, stiffness: one }
    }

    #[inline(always)]
    fn with_lane(self, lane: usize, frequency: f64, ratio: f64) -> Self {
        let of = Damped::new(frequency, ratio);
        Self {
            decay: self.decay.with_lane(lane, of.decay),
            frequency: self.frequency.with_lane(lane, of.frequency),
            tilt: self.tilt.with_lane(lane, of.tilt),
            stretch: self.stretch.with_lane(lane, of.stretch),
            drag: self.drag.with_lane(lane, of.drag),
            stiffness: self.stiffness.with_lane(lane, of.stiffness),
        }
    }

    #[inline(always)]
    fn go(self, _: R, deviation: [R; 2], t: R) -> [R; 2] {
        self.pass(deviation, sincos(self.frequency * t), exp(-(self.decay * t)))
    }

    #[inline(always)]
    fn go_short(self, _: R, deviation: [R; 2], t: R) -> [R; 2] {
        self.pass(deviation, sincos_short(self.frequency * t), exp_short(-(self.decay * t)))
    }

    #[inline(always)]
    fn go_tiny(self, _: R, deviation: [R; 2], t: R) -> [R; 2] {
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
    fn turning(self, _: R) -> R {
        self.frequency
    }

    #[inline(always)]
    fn decay(self, _: R) -> R {
        self.decay
    }
}
