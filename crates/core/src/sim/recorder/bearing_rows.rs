//! Rows of wheels with bearing friction: their motion, and the instants at which they stick, slip or pass through zero
//! speed.

use flexsc_dynamics::three_axis::{RotorObservation, SlipDirection};
use flexsc_record::{BearingMotion, Bearings, Command, Record, RecordError, Sample, WheelEvent};

use super::journal_events::JournalEvents;
use crate::sim::plant::Plant;
use crate::sim::run_view::RunView;

/// Slip states of the wheels as last recorded.
#[derive(Clone, Debug, Default)]
pub struct BearingRows(Vec<SlipDirection>);

impl BearingRows {
    /// Initialises the slip states at the start, to detect changes.
    pub fn begin(&mut self, plant: &Plant) {
        if let Plant::ThreeAxis(plant) = plant {
            self.0 = plant.bearing_states().to_vec();
        }
    }

    /// Records the wheels whose slip state has changed since the last instant: passes through zero speed, sticking,
    /// slipping again.
    pub fn record_events(
        &mut self,
        run: &RunView<'_>,
        journal: &JournalEvents,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        let Plant::ThreeAxis(plant) = run.plant else { return Ok(()) };
        let slips = plant.bearing_states();
        if self.0 == slips {
            return Ok(());
        }
        let before = std::mem::replace(&mut self.0, slips.to_vec());
        let wheels = run.loads.actuator.wheels(run.now, [0.0; 3]);
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
            record.record(run.now, Sample::WheelEvent(&event))?;
            journal.bearing_changed(run.now, &event, record)?;
        }
        Ok(())
    }
}

/// Returns the bearing rows of the wheels; `None` without bearings.
pub fn bearing_rows(run: &RunView<'_>) -> Option<Bearings> {
    let motion = |(wheel, known_rad_s): (RotorObservation, f64)| BearingMotion {
        sliding: wheel.slip.into(),
        friction_nm: wheel.friction,
        heat_j: wheel.heat,
        known_rad_s,
    };
    let known = run.loads.actuator.measured_wheel_speeds();
    let wheels: Vec<_> = run.plant.wheel_bearings().into_iter().zip(known).map(motion).collect();
    (!wheels.is_empty()).then_some(Bearings { wheels })
}
