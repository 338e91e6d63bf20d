//! Record of the pulses that an actuator has applied about each axis since the last sample.

use flexsc_numerics::time::Instant;

use super::adaptive::Pulse;
use crate::actuator::PulsedActuator;

/// Pulses applied about each axis since the last sample.
#[derive(Clone, Debug, Default)]
pub struct AppliedPulses {
    moments: [f64; 3],
    since: Instant,
    /// Start of the record: the last sample.
    began: Instant,
    pulses: Vec<Pulse>,
}

impl AppliedPulses {
    /// Sets the reduced moments (rad/s²) that act from `now` on.
    pub fn input_changed(&mut self, now: Instant, moments: [f64; 3]) {
        if now > self.since && self.moments != [0.0; 3] {
            let duration = now.since(self.since).seconds();
            let start = self.since.since(self.began).seconds();
            let pulse = |(input, acceleration)| Pulse { input, acceleration, start, duration };
            let accelerations =
                self.moments.into_iter().enumerate().filter(|(_, acceleration)| *acceleration != 0.0);
            self.pulses.extend(accelerations.map(pulse));
        }
        (self.moments, self.since) = (moments, now);
    }

    /// Returns the pulses since the last sample and starts a new record at `now`; those of jets have exactly their
    /// commanded lengths.
    pub fn take_executed(&mut self, now: Instant, jets: Option<&dyn PulsedActuator>) -> Vec<Pulse> {
        self.input_changed(now, self.moments);
        self.began = now;
        let recorded = std::mem::take(&mut self.pulses);
        jets.and_then(PulsedActuator::executed_pulses).unwrap_or(recorded)
    }
}
