//! Begin and end of sensor and actuator failures, for log and journal.

use flexsc_numerics::time::Instant;
use flexsc_record::foxglove::LogLevel;
use flexsc_record::{Command, FaultEvent, Onset, Record, RecordError, Sample};

use super::journal_events::JournalEvents;
use flexsc_scenario::{FailureInterval, Scenario};

/// Pending beginnings and ends of failures, latest first.
#[derive(Clone, Debug)]
pub struct Failures(Vec<(Instant, Onset, FailureInterval)>);

impl Failures {
    /// Creates the beginnings and ends of a scenario's failures.
    pub fn new(scenario: &Scenario) -> Self {
        let mut edges = Vec::new();
        for failing in scenario.failures() {
            edges.push((failing.interval.start(), Onset::Begins, failing.clone()));
            edges.extend(failing.interval.end().map(|ends| (ends, Onset::Ends, failing)));
        }
        // Events at one instant keep the order of the scenario.
        edges.reverse();
        edges.sort_by_key(|edge| std::cmp::Reverse(edge.0));
        Self(edges)
    }

    /// Returns the next instant at which a failure begins or ends.
    pub fn due(&self) -> Option<Instant> {
        self.0.last().map(|(at, ..)| *at)
    }

    /// Removes and returns the next failure that begins or ends by `now`.
    fn next(&mut self, now: Instant) -> Option<(Onset, FailureInterval)> {
        let (_, onset, failing) = self.0.pop_if(|(at, ..)| *at <= now)?;
        Some((onset, failing))
    }

    /// Records the failures that begin or end by `now`.
    pub fn record_due(
        &mut self,
        now: Instant,
        journal: &JournalEvents,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        while let Some((onset, FailureInterval { part, of, fault, .. })) = self.next(now) {
            let (time_s, time_whole_s, time_fs) = Command::times(now);
            let whose = if of.is_empty() { String::new() } else { format!("{of}: ") };
            let (level, line) = match onset {
                Onset::Begins => (LogLevel::Warning, format!("{whose}`{fault}` begins")),
                Onset::Ends => (LogLevel::Info, format!("{whose}`{fault}` ends")),
            };
            let event = FaultEvent {
                time_s,
                time_whole_s,
                time_fs,
                part: part.clone(),
                of,
                fault: fault.to_owned(),
                onset,
            };
            record.record(now, Sample::Row(&event))?;
            journal.failure_changed(now, (level, &part), line, record)?;
        }
        Ok(())
    }
}
