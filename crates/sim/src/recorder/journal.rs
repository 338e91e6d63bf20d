//! Journal: a log in sentences of the events of a run.

use flexsc_control::adaptation::Decision;
use flexsc_numerics::time::Instant;
use flexsc_record::foxglove::{Log, LogLevel};
use flexsc_record::row::LogDate;
use flexsc_record::{Record, RecordError, Sample};

use flexsc_scenario::Scenario;

/// Writer of journal lines with absolute dates.
#[derive(Copy, Clone, Debug)]
pub struct Journal {
    epoch_ns: u64,
}

impl Journal {
    /// Creates the journal of a scenario's runs.
    pub fn new(scenario: &Scenario) -> Self {
        Self { epoch_ns: scenario.epoch_ns() }
    }

    /// Writes a line with a level, in the name of a part of the loop.
    pub fn write_line(
        self,
        now: Instant,
        (level, name): (LogLevel, &str),
        message: String,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        if !record.wants_journal() {
            return Ok(());
        }
        let timestamp = self.date_of(now);
        record.record(now, Sample::Row(&Log { timestamp, level, message, name: name.to_owned() }))
    }

    /// Returns the date of an instant.
    pub fn date_of(self, now: Instant) -> LogDate {
        LogDate(self.epoch_ns + now.nanoseconds())
    }
}

/// Returns the first line of a run's journal.
pub fn opening(scenario: &Scenario, run: u64) -> String {
    format!("{}: {} s, seed {}, run {run}", scenario.name, scenario.duration.seconds(), scenario.seed)
}

/// Returns the journal line of an adaptation step, with the gain before it and after it.
pub fn adaptation_line(window: u64, decision: Decision, before: f64, gain: f64) -> String {
    let why = match decision {
        Decision::Begin => "the search begins",
        Decision::Keep => "the mean fell",
        Decision::Ignore => "the mean rose once, which is ignored",
        Decision::Turn => "the mean rose, the search turns",
        Decision::Freeze => return format!("window {window}: the mean is settled, gain frozen at {gain:.5}"),
    };
    format!("window {window}: {why}, gain {before:.5} -> {gain:.5}")
}
