//! Wheels in bearings: when they come to rest or let go, and what their drives know of it.

use super::{MOST_DECISIONS, Simulation, SimulationError};
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
}
