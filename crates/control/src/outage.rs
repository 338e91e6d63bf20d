//! Interval of time: from a start to an end, or to the end of the run.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::document::Fault;
use crate::quantity::Time;
use crate::time::{Instant, Span};

/// The interval of a failure.
#[derive(Copy, Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Outage {
    /// Start time (s).
    pub from: Time,
    /// End time (s); default: the end of the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<Time>,
}

impl Outage {
    /// Returns true if `now` is within the interval.
    pub fn lasts(self, now: Instant) -> bool {
        self.begins() <= now && self.ends().is_none_or(|ends| now < ends)
    }

    /// Returns the start of the interval.
    pub fn begins(self) -> Instant {
        at(self.from)
    }

    /// Returns the end of the interval; `None` if it lasts to the end of the run.
    pub fn ends(self) -> Option<Instant> {
        self.to.map(at)
    }

    /// Checks that the start is before the end; returns a `Fault` without a key if not.
    pub fn disorder(self) -> Option<Fault> {
        let unordered = self.to.is_some_and(|to| self.from >= to);
        unordered.then(|| Fault::new("", "must have `from` before `to`"))
    }
}

fn at(time: Time) -> Instant {
    Instant::START + Span::from_seconds(time.get())
}
