//! Wheels in bearings: when they come to rest or let go, what their drives know of it, and what is told of it.

use super::plant::{Plant, SpatialPlant};
use super::{MOST_DECISIONS, Simulation, SimulationError};
use crate::motion::turning::SlippedRotor;
use crate::record::{self, Command, Record, Sample};
use crate::time::Instant;

impl Simulation {
    /// A wheel comes to rest or lets go at an instant.
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

    /// Wheels in bearings are as the motion has them.
    pub(super) fn turned(&mut self, now: Instant) {
        let turned = self.plant.borne();
        if !turned.is_empty() {
            self.drive.actuator.turned(now, &turned);
        }
    }

    /// The bearings of wheels, if they have any.
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

    /// How wheels slip at the start.
    pub(super) fn tell_first_slips(&mut self) {
        if let Plant::Spatial(plant) = &self.plant {
            self.telling.slips = plant.slips().to_vec();
        }
    }

    /// What wheels do otherwise than at the last instant: they pass through zero speed, stick, or slip again.
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
