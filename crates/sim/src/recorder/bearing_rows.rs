//! Rows of the instants at which wheels with bearing friction stick, slip or pass through zero speed.

use flexsc_dynamics::three_axis::SlipDirection;
use flexsc_record::{Command, Record, RecordError, Sample, WheelEvent};

use super::journal_events::JournalEvents;
use crate::plant::Plant;
use crate::run_view::RunView;

/// Slip states of the wheels as last recorded.
#[derive(Clone, Debug, Default)]
pub struct BearingRows(Vec<SlipDirection>);

impl BearingRows {
    /// Initialises the slip states at the start, to detect changes.
    pub fn begin(&mut self, plant: &Plant) {
        self.0 = plant.slip_states().to_vec();
    }

    /// Records the wheels whose slip state has changed since the last instant: passes through zero speed, sticking,
    /// slipping again.
    #[inline]
    pub fn record_events(
        &mut self,
        run: &RunView<'_>,
        journal: &JournalEvents,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        if self.0.is_empty() {
            return Ok(());
        }
        let slips = run.plant.slip_states();
        if self.0 == slips {
            return Ok(());
        }
        let before = std::mem::replace(&mut self.0, slips.to_vec());
        let wheels = run.loads.actuator.capabilities().wheels(run.now, [0.0; 3]);
        let (time_s, time_whole_s, time_fs) = Command::times(run.now);
        for (index, (before, after)) in before.iter().zip(slips).enumerate() {
            if before == after {
                continue;
            }
            let event = WheelEvent {
                time_s,
                time_whole_s,
                time_fs,
                wheel: index as u64,
                before: (*before).into(),
                after: (*after).into(),
                torque_nm: wheels.get(index).map_or(0.0, |wheel| wheel.torque_nm),
            };
            record.record(run.now, Sample::Row(&event))?;
            journal.bearing_changed(run.now, &event, record)?;
        }
        Ok(())
    }
}
