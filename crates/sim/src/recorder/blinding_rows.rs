//! Rows of the instants at which bright bodies begin and cease to blind star trackers.

use flexsc_record::foxglove::LogLevel;
use flexsc_record::{BlindingEvent, Command, Onset, Record, RecordError, Sample};

use super::journal_events::JournalEvents;
use crate::blinding::BlindingState;
use crate::run_view::RunView;
use flexsc_scenario::Scenario;

/// States of the exclusion angles as last recorded.
#[derive(Clone, Debug)]
pub struct BlindingRows {
    /// Key of each sensor.
    keys: Vec<String>,
    last: Vec<BlindingState>,
}

impl BlindingRows {
    /// Creates the rows of a scenario's run, in which nothing is recorded yet.
    pub fn new(scenario: &Scenario) -> Self {
        let keys = (0..scenario.sensor.len()).map(|index| scenario.sensor_key(index)).collect();
        Self { keys, last: Vec::new() }
    }

    /// Records the changes since the last instant; at the start, the bodies that blind a star tracker from then on.
    #[inline]
    pub fn record_events(
        &mut self,
        run: &RunView<'_>,
        journal: &JournalEvents,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        if run.sensors.has_no_exclusion() {
            return Ok(());
        }
        self.record_changes(run, journal, record)
    }

    /// Records the exclusion angles whose state has changed.
    fn record_changes(
        &mut self,
        run: &RunView<'_>,
        journal: &JournalEvents,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        for (index, state) in run.sensors.blinding_states().enumerate() {
            let before = self.last.get(index).is_some_and(|last| last.is_blinded);
            if index < self.last.len() {
                self.last[index] = state;
            } else {
                self.last.push(state);
            }
            if before == state.is_blinded {
                continue;
            }
            let (time_s, time_whole_s, time_fs) = Command::times(run.now);
            let (body, onset) = (state.body.name(), Onset::from(state.is_blinded));
            let sensor = state.sensor as u64;
            let event = BlindingEvent { time_s, time_whole_s, time_fs, sensor, body: body.to_owned(), onset };
            record.record(run.now, Sample::Row(&event))?;
            let (level, line) = if state.is_blinded {
                (LogLevel::Warning, format!("{body}: blinds the star tracker"))
            } else {
                (LogLevel::Info, format!("{body}: no longer blinds the star tracker"))
            };
            let key = self.keys.get(state.sensor).map_or("sensor", String::as_str);
            journal.failure_changed(run.now, (level, key), line, record)?;
        }
        Ok(())
    }
}
