//! Fast prediction of the instant at which a guard trips, for undamped modes or damping below critical: predicted,
//! polished, and certified afterwards.
//!
//! The first prediction is that of the rigid parabola. One evaluation there gives four derivatives, whose reverted
//! series gives a step; the modes are advanced by it, and a second step ends at the trip. The result is certain if
//! bounds show, without another evaluation, that no guard tripped before; otherwise the certified search
//! ([`super::crossing`]) must decide. `docs/events.md` derives the bounds.

#![allow(clippy::inline_always, reason = "inside functions with a target feature nothing else is inlined")]

use flexsc_numerics::lanes::{LaneFloat, Mask};
use flexsc_numerics::trig::FARTHEST;

use crate::damping::{DampingRule, TINY, Undamped};

/// Femtoseconds in a second.
const TICKS: f64 = 1e15;
/// Time span (s) whose ticks fit in 64 bits.
const LONGEST: f64 = 9_000.0;
/// Longest step that polishes a prediction, in radians of the fastest mode.
pub const FARTHEST_TURN: f64 = 0.75;
/// Maximum number of steps that polish a prediction.
const ROUNDS: usize = 3;

/// Elastic mode: equilibrium, and deviation from it at one instant.
#[derive(Copy, Clone, Debug)]
pub struct PredictedMode<R, D = Undamped> {
    /// Natural frequency (rad/s).
    pub frequency: R,
    /// Equilibrium (rad).
    pub equilibrium: R,
    /// Displacement from equilibrium (rad).
    pub displacement: R,
    /// Rate divided by the frequency (rad).
    pub quadrature: R,
    /// Damping rule.
    pub damping: D,
}

/// Motion under a constant torque, at the start of its segment.
#[derive(Copy, Clone, Debug)]
pub struct SegmentStart<R> {
    /// Rigid angle (rad).
    pub angle: R,
    /// Rigid rate (rad/s).
    pub rate: R,
    /// Acceleration of the rigid angle (rad/s²).
    pub moment: R,
    /// Highest frequency of a mode (rad/s).
    pub fastest: R,
    /// Time in which the fastest mode advances by [`FARTHEST_TURN`] (s).
    pub longest: R,
}

/// Threshold of the angle that is monitored.
#[derive(Copy, Clone, Debug)]
pub struct PredictedLevel<R> {
    /// Threshold angle (rad).
    pub angle: R,
    /// Direction: 1 if the threshold is reached from below, -1 from above.
    pub towards: R,
}

/// Result of the prediction: the predicted trip.
#[derive(Copy, Clone, Debug)]
pub struct PredictedCrossing<R: LaneFloat> {
    /// True if this is certainly the first trip.
    pub certain: R::Mask,
    /// True if the first of two thresholds is reached.
    pub first: R::Mask,
    /// Time since the start of the segment (fs).
    pub ticks: R,
    /// Time since the start of the segment (s).
    pub after: R,
    /// Observation at the trip: angle (rad), rate (rad/s), acceleration (rad/s²).
    pub observation: [R; 3],
}

impl<R: LaneFloat, D: DampingRule<R>> PredictedMode<R, D> {
    /// Advances the mode by a time `t` (s).
    #[inline(always)]
    pub fn advance(&mut self, t: R) {
        let deviation = [self.displacement, self.quadrature];
        [self.displacement, self.quadrature] = self.damping.advance(self.frequency, deviation, t);
    }

    /// Advances the mode by `t` (s), for at most 3/4 rad of phase, forwards or backwards.
    #[inline(always)]
    fn advance_short(&mut self, t: R) {
        let deviation = [self.displacement, self.quadrature];
        [self.displacement, self.quadrature] = self.damping.advance_short(self.frequency, deviation, t);
    }

    /// Advances the mode by `t` (s), for a phase below [`TINY`].
    #[inline(always)]
    fn advance_tiny(&mut self, t: R) {
        let deviation = [self.displacement, self.quadrature];
        [self.displacement, self.quadrature] = self.damping.advance_tiny(self.frequency, deviation, t);
    }

