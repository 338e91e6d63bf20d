//! The instant at which a guard trips, of modes damped below critical damping or not at all: guessed, polished, and certified
//! afterwards.
//!
//! The guess is the rigid parabola. One evaluation there gives four derivatives, whose reverted series makes a step; the modes turn
//! by it, and a second step ends at the trip. What is found is certain if bounds show, without another evaluation, that nothing
//! tripped before; else the certified search ([`super::crossing`]) has to tell. `docs/events.md` derives the bounds.

#![allow(clippy::inline_always, reason = "inside functions with a target feature nothing else is inlined")]

use crate::damping::{Damping, TINY, Undamped};
use crate::lanes::{Mask, Real};
use crate::numerics::trig::FARTHEST;

/// Femtoseconds in a second.
const TICKS: f64 = 1e15;
/// Ticks of longer spans (s) do not fit 64 bits.
const LONGEST: f64 = 9_000.0;
/// No turn that polishes a guess is longer, in radians of the fastest mode.
pub const FARTHEST_TURN: f64 = 0.75;
/// Most turns that polish a guess.
const ROUNDS: usize = 3;

/// A mode: its equilibrium, and its deviation from it at one instant.
#[derive(Copy, Clone, Debug)]
pub struct GuessOscillator<R, D = Undamped> {
    /// Natural frequency (rad/s).
    pub frequency: R,
    /// Equilibrium (rad).
    pub equilibrium: R,
    /// Displacement from it (rad).
    pub displacement: R,
    /// Rate divided by the frequency (rad).
    pub quadrature: R,
    /// Its damping.
    pub damping: D,
}

/// A motion under a constant moment, from its departure on.
#[derive(Copy, Clone, Debug)]
pub struct Departure<R> {
    /// Rigid angle (rad).
    pub angle: R,
    /// Rigid rate (rad/s).
    pub rate: R,
    /// Acceleration of the rigid angle (rad/s²).
    pub moment: R,
    /// The highest frequency of a mode (rad/s).
    pub fastest: R,
    /// In how long that mode turns by [`FARTHEST_TURN`] (s).
    pub longest: R,
}

/// A level of the angle that is watched.
#[derive(Copy, Clone, Debug)]
pub struct GuessLevel<R> {
    /// The angle (rad).
    pub angle: R,
    /// 1 if it is reached from below, -1 from above.
    pub towards: R,
}

/// What is found.
#[derive(Copy, Clone, Debug)]
pub struct GuessedTrip<R: Real> {
    /// Whether it is certain to be the first trip.
    pub certain: R::Mask,
    /// Whether it is the first level that is reached, of two.
    pub first: R::Mask,
    /// The time since departure: femtoseconds, and seconds.
    pub ticks: R,
    /// The same in seconds.
    pub after: R,
    /// What is seen then: angle (rad), rate (rad/s), acceleration (rad/s²).
    pub seen: [R; 3],
}

impl<R: Real, D: Damping<R>> GuessOscillator<R, D> {
    /// Moves on by a time (s).
    #[inline(always)]
    pub fn go(&mut self, t: R) {
        let deviation = [self.displacement, self.quadrature];
        [self.displacement, self.quadrature] = self.damping.go(self.frequency, deviation, t);
    }

    /// The same by at most 3/4 of a radian, forwards or back.
    #[inline(always)]
    fn go_short(&mut self, t: R) {
        let deviation = [self.displacement, self.quadrature];
        [self.displacement, self.quadrature] = self.damping.go_short(self.frequency, deviation, t);
    }

    /// The same by less than [`TINY`].
    #[inline(always)]
    fn go_tiny(&mut self, t: R) {
        let deviation = [self.displacement, self.quadrature];
        [self.displacement, self.quadrature] = self.damping.go_tiny(self.frequency, deviation, t);
    }

    /// A bound of the distance from equilibrium, at most 8 % above it: an octagon's.
    #[inline(always)]
    pub fn reach(&self) -> R {
        let (x, y) = (self.displacement.abs(), self.quadrature.abs());
        let flat = x.of(std::f64::consts::SQRT_2 - 1.0);
        x.max(y) + flat * x.min(y)
    }
}

