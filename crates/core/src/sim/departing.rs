//! Motion segments: one ends, and the next begins under the loads from the current instant on.

use super::plant::Exerted;
use super::{Simulation, SimulationError};
use crate::record::Record;
use crate::time::Instant;

impl Simulation {
    /// Begins a motion segment under the loads from the current instant on, and finds its first guard crossing.
    pub(super) fn depart(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let now = self.now;
        self.plant.tell_course(now, &self.exerted, record)?;
        self.average(record)?;
        self.exposures.drop_copy();
        self.measure_course(now);
        let (actuator, axes) = (&self.drive.actuator, self.beliefs.len());
        if self.estimates {
            let moment = |axis: usize| if axis < axes { actuator.moment(axis) } else { 0.0 };
            self.estimator.given(now, [0, 1, 2].map(moment));
        }
        if axes == 1 {
            let (constant, feedback) = (actuator.torque(0), actuator.asked(0));
            self.exerted = Exerted { constant, feedback, back_emf: actuator.back_emf() };
        }
        if let Some(monitor) = &mut self.monitor {
            let commanded = || self.drive.commanded(now);
            self.plant.push_monitor(monitor, now, self.exerted.constant, commanded);
        }
        self.plant.depart(self.drive.wrench(now));
        self.measure_torque();
        self.seek(record)
    }

    /// Finds the first guard crossing of the segment that begins.
    pub(super) fn seek(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        self.trip = None;
        // With a sampled sensor, guards are checked at the samples.
        if self.sensing.next.is_none() && !self.laws.guards().is_empty() {
            let ends = [self.laws.until(), self.drive.due].into_iter().flatten().fold(self.end, Instant::min);
            self.trip = self.plant.trip(self.laws.guards(), ends.since(self.now), record)?;
        }
        Ok(())
    }
}