    /// Returns a bound of the distance from equilibrium, at most 8 % above it, by an octagon.
    #[inline(always)]
    pub fn amplitude_bound(&self) -> R {
        let (x, y) = (self.displacement.abs(), self.quadrature.abs());
        let flat = x.splat(std::f64::consts::SQRT_2 - 1.0);
        x.max(y) + flat * x.min(y)
    }
}

/// Returns the angle and its derivatives at `t` (s) since the start of the segment; `modes` are those at that time.
#[inline(always)]
fn derivatives<R: LaneFloat, D: DampingRule<R>>(
    from: &SegmentStart<R>,
    t: R,
    modes: &[PredictedMode<R, D>],
) -> [R; 5] {
    let zero = t.splat(0.0);
    let mut angle = from.angle + t * (from.rate + t.splat(0.5) * from.moment * t);
    let mut rate = from.rate + from.moment * t;
    let (mut acceleration, mut jerk, mut snap) = (from.moment, zero, zero);
    for mode in modes {
        let x = mode.displacement;
        let [v, a, j, s] = mode.damping.derivatives(mode.frequency, [x, mode.quadrature]);
        angle = angle + (mode.equilibrium + x);
        rate = rate + v;
        acceleration = acceleration - a;
        jerk = jerk - j;
        snap = snap + s;
    }
    [angle, rate, acceleration, jerk, snap]
}

/// Returns the time to a threshold of the angle (s), by the reverted series of order 4.
#[inline(always)]
fn step<R: LaneFloat>(level: R, [angle, rate, acceleration, jerk, snap]: [R; 5]) -> R {
    let inverse = rate.splat(1.0) / rate;
    let e = (level - angle) * inverse;
    let a = rate.splat(0.5) * acceleration * inverse;
    let b = rate.splat(1.0 / 6.0) * jerk * inverse;
    let c = rate.splat(1.0 / 24.0) * snap * inverse;
    let square = a * a;
    let third = (square + square) - b;
    let fourth = rate.splat(5.0) * a * (b - square) - c;
    e + e * e * (e * (third + e * fourth) - a)
}

/// Returns the time at which the rigid parabola reaches a threshold (s), with the modes at equilibrium; infinite if
/// it does not.
#[inline(always)]
fn parabola<R: LaneFloat>(gap: R, speed: R, acceleration: R) -> R {
    let zero = gap.splat(0.0);
    let square = speed * speed + (gap + gap) * acceleration;
    let root = R::select(zero.lt(square), square, zero).sqrt();
    let below = speed + root;
    let reached = zero.le(square) & zero.lt(below) & zero.lt(gap);
    R::select(reached, (gap + gap) / below, gap.splat(f64::INFINITY))
}

/// Rounds a non-negative number up to an integer.
#[inline(always)]
fn above<R: LaneFloat>(x: R) -> R {
    // All numbers from 2^52 on are integers.
    let all = x.splat(4_503_599_627_370_496.0);
    let near = (x + all) - all;
    let up = R::select(near.lt(x), near + x.splat(1.0), near);
    R::select(x.lt(all), up, x)
}

