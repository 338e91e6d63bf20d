//! Simulated time: an integer count of femtoseconds, so that instants compare exactly.

use std::borrow::Cow;
use std::fmt;
use std::ops::{Add, AddAssign};

use flexsc_flight::ticks::Ticks;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

const FEMTOSECONDS: i64 = 1_000_000_000_000_000;
/// Limit in seconds below which spans fit 64 bits of femtoseconds.
const SHORT_S: i64 = 9_000;
/// Longest span that a scenario may specify (s): 300 000 years.
const LONGEST_S: f64 = 1e13;

/// Instant of simulated time, counted from the start of the run.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Instant(Ticks);

/// Length of simulated time.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Span(Ticks);

impl Instant {
    /// Start of every run.
    pub const START: Self = Self(Ticks { whole: 0, part: 0 });
    /// Instant beyond the end of every run.
    pub const END: Self = Self(Ticks { whole: i64::MAX, part: 0 });

    /// Returns the instant in seconds, rounded to a double.
    pub fn seconds(self) -> f64 {
        self.0.seconds()
    }

    /// Creates an instant from whole seconds and the femtoseconds past them, less than a second.
    pub fn from_parts(whole: u64, part: u64) -> Self {
        Self(Ticks { whole: whole as i64, part: part as i64 })
    }

    /// Returns whole seconds, and the femtoseconds past them: the instant without rounding.
    pub fn parts(self) -> (u64, u64) {
        (self.0.whole as u64, self.0.part as u64)
    }

    /// Returns the instant in femtoseconds, without rounding.
    pub fn femtoseconds(self) -> u128 {
        let (whole, part) = self.parts();
        u128::from(whole) * FEMTOSECONDS as u128 + u128::from(part)
    }

    /// Creates the instant of a time that flight code counts.
    pub fn from_ticks(ticks: Ticks) -> Self {
        Self(ticks)
    }

    /// Returns the instant as flight code counts it.
    #[inline]
    pub fn ticks(self) -> Ticks {
        self.0
    }

    /// Returns the instant in nanoseconds, rounded down: the time base of logs.
    pub fn nanoseconds(self) -> u64 {
        self.0.whole as u64 * 1_000_000_000 + self.0.part as u64 / 1_000_000
    }

    /// Returns the instant a span earlier.
    #[must_use]
    pub fn before(self, span: Span) -> Self {
        Self(self.0.since(span.0))
    }

    /// Returns the span since an earlier instant.
    #[inline]
    pub fn since(self, earlier: Self) -> Span {
        Span(self.0.since(earlier.0))
    }
}

/// Returns the earlier of two instants, each of which may be absent.
#[inline]
pub fn earlier(one: Option<Instant>, other: Option<Instant>) -> Option<Instant> {
    match (one, other) {
        (Some(one), Some(other)) => Some(one.min(other)),
        (one, other) => one.or(other),
    }
}

impl Span {
    /// Span of length zero.
    pub const ZERO: Self = Self(Ticks { whole: 0, part: 0 });
    /// Shortest span, one femtosecond.
    pub const TICK: Self = Self(Ticks { whole: 0, part: 1 });

    /// Returns the span nearest to a number of seconds.
    #[inline]
    pub fn from_seconds(seconds: f64) -> Self {
        Self(Ticks::from_seconds(seconds))
    }

    /// Returns the span as flight code counts it.
    #[inline]
    pub fn ticks(self) -> Ticks {
        self.0
    }

    /// Creates a span from femtoseconds.
    #[inline]
    pub fn from_femtoseconds(femtoseconds: i64) -> Self {
        Self(Ticks::from_femtoseconds(femtoseconds))
    }

    /// Returns the femtoseconds of the span, or of its first 9000 s.
    pub fn leading_femtoseconds(self) -> i64 {
        let Ticks { whole, part } = self.0;
        if whole < SHORT_S { whole * FEMTOSECONDS + part } else { SHORT_S * FEMTOSECONDS }
    }

    /// Returns the difference of the span and another.
    #[must_use]
    pub fn remaining_after(self, other: Self) -> Self {
        Self(self.0.since(other.0))
    }

    /// Returns the span in seconds, rounded to a double.
    #[inline]
    pub fn seconds(self) -> f64 {
        self.0.seconds()
    }
}

impl Add<Span> for Instant {
    type Output = Self;
    fn add(self, span: Span) -> Self {
        Self(self.0.plus(span.0))
    }
}

impl AddAssign<Span> for Instant {
    fn add_assign(&mut self, span: Span) {
        *self = *self + span;
    }
}

impl Add for Span {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0.plus(other.0))
    }
}

impl fmt::Display for Instant {
    /// Formats seconds with all 15 decimals.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (whole, femtoseconds) = self.parts();
        write!(f, "{whole}.{femtoseconds:015}")
    }
}

impl Serialize for Span {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_f64(Span::seconds(*self))
    }
}

impl<'de> Deserialize<'de> for Span {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let seconds = f64::deserialize(deserializer)?;
        let span = Span::from_seconds(if seconds.is_finite() { seconds } else { 0.0 });
        if span <= Span::ZERO || seconds > LONGEST_S {
            return Err(serde::de::Error::custom(format!(
                "must be a time of 1e-15 s to {LONGEST_S:e} s, got {seconds}"
            )));
        }
        Ok(span)
    }
}

impl JsonSchema for Span {
    fn schema_name() -> Cow<'static, str> {
        "Span".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({"type": "number", "exclusiveMinimum": 0, "maximum": LONGEST_S})
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimal_periods_coincide_exactly() {
        let mut fast = Instant::START;
        for _ in 0..1000 {
            fast += Span::from_seconds(0.1);
        }
        assert_eq!(fast, Instant::START + Span::from_seconds(100.0));
        assert_eq!(fast.to_string(), "100.000000000000000");
    }

    #[test]
    fn spans_of_years_keep_their_ticks() {
        let year = Span::from_seconds(31_557_600.0);
        let instant = Instant::START + year + Span::TICK;
        assert_eq!(instant.to_string(), "31557600.000000000000001");
        assert_eq!(instant.since(Instant::START + year), Span::TICK);
        assert_eq!(instant.nanoseconds(), 31_557_600_000_000_000);
    }

    #[test]
    fn sums_and_differences_carry() {
        let (a, b) = (Span::from_seconds(1.75), Span::from_seconds(2.5));
        assert_eq!(a + b, Span::from_seconds(4.25));
        let (early, late) = (Instant::START + a, Instant::START + b);
        assert_eq!(late.since(early), Span::from_seconds(0.75));
        assert_eq!(early.since(late).seconds(), -0.75);
        assert!(early < late && Span::ZERO < Span::TICK);
    }
}
