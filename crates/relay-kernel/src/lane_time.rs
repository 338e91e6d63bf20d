//! Instants in SIMD lanes: whole seconds and femtoseconds, both as whole numbers that doubles represent exactly.

#![allow(clippy::inline_always, reason = "inside functions with a target feature nothing else is inlined")]

use flexsc_numerics::lanes::LaneFloat;

/// Number of femtoseconds in a second.
const FEMTOSECONDS: f64 = 1e15;
/// Length (s) below which spans are counted in femtoseconds.
const SHORT: f64 = 9_000.0;

/// Instant, or span that is not negative.
#[derive(Copy, Clone, Debug)]
pub struct LaneTime<R> {
    /// Whole seconds.
    pub whole: R,
    /// Femtoseconds past `whole`, less than a second.
    pub part: R,
}

impl<R: LaneFloat> LaneTime<R> {
    /// Creates a span from femtoseconds, below 9000 s.
    #[inline(always)]
    pub fn from_ticks(ticks: R) -> Self {
        let whole = (ticks / ticks.splat(FEMTOSECONDS)).round();
        let part = ticks - whole * FEMTOSECONDS;
        let borrow = one(part.lt(ticks.splat(0.0)), part);
        Self { whole: whole - borrow, part: part + borrow * FEMTOSECONDS }
    }

    /// Returns the instant a span later.
    #[inline(always)]
    pub fn add(self, span: Self) -> Self {
        let part = self.part + span.part;
        let carry = one(part.splat(FEMTOSECONDS).le(part), part);
        Self { whole: (self.whole + span.whole) + carry, part: part - carry * FEMTOSECONDS }
    }

    /// Returns the span since an instant that is not later.
    #[inline(always)]
    pub fn since(self, earlier: Self) -> Self {
        let part = self.part - earlier.part;
        let borrow = one(part.lt(part.splat(0.0)), part);
        Self { whole: (self.whole - earlier.whole) - borrow, part: part + borrow * FEMTOSECONDS }
    }

    /// Returns the time in seconds, rounded as spans and instants are.
    #[inline(always)]
    pub fn seconds(self) -> R {
        let short = self.whole.lt(self.whole.splat(SHORT));
        let ticks = R::select(short, self.whole * FEMTOSECONDS + self.part, self.part);
        R::select(short, self.whole.splat(0.0), self.whole) + ticks / ticks.splat(FEMTOSECONDS)
    }

    /// Returns the lanes in which the instant is not later than another.
    #[inline(always)]
    pub fn is_at_or_before(self, other: Self) -> R::Mask {
        let same = self.whole.le(other.whole) & other.whole.le(self.whole);
        self.whole.lt(other.whole) | (same & self.part.le(other.part))
    }

    /// Selects one of two instants per lane.
    #[inline(always)]
    pub fn select(mask: R::Mask, chosen: Self, otherwise: Self) -> Self {
        Self {
            whole: R::select(mask, chosen.whole, otherwise.whole),
            part: R::select(mask, chosen.part, otherwise.part),
        }
    }

    /// Returns the instant in one lane, as whole numbers.
    #[inline(always)]
    pub fn lane(self, lane: usize) -> (u64, u64) {
        (self.whole.lane(lane) as u64, self.part.lane(lane) as u64)
    }

    /// Replaces the instant in one lane.
    #[inline(always)]
    pub fn with_lane(self, lane: usize, (whole, part): (u64, u64)) -> Self {
        Self { whole: self.whole.with_lane(lane, whole as f64), part: self.part.with_lane(lane, part as f64) }
    }
}

/// Returns 1 where the mask is set, else 0. Products with it are exact, and avoid mispredicted branches for a single
/// number.
#[inline(always)]
fn one<R: LaneFloat>(mask: R::Mask, kind: R) -> R {
    R::select(mask, kind.splat(1.0), kind.splat(0.0))
}

/// Returns the femtoseconds nearest to a time (s) that is not negative; ties are rounded up.
#[inline(always)]
pub fn nearest_ticks<R: LaneFloat>(seconds: R) -> R {
    let ticks = seconds * FEMTOSECONDS;
    // All numbers from 2^52 on are integers.
    let all = ticks.splat(4_503_599_627_370_496.0);
    let even = (ticks + all) - all;
    let rounded = R::select((ticks - even).lt(ticks.splat(0.5)), even, even + 1.0);
    R::select(ticks.lt(all), rounded, ticks)
}
