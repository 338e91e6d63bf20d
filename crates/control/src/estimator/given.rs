//! What an actuator has given about each axis since the last sample, pulse by pulse.

use super::adaptive::Pulse;
use crate::actuator::Actuate;
use crate::time::Instant;

/// The record of it.
#[derive(Clone, Debug, Default)]
pub struct GivenRecord {
    moments: [f64; 3],
    since: Instant,
    /// When the record began.
    began: Instant,
    pulses: Vec<Pulse>,
}

impl GivenRecord {
    /// Takes over the reduced moments (rad/s²) from now on.
    pub fn change(&mut self, now: Instant, moments: [f64; 3]) {
        if now > self.since && self.moments != [0.0; 3] {
            let duration = now.since(self.since).seconds();
            let start = self.since.since(self.began).seconds();
            let pulse = |(input, acceleration)| Pulse { input, acceleration, start, duration };
            let given = self.moments.into_iter().enumerate().filter(|(_, acceleration)| *acceleration != 0.0);
            self.pulses.extend(given.map(pulse));
        }
        (self.moments, self.since) = (moments, now);
    }

    /// The pulses since the last sample, which is now. Those of jets are as long as they were commanded, to the last bit.
    pub fn take(&mut self, now: Instant, actuator: &dyn Actuate) -> Vec<Pulse> {
        self.change(now, self.moments);
        self.began = now;
        let recorded = std::mem::take(&mut self.pulses);
        actuator.executed().unwrap_or(recorded)
    }
}
