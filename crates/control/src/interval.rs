//! Interval of time: from a start to an end, or to the end of the run.

use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::Time;
use flexsc_numerics::time::{Instant, Span};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The interval of a failure.
#[derive(Copy, Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Outage")]
pub struct Interval {
    /// Start time (s).
    pub from: Time,
    /// End time (s); default: the end of the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<Time>,
}

impl Interval {
    /// Returns true if `now` is within the interval.
    pub fn contains(self, now: Instant) -> bool {
        self.start() <= now && self.end().is_none_or(|ends| now < ends)
    }

    /// Returns the start of the interval.
    pub fn start(self) -> Instant {
        at(self.from)
    }

    /// Returns the end of the interval; `None` if it lasts to the end of the run.
    pub fn end(self) -> Option<Instant> {
        self.to.map(at)
    }

    /// Checks that the start is before the end; returns a `ConfigError` without a key if not.
    pub fn validate(self) -> Option<ConfigError> {
        let unordered = self.to.is_some_and(|to| self.from >= to);
        unordered.then(|| ConfigError::new("", "must have `from` before `to`"))
    }
}

fn at(time: Time) -> Instant {
    Instant::START + Span::from_seconds(time.get())
}
