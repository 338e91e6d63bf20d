//! Custom parts in a run: a run ends when one of them fails.

use flexsc_control::estimator::{AdaptationRun, ObjectiveMeter, WindowedEnvelope};
use flexsc_control::part::Part;

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
            let all: [(&str, Option<&dyn Part>); 5] = [
                ("sensor", Some(&self.sensors)),
                ("estimator", Some(&*self.estimator)),
                ("adaptation", search.map(AdaptationRun::part)),
                ("law", Some(&self.controllers)),
                ("actuator", Some(&*self.loads.actuator)),
            ];
            all.into_iter().find_map(|(role, part)| Some((role, part?.failure()?)))
        };
        match halted() {
            Some((role, source)) => Err(SimulationError::Own { at: self.now, role, source }),
            None => Ok(()),
        }
    }
}
