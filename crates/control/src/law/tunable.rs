//! Parameters of a law that an adaptation may tune.

use std::borrow::Cow;
use std::ops::{Bound, RangeBounds};

use flexsc_numerics::quantity::{Fraction, NonNegative, Positive};

/// Parameter of a law that may be tuned.
#[derive(Clone, Debug, PartialEq)]
pub struct Tunable {
    /// Key of the parameter within the law's kind, as in a scenario.
    pub key: Cow<'static, str>,
    /// Initial value.
    pub value: f64,
    /// Range of valid values.
    pub range: (Bound<f64>, Bound<f64>),
}

impl Tunable {
    /// Creates a parameter without bounds.
    pub fn unbounded(key: impl Into<Cow<'static, str>>, value: f64) -> Self {
        Self { key: key.into(), value, range: (Bound::Unbounded, Bound::Unbounded) }
    }

    /// Creates a parameter that is at least 0.
    pub fn not_negative(key: impl Into<Cow<'static, str>>, value: NonNegative) -> Self {
        Self { range: (Bound::Included(0.0), Bound::Unbounded), ..Self::unbounded(key, value.get()) }
    }

    /// Creates a parameter above 0.
    pub fn positive(key: impl Into<Cow<'static, str>>, value: Positive) -> Self {
        Self::unbounded(key, value.get()).with_lower(0.0)
    }

    /// Creates a parameter between 0 and 1.
    pub fn fraction(key: impl Into<Cow<'static, str>>, value: Fraction) -> Self {
        Self::unbounded(key, value.get()).with_lower(0.0).with_upper(1.0)
    }

    /// Returns the parameter with a lower limit, exclusive.
    #[must_use]
    pub fn with_lower(self, limit: f64) -> Self {
        Self { range: (Bound::Excluded(limit), self.range.1), ..self }
    }

    /// Returns the parameter with an upper limit, exclusive.
    #[must_use]
    pub fn with_upper(self, limit: f64) -> Self {
        Self { range: (self.range.0, Bound::Excluded(limit)), ..self }
    }

    /// Returns the parameter with a key prefix, for a law within another.
    #[must_use]
    pub fn nested(self, place: &str) -> Self {
        Self { key: format!("{place}{}", self.key).into(), ..self }
    }

    /// Checks bounds [low, high] of the parameter; returns the reason if they are invalid.
    pub fn validate_bounds(&self, [low, high]: [f64; 2]) -> Option<String> {
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

/// Tuned parameters of a law at run time, the last one first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TunedNumbers(Vec<(&'static str, f64)>);

impl TunedNumbers {
    /// Returns the tuned value of a parameter, or the one written in the scenario.
    pub fn value_or(&self, key: &str, written: f64) -> f64 {
        self.0.iter().find(|(known, _)| *known == key).map_or(written, |(_, value)| *value)
    }

    /// Sets a parameter, if it is one of `known`.
    pub fn set(&mut self, key: &str, value: f64, known: &[&'static str]) {
        let Some(key) = known.iter().copied().find(|known| *known == key) else { return };
        self.0.retain(|(other, _)| *other != key);
        self.0.insert(0, (key, value));
    }

    /// Returns the value of the parameter tuned last, if any.
    pub fn last_set(&self) -> Option<f64> {
        self.0.first().map(|(_, value)| *value)
    }
}