/// The angle and its derivatives `t` seconds after departure, where the modes are.
#[inline(always)]
fn derivatives<R: Real, D: Damping<R>>(from: &Departure<R>, t: R, modes: &[GuessOscillator<R, D>]) -> [R; 5] {
    let zero = t.of(0.0);
    let mut angle = from.angle + t * (from.rate + t.of(0.5) * from.moment * t);
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

/// The time to a level of the angle, by the reverted series of order 4.
#[inline(always)]
fn step<R: Real>(level: R, [angle, rate, acceleration, jerk, snap]: [R; 5]) -> R {
    let inverse = rate.of(1.0) / rate;
    let e = (level - angle) * inverse;
    let a = rate.of(0.5) * acceleration * inverse;
    let b = rate.of(1.0 / 6.0) * jerk * inverse;
    let c = rate.of(1.0 / 24.0) * snap * inverse;
    let square = a * a;
    let third = (square + square) - b;
    let fourth = rate.of(5.0) * a * (b - square) - c;
    e + e * e * (e * (third + e * fourth) - a)
}

/// The time at which the rigid parabola reaches a level (s), with the modes at rest; endless if it does not.
#[inline(always)]
fn parabola<R: Real>(gap: R, speed: R, acceleration: R) -> R {
    let zero = gap.of(0.0);
    let square = speed * speed + (gap + gap) * acceleration;
    let root = R::select(zero.lt(square), square, zero).sqrt();
    let below = speed + root;
    let reached = zero.le(square) & zero.lt(below) & zero.lt(gap);
    R::select(reached, (gap + gap) / below, gap.of(f64::INFINITY))
}

/// The next integer from a number that is not negative.
#[inline(always)]
fn above<R: Real>(x: R) -> R {
    // From 2^52 on all numbers are integers.
    let all = x.of(4_503_599_627_370_496.0);
    let near = (x + all) - all;
    let up = R::select(near.lt(x), near + x.of(1.0), near);
    R::select(x.lt(all), up, x)
}

/// The first trip of one of the levels, and the modes there. They are given at departure.
#[inline(always)]
pub fn locate<R: Real, D: Damping<R>, const LEVELS: usize>(
    from: &Departure<R>,
    levels: &[GuessLevel<R>; LEVELS],
    modes: &mut [GuessOscillator<R, D>],
) -> GuessedTrip<R> {
    let zero = from.angle.of(0.0);
    let one = from.angle.of(1.0);
    let (mut centre, mut reach, mut curvature) = (zero, zero, from.moment.abs());
    let (mut angle, mut rate) = (from.angle, from.rate);
    for mode in modes.iter() {
        let radius = mode.reach();
        centre = centre + mode.equilibrium;
        reach = reach + radius;
        curvature = curvature + mode.damping.stiffness(mode.frequency) * radius;
        angle = angle + (mode.equilibrium + mode.displacement);
        rate = rate + mode.frequency * mode.quadrature;
    }
    // The guess, of the level that the rigid parabola reaches first.
    let [mut level, mut guess] = [levels[0].angle, zero];
    let mut first = zero.le(one);
    for (index, of) in levels.iter().enumerate() {
        let gap = of.towards * (of.angle - (from.angle + centre));
        let at = parabola(gap, of.towards * from.rate, of.towards * from.moment);
        if index == 0 {
            guess = at;
        } else {
            first = guess.le(at);
            level = R::select(first, level, of.angle);
            guess = R::select(first, guess, at);
        }
    }
    let mut t = guess;
    for mode in modes.iter_mut() {
        mode.go(t);
    }
    let mut change = step(level, derivatives(from, t, modes));
    let mut goes_on = zero.le(one);
    for _ in 0..ROUNDS {
        // No turn by more than the polynomials take, which is rare.
        let most = from.longest;
        if !change.abs().le(most).all() {
            change = R::select(change.lt(-most), -most, R::select(most.lt(change), most, change));
        }
        // Where a guess is polished already, nothing turns, whatever the lanes beside it do.
        let next = t + R::select(goes_on, change, zero);
        let turned = next - t;
        t = next;
        for mode in modes.iter_mut() {
            mode.go_short(turned);
        }
        change = step(level, derivatives(from, t, modes));
        goes_on = zero.of(TINY).lt((from.fastest * change).abs());
        if !goes_on.any() {
            break;
        }
    }
    let ticks = above((t + change) * zero.of(TICKS));
    let after = ticks / zero.of(TICKS);
    let turned = after - t;
    for mode in modes.iter_mut() {
        mode.go_tiny(turned);
    }
    let seen = derivatives(from, after, modes);
    // The trip is polished if nothing but rounding is left.
    let speed = seen[1].abs();
    let rounding = zero.of(1e-15) * (level.abs() + reach) + speed * (zero.of(4e-15) + zero.of(4e-16) * after);
    let mut certain = (level - seen[0]).abs().le(rounding)
        & (from.fastest * turned).abs().lt(zero.of(TINY + 1e-9))
        & after.lt(zero.of(LONGEST))
        & (from.fastest * guess).lt(zero.of(FARTHEST))
        & zero.le(ticks);
    // Both sides of each inequality are multiplied by the bound of |x''|, or its square.
    for (index, of) in levels.iter().enumerate() {
        let is_it = if index == 0 { first } else { !first };
        let closing = of.towards * seen[1];
        let until = curvature * after - R::select(is_it, closing + closing, zero);
        let until = R::select(zero.lt(until), until, zero);
        let half = zero.of(0.5) * until;
        let gap = of.towards * (of.angle - (from.angle + centre)) - reach;
        let (speed, acceleration) = (of.towards * from.rate, of.towards * from.moment);
        let end = curvature * (gap * curvature - speed * until) - acceleration * until * half;
        let crest = zero.le(acceleration)
            | speed.le(zero)
            | (-acceleration * until).le(speed * curvature)
            | (speed * speed).lt(-(gap + gap) * acceleration);
        let mut clear = (zero.lt(gap) & zero.lt(end) & crest) | (is_it & until.le(zero));
        if !clear.all() {
            let (gap, speed) = (of.towards * (of.angle - angle), of.towards * rate);
            clear = clear | (zero.lt(gap) & zero.lt(gap * curvature - (speed + half) * until));
        }
        certain = certain & clear;
    }
    GuessedTrip { certain, first, ticks, after, seen: [seen[0], seen[1], seen[2]] }
}
