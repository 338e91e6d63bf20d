//! Stick and slip events of wheels with bearing friction: detection of chatter, update of their drives, and records.

use super::plant::{Plant, SpatialPlant};
use super::{MOST_DECISIONS, Simulation, SimulationError};
use crate::motion::turning::SlippedRotor;
use crate::record::{self, Command, Record, Sample};
use crate::time::Instant;

impl Simulation {
    /// Counts an event at `at` at which a wheel sticks or lets go; fails if such events chatter.
    pub(super) fn slips(&mut self, at: Instant) -> Result<(), SimulationError> {
        let (count, since) = &mut self.slips;
        if at.since(*since).seconds() > 1e-9 {
            (*count, *since) = (0, at);
        }
        *count += 1;
        if *count > MOST_DECISIONS {
            return Err(SimulationError::WheelChatter { at, count: *count });
        }
        self.met = true;
        Ok(())
    }

    /// Copies the speeds and momenta of wheels in bearings from the motion into the actuator.
    pub(super) fn turned(&mut self, now: Instant) {
        let turned = self.plant.borne();
        if !turned.is_empty() {
            self.drive.actuator.turned(now, &turned);
        }
    }

    /// Returns the bearing rows of the wheels; `None` without bearings.
    pub(super) fn bearings(&self, plant: &SpatialPlant) -> Option<record::Bearings> {
        let of = |(wheel, known_rad_s): (SlippedRotor, f64)| record::BearingMotion {
            sliding: wheel.slip.into(),
            friction_nm: wheel.friction,
            heat_j: wheel.heat,
            known_rad_s,
        };
        let wheels: Vec<_> =
            plant.borne().into_iter().zip(self.drive.actuator.known_speeds()).map(of).collect();
        (!wheels.is_empty()).then_some(record::Bearings { wheels })
    }

    /// Initialises the slip states of the wheels at the start, to detect changes.
    pub(super) fn tell_first_slips(&mut self) {
        if let Plant::Spatial(plant) = &self.plant {
            self.telling.slips = plant.slips().to_vec();
        }
    }

    /// Records the wheels whose slip state has changed since the last instant: passes through zero speed, sticking,
    /// slipping again.
    pub(super) fn tell_slips(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let (Plant::Spatial(plant), now) = (&self.plant, self.now) else { return Ok(()) };
        let slips = plant.slips();
        if self.telling.slips == slips {
            return Ok(());
        }
        let before = std::mem::replace(&mut self.telling.slips, slips.to_vec());
        let wheels = self.drive.actuator.wheels(now, [0.0; 3]);
        let (time_s, time_whole_s, time_fs) = Command::times(now);
        for (index, (before, after)) in before.iter().zip(plant.slips()).enumerate() {
            if before == after {
                continue;
            }
            let event = record::WheelEvent {
                time_s,
                time_whole_s,
                time_fs,
                wheel: index as u64,
                before: (*before).into(),
                after: (*after).into(),
                torque_nm: wheels.get(index).map_or(0.0, |wheel| wheel.torque_nm),
            };
            record.record(now, Sample::WheelEvent(&event))?;
            self.telling.events.slipped(now, &event, record)?;
        }
        Ok(())
    }
}
