//! The numbers of a law that an adaptation may tune.

use std::borrow::Cow;
use std::ops::{Bound, RangeBounds};

use crate::quantity::{Fraction, NonNegative, Positive};

/// A number of a law that may be tuned.
#[derive(Clone, Debug, PartialEq)]
pub struct Tunable {
    /// Its key within the law's kind, as a scenario writes it.
    pub key: Cow<'static, str>,
    /// Its value at the start.
    pub value: f64,
    /// Which values it may have.
    pub range: (Bound<f64>, Bound<f64>),
}

impl Tunable {
    /// A number that may have any value.
    pub fn free(key: impl Into<Cow<'static, str>>, value: f64) -> Self {
        Self { key: key.into(), value, range: (Bound::Unbounded, Bound::Unbounded) }
    }

    /// A number that is at least 0.
    pub fn not_negative(key: impl Into<Cow<'static, str>>, value: NonNegative) -> Self {
        Self { range: (Bound::Included(0.0), Bound::Unbounded), ..Self::free(key, value.get()) }
    }

    /// A number above 0.
    pub fn positive(key: impl Into<Cow<'static, str>>, value: Positive) -> Self {
        Self::free(key, value.get()).above(0.0)
    }

    /// A number between 0 and 1.
    pub fn fraction(key: impl Into<Cow<'static, str>>, value: Fraction) -> Self {
        Self::free(key, value.get()).above(0.0).below(1.0)
    }

    /// The same with values above a limit alone.
    #[must_use]
    pub fn above(self, limit: f64) -> Self {
        Self { range: (Bound::Excluded(limit), self.range.1), ..self }
    }

    /// The same with values below a limit alone.
    #[must_use]
    pub fn below(self, limit: f64) -> Self {
        Self { range: (self.range.0, Bound::Excluded(limit)), ..self }
    }

    /// The same of a law within another.
    #[must_use]
    pub fn within(self, place: &str) -> Self {
        Self { key: format!("{place}{}", self.key).into(), ..self }
    }

    /// Why bounds [low, high] are none of this number, if they are not.
    pub fn refuses(&self, [low, high]: [f64; 2]) -> Option<String> {
        if self.range.contains(&low) && self.range.contains(&high) {
            return None;
        }
        let allowed = match self.range {
            (Bound::Excluded(from), Bound::Excluded(to)) => format!("lie between {from} and {to}"),
            (Bound::Excluded(from), _) => format!("be above {from}"),
            (Bound::Included(from), _) => format!("be at least {from}"),
            (Bound::Unbounded, Bound::Excluded(to) | Bound::Included(to)) => format!("be below {to}"),
            (Bound::Unbounded, Bound::Unbounded) => "be numbers".to_owned(),
        };
        Some(format!("must {allowed}, as {} itself, got [{low}, {high}]", self.key))
    }
}

/// The numbers of a law at work as they have been tuned, the last first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TunedNumbers(Vec<(&'static str, f64)>);

impl TunedNumbers {
    /// A number, which has another value before it is tuned.
    pub fn of(&self, key: &str, written: f64) -> f64 {
        self.0.iter().find(|(known, _)| *known == key).map_or(written, |(_, value)| *value)
    }

    /// Takes a number over, if it is one of these.
    pub fn take(&mut self, key: &str, value: f64, known: &[&'static str]) {
        let Some(key) = known.iter().copied().find(|known| *known == key) else { return };
        self.0.retain(|(other, _)| *other != key);
        self.0.insert(0, (key, value));
    }

    /// The value of the number that was tuned last, if any was.
    pub fn last(&self) -> Option<f64> {
        self.0.first().map(|(_, value)| *value)
    }
}
