//! The journal: what happened in a run, line by line, for people.

use crate::adaptation::Decision;
use crate::record::foxglove::{Log, LogLevel};
use crate::record::row::Stamp;
use crate::record::{Record, RecordError, Sample};
use crate::scenario::Scenario;
use crate::time::Instant;

/// Who writes lines: it knows the date of the start.
#[derive(Copy, Clone, Debug)]
pub struct Journal {
    epoch_ns: u64,
}

impl Journal {
    /// The journal of a scenario's runs.
    pub fn new(scenario: &Scenario) -> Self {
        Self { epoch_ns: scenario.epoch_ns() }
    }

    /// Writes a line in the name of a part of the loop.
    pub fn tell(
        self,
        now: Instant,
        (level, name): (LogLevel, &str),
        message: String,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        let timestamp = self.stamp(now);
        record.record(now, Sample::Log(&Log { timestamp, level, message, name: name.to_owned() }))
    }

    /// An instant as a date.
    pub fn stamp(self, now: Instant) -> Stamp {
        Stamp(self.epoch_ns + now.nanoseconds())
    }
}

/// The line with which a run begins.
pub fn opening(scenario: &Scenario, run: u64) -> String {
    format!("{}: {} s, seed {}, run {run}", scenario.name, scenario.duration.seconds(), scenario.seed)
}

/// The line of a step of the adaptation.
pub fn adapted(window: u64, decision: Decision, before: f64, gain: f64) -> String {
    let why = match decision {
        Decision::Begin => "the search begins",
        Decision::Keep => "the mean fell",
        Decision::Ignore => "the mean rose once, which is ignored",
        Decision::Turn => "the mean rose, the search turns",
        Decision::Freeze => return format!("window {window}: the mean is settled, gain frozen at {gain:.5}"),
    };
    format!("window {window}: {why}, gain {before:.5} -> {gain:.5}")
}