/// Predicts the first trip of one of the thresholds; `modes` are those at the start of the segment, and at the trip
/// on return.
#[inline(always)]
pub fn predict<R: LaneFloat, D: DampingRule<R>, const LEVELS: usize>(
    from: &SegmentStart<R>,
    levels: &[PredictedLevel<R>; LEVELS],
    modes: &mut [PredictedMode<R, D>],
) -> PredictedCrossing<R> {
    let zero = from.angle.splat(0.0);
    let one = from.angle.splat(1.0);
    let (mut centre, mut reach, mut curvature) = (zero, zero, from.moment.abs());
    let (mut angle, mut rate) = (from.angle, from.rate);
    for mode in modes.iter() {
        let radius = mode.amplitude_bound();
        centre = centre + mode.equilibrium;
        reach = reach + radius;
        curvature = curvature + mode.damping.stiffness(mode.frequency) * radius;
        angle = angle + (mode.equilibrium + mode.displacement);
        rate = rate + mode.frequency * mode.quadrature;
    }
    // First prediction, for the threshold that the rigid parabola reaches first.
    let [mut level, mut guess] = [levels[0].angle, zero];
    let mut first = zero.le(one);
    for (index, threshold) in levels.iter().enumerate() {
        let gap = threshold.towards * (threshold.angle - (from.angle + centre));
        let gap_at = parabola(gap, threshold.towards * from.rate, threshold.towards * from.moment);
        if index == 0 {
            guess = gap_at;
        } else {
            first = guess.le(gap_at);
            level = R::select(first, level, threshold.angle);
            guess = R::select(first, guess, gap_at);
        }
    }
    let mut t = guess;
    for mode in modes.iter_mut() {
        mode.advance(t);
    }
    let mut change = step(level, derivatives(from, t, modes));
    let mut continuing = zero.le(one);
    for _ in 0..ROUNDS {
        // Steps longer than the polynomials allow are limited, which is rare.
        let most = from.longest;
        if !change.abs().le(most).all() {
            change = R::select(change.lt(-most), -most, R::select(most.lt(change), most, change));
        }
        // Lanes whose prediction is already polished do not move, whatever the other lanes do.
        let next = t + R::select(continuing, change, zero);
        let phase = next - t;
        t = next;
        for mode in modes.iter_mut() {
            mode.advance_short(phase);
        }
        change = step(level, derivatives(from, t, modes));
        continuing = zero.splat(TINY).lt((from.fastest * change).abs());
        if !continuing.any() {
            break;
        }
    }
    let ticks = above((t + change) * zero.splat(TICKS));
    let after = ticks / zero.splat(TICKS);
    let phase = after - t;
    for mode in modes.iter_mut() {
        mode.advance_tiny(phase);
    }
    let values = derivatives(from, after, modes);
    // The trip is polished if only rounding errors remain.
    let speed = values[1].abs();
    let rounding =
        zero.splat(1e-15) * (level.abs() + reach) + speed * (zero.splat(4e-15) + zero.splat(4e-16) * after);
    let mut certain = (level - values[0]).abs().le(rounding)
        & (from.fastest * phase).abs().lt(zero.splat(TINY + 1e-9))
        & after.lt(zero.splat(LONGEST))
        & (from.fastest * guess).lt(zero.splat(FARTHEST))
        & zero.le(ticks);
    // Both sides of each inequality are multiplied by the bound of |x''|, or by its square.
    for (index, threshold) in levels.iter().enumerate() {
        let is_it = if index == 0 { first } else { !first };
        let closing = threshold.towards * values[1];
        let until = curvature * after - R::select(is_it, closing + closing, zero);
        let until = R::select(zero.lt(until), until, zero);
        let half = zero.splat(0.5) * until;
        let gap = threshold.towards * (threshold.angle - (from.angle + centre)) - reach;
        let (speed, acceleration) = (threshold.towards * from.rate, threshold.towards * from.moment);
        let end = curvature * (gap * curvature - speed * until) - acceleration * until * half;
        let crest = zero.le(acceleration)
            | speed.le(zero)
            | (-acceleration * until).le(speed * curvature)
            | (speed * speed).lt(-(gap + gap) * acceleration);
        let mut clear = (zero.lt(gap) & zero.lt(end) & crest) | (is_it & until.le(zero));
        if !clear.all() {
            let (gap, speed) = (threshold.towards * (threshold.angle - angle), threshold.towards * rate);
            clear = clear | (zero.lt(gap) & zero.lt(gap * curvature - (speed + half) * until));
        }
        certain = certain & clear;
    }
    PredictedCrossing { certain, first, ticks, after, observation: [values[0], values[1], values[2]] }
}
