//! Stick and slip events of wheels with bearing friction: detection of chatter, update of their drives, and records.

use flexsc_control::actuator::ActuatorInput;
use flexsc_numerics::time::Instant;
use flexsc_record::{self, Command, Record, Sample};

use super::plant::Plant;
use super::{MOST_DECISIONS, Simulation, SimulationError};

impl Simulation {
    /// Counts an event at `at` at which a wheel sticks or lets go; fails if such events chatter.
    pub(super) fn handle_bearing_event(&mut self, at: Instant) -> Result<(), SimulationError> {
        let (count, since) = &mut self.recent_bearing_events;
        if at.since(*since).seconds() > 1e-9 {
            (*count, *since) = (0, at);
        }
        *count += 1;
        if *count > MOST_DECISIONS {
            return Err(SimulationError::WheelChatter { at, count: *count });
        }
        self.bearing_event = true;
        Ok(())
    }

    /// Copies the speeds and momenta of wheels in bearings from the motion into the actuator.
    pub(super) fn update_rotor_states(&mut self, now: Instant) {
        let turned = self.plant.wheel_bearings();
        if !turned.is_empty() {
            self.loads.actuator.update(now, ActuatorInput::Rotors(&turned));
        }
    }

    /// Initialises the slip states of the wheels at the start, to detect changes.
    pub(super) fn record_initial_bearings(&mut self) {
        if let Plant::ThreeAxis(plant) = &self.plant {
            self.recorder.recorded_slips = plant.bearing_states().to_vec();
        }
    }

    /// Records the wheels whose slip state has changed since the last instant: passes through zero speed, sticking,
    /// slipping again.
    pub(super) fn record_bearing_events(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let (Plant::ThreeAxis(plant), now) = (&self.plant, self.now) else { return Ok(()) };
        let slips = plant.bearing_states();
        if self.recorder.recorded_slips == slips {
            return Ok(());
        }
        let before = std::mem::replace(&mut self.recorder.recorded_slips, slips.to_vec());
        let wheels = self.loads.actuator.capabilities().wheels(now, [0.0; 3]);
        let (time_s, time_whole_s, time_fs) = Command::times(now);
        for (index, (before, after)) in before.iter().zip(plant.bearing_states()).enumerate() {
            if before == after {
                continue;
            }
            let event = flexsc_record::WheelEvent {
                time_s,
                time_whole_s,
                time_fs,
                wheel: index as u64,
                before: (*before).into(),
                after: (*after).into(),
                torque_nm: wheels.get(index).map_or(0.0, |wheel| wheel.torque_nm),
            };
            record.record(now, Sample::Row(&event))?;
            self.recorder.events.bearing_changed(now, &event, record)?;
        }
        Ok(())
    }
}
