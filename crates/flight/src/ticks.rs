//! Time as an exact integer: whole seconds and femtoseconds.

use crate::maths::{clamp, round, trunc};

const FEMTOSECONDS: i64 = 1_000_000_000_000_000;
const FEMTOSECONDS_F64: f64 = 1e15;
/// Limit in seconds below which spans fit 64 bits of femtoseconds.
const SHORT_S: i64 = 9_000;
const SHORT_S_F64: f64 = 9_000.0;
/// Limit of any span (s), a thousand times the longest run.
const FARTHEST_S: f64 = 1e16;

/// Time or span: whole seconds, plus 0 to 10^15 - 1 femtoseconds. Its operations stay within 64 bits.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Ticks {
    /// Whole seconds.
    pub whole: i64,
    /// Femtoseconds past the whole seconds, below 10^15.
    pub part: i64,
}

impl Ticks {
    /// Creates a time from femtoseconds since the start, at most 9 223 s.
    #[inline]
    pub fn from_femtoseconds(femtoseconds: i64) -> Self {
        Self { whole: femtoseconds.div_euclid(FEMTOSECONDS), part: femtoseconds.rem_euclid(FEMTOSECONDS) }
    }

    /// Returns the time nearest to a number of seconds below the limit of 64 bits.
    #[inline]
    fn nearest(seconds: f64) -> Self {
        Self::from_femtoseconds(round(seconds * FEMTOSECONDS_F64) as i64)
    }

    /// Returns the time nearest to a number of seconds.
    #[inline]
    pub fn from_seconds(seconds: f64) -> Self {
        if seconds.abs() < SHORT_S_F64 {
            return Self::nearest(seconds);
        }
        // Beyond this, sums would overflow.
        let bounded: f64 = clamp(seconds, -FARTHEST_S, FARTHEST_S);
        let whole: f64 = trunc(bounded);
        let rest: Self = Self::nearest(bounded - whole);
        Self { whole: whole as i64 + rest.whole, part: rest.part }
    }

    /// Returns the time in seconds, rounded to a double.
    #[inline]
    pub fn seconds(self) -> f64 {
        if self.whole > -SHORT_S && self.whole < SHORT_S {
            (self.whole * FEMTOSECONDS + self.part) as f64 / FEMTOSECONDS_F64
        } else {
            self.whole as f64 + self.part as f64 / FEMTOSECONDS_F64
        }
    }

    /// Returns the sum of two times.
    #[inline]
    pub fn plus(self, other: Self) -> Self {
        let part: i64 = self.part + other.part;
        let carry: i64 = i64::from(part >= FEMTOSECONDS);
        Self { whole: self.whole + other.whole + carry, part: part - carry * FEMTOSECONDS }
    }

    /// Returns the span from another time to this one.
    #[inline]
    pub fn since(self, other: Self) -> Self {
        let part: i64 = self.part - other.part;
        let borrow: i64 = i64::from(part < 0);
        Self { whole: self.whole - other.whole - borrow, part: part + borrow * FEMTOSECONDS }
    }

    /// Returns true if the time is earlier than another.
    #[inline]
    pub fn is_before(self, other: Self) -> bool {
        self.whole < other.whole || self.whole == other.whole && self.part < other.part
    }
}
