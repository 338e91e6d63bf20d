//! Custom parts in a run: a run ends when one of them fails.

use super::{Simulation, SimulationError};
use crate::estimator::{Meter, Monitor, Searching};

impl Simulation {
    /// Fails if a custom part cannot go on.
    #[inline]
    pub(super) fn check_own_parts(&self) -> Result<(), SimulationError> {
        if !self.own {
            return Ok(());
        }
        let halted = || {
            let monitored = self.monitor.as_ref().and_then(Monitor::search);
            let search = monitored.or(self.meter.as_ref().map(Meter::search));
            let adaptation = search.and_then(Searching::halted);
            let all = [
                ("sensor", self.sensing.halted()),
                ("estimator", self.estimator.halted()),
                ("adaptation", adaptation),
                ("law", self.laws.halted()),
                ("actuator", self.drive.actuator.halted()),
            ];
            all.into_iter().find_map(|(role, halt)| Some((role, halt?)))
        };
        match halted() {
            Some((role, source)) => Err(SimulationError::Own { at: self.now, role, source }),
            None => Ok(()),
        }
    }
}
