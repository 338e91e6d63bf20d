//! Simulated time: an integer count of femtoseconds, so that instants compare exactly.

use std::borrow::Cow;
use std::fmt;
use std::ops::{Add, AddAssign, Sub};

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

const FEMTOSECONDS: i128 = 1_000_000_000_000_000;
const FEMTOSECONDS_F64: f64 = 1e15;
/// The longest span that a scenario may name: 300 000 years.
const LONGEST_S: f64 = 1e13;

/// An instant of simulated time, counted from the start of the run.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Instant(i128);

/// A length of simulated time.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Span(i128);

fn seconds(femtoseconds: i128) -> f64 {
    // The conversion from 64 bits is one instruction, from 128 bits a call.
    if let Ok(short) = i64::try_from(femtoseconds) {
        short as f64 / FEMTOSECONDS_F64
    } else {
        femtoseconds as f64 / FEMTOSECONDS_F64
    }
}

/// Whole seconds and what is left, so that long spans keep their ticks.
fn split(seconds: f64) -> (f64, f64) {
    let whole = libm::trunc(seconds);
    (whole, seconds - whole)
}

impl Instant {
    /// The start of every run.
    pub const START: Self = Self(0);

    /// The instant in seconds, rounded to the nearest double.
    pub fn seconds(self) -> f64 {
        seconds(self.0)
    }

    /// Whole seconds, and the femtoseconds past them: the instant without rounding.
    pub fn parts(self) -> (u64, u64) {
        ((self.0 / FEMTOSECONDS) as u64, (self.0 % FEMTOSECONDS) as u64)
    }

    /// The instant in nanoseconds, rounded down: the time base of logs.
    pub fn nanoseconds(self) -> u64 {
        (self.0 / 1_000_000) as u64
    }

    /// The span since an earlier instant.
    pub fn since(self, earlier: Self) -> Span {
        Span(self.0 - earlier.0)
    }
}

impl Span {
    /// No time at all.
    pub const ZERO: Self = Self(0);
    /// The shortest span there is.
    pub const TICK: Self = Self(1);

    /// The span nearest to a number of seconds.
    pub fn from_seconds(seconds: f64) -> Self {
        let (whole, part) = if seconds.abs() < 9e3 { (0.0, seconds) } else { split(seconds) };
        let ticks = libm::round(part * FEMTOSECONDS_F64) as i64;
        Self(whole as i128 * FEMTOSECONDS + i128::from(ticks))
    }

    /// The longest span that is not above a number of seconds.
    pub fn from_seconds_down(seconds: f64) -> Self {
        // A cast truncates, which for a positive number rounds down.
        let (whole, part) = if seconds < 9e3 { (0.0, seconds) } else { split(seconds) };
        Self(whole as i128 * FEMTOSECONDS + i128::from((part * FEMTOSECONDS_F64) as i64))
    }

    /// The span in seconds, rounded to the nearest double.
    pub fn seconds(self) -> f64 {
        seconds(self.0)
    }

    /// How often the span fits into a longer one.
    pub fn count_in(self, longer: Self) -> u64 {
        (longer.0 / self.0) as u64
    }
}

impl Add<Span> for Instant {
    type Output = Self;
    fn add(self, span: Span) -> Self {
        Self(self.0 + span.0)
    }
}

impl AddAssign<Span> for Instant {
    fn add_assign(&mut self, span: Span) {
        self.0 += span.0;
    }
}

impl Add for Span {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl Sub for Span {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }
}

impl fmt::Display for Instant {
    /// Seconds with all 15 decimals.
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
    }
}
