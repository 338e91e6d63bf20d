//! Motion segments: one ends, and the next begins under the loads from the current instant on.

use flexsc_control::actuator::AxisEffort;
use flexsc_numerics::time::Instant;
use flexsc_record::Record;

use super::plant::AppliedTorque;
use super::{Simulation, SimulationError};

impl Simulation {
    /// Begins a motion segment under the loads from the current instant on, and finds its first guard crossing.
    pub(super) fn begin_segment(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let now = self.now;
        self.plant.record_pieces(now, &self.applied, record)?;
        self.accumulate_mean(record)?;
        self.exposures.discard_copy();
        self.add_motion(now);
        let (actuator, axes) = (&self.loads.actuator, self.estimates.len());
        if self.has_estimator {
            let moment = |axis: usize| if axis < axes { actuator.effort(axis).reduced_moment } else { 0.0 };
            self.estimator.input_changed(now, [0, 1, 2].map(moment));
        }
        if axes == 1 {
            let AxisEffort { held: constant, demanded: feedback, .. } = actuator.effort(0);
            let back_emf = actuator.capabilities().back_emf;
            self.applied = AppliedTorque { constant, feedback, back_emf };
        }
        if let Some(monitor) = &mut self.monitor {
            let commanded = || self.loads.actuator_wrench(now);
            self.plant.update_monitor(monitor, now, self.applied.constant, commanded);
        }
        self.plant.begin_segment(self.loads.wrench(now));
        self.add_torque();
        self.find_crossing(record)
    }

    /// Finds the first guard crossing of the segment that begins.
    pub(super) fn find_crossing(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        self.crossing = None;
        // With a sampled sensor, guards are checked at the samples.
        if self.sensors.next.is_none() && !self.controllers.guards().is_empty() {
            let ends = [self.controllers.next_timeout(), self.loads.due]
                .into_iter()
                .flatten()
                .fold(self.end, Instant::min);
            self.crossing = self.plant.crossing(self.controllers.guards(), ends.since(self.now), record)?;
        }
        Ok(())
    }
}
