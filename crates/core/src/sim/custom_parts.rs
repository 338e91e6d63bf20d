//! Custom parts in a run: a run ends when one of them fails.

use flexsc_control::estimator::{AdaptationRun, ObjectiveMeter, WindowedEnvelope};

use super::{Simulation, SimulationError};

impl Simulation {
    /// Fails if a custom part cannot go on.
    #[inline]
    pub(super) fn check_custom_parts(&self) -> Result<(), SimulationError> {
        if !self.has_custom_parts {
            return Ok(());
        }
        let halted = || {
            let monitored = self.monitor.as_ref().and_then(WindowedEnvelope::search);
            let search = monitored.or(self.meter.as_ref().map(ObjectiveMeter::search));
            let adaptation = search.and_then(AdaptationRun::halted);
            let all = [
                ("sensor", self.sensors.halted()),
                ("estimator", self.estimator.failure()),
                ("adaptation", adaptation),
                ("law", self.controllers.halted()),
                ("actuator", self.loads.actuator.failure()),
            ];
            all.into_iter().find_map(|(role, halt)| Some((role, halt?)))
        };
        match halted() {
            Some((role, source)) => Err(SimulationError::Own { at: self.now, role, source }),
            None => Ok(()),
        }
    }
}
