//! From sensor samples to state estimates, with angles counted from the current target.

use super::{Simulation, SimulationError};
use crate::estimator::Taken;
use crate::record::Record;
use crate::time::Instant;

impl Simulation {
    /// Reads the sensors that are due and updates the estimates.
    pub(super) fn sense(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let now = self.now;
        self.plant.view(now)?;
        let measured = self.read.take().unwrap_or_else(|| self.measure());
        if self.sensing.next.is_some() {
            let (from, to) = (self.given.seconds(), now.seconds());
            self.estimator.pushed(self.drive.actuator.waveform_impulse(from, to));
            self.given = now;
        }
        let (plant, origin) = (&self.plant, &self.origin);
        let taken = Taken {
            now,
            measured: measured.then_some(&self.sensing.measured[..]),
            readings: &self.sensing.fresh,
            origin,
            truth: &|axis| plant.about(axis, origin),
            actuator: &*self.drive.actuator,
            ahead: self.laws.ahead(),
        };
        self.estimator.take(&taken, &mut self.beliefs);
        if let Some(changes) = self.sensing.field_rate {
            self.beliefs.iter_mut().zip(&changes).for_each(|(belief, change)| belief.field_rate = *change);
        }
        for (belief, queued) in self.beliefs.iter_mut().zip(self.drive.actuator.queued()) {
            belief.queued = queued;
        }
        self.tell_estimates(record)
    }

    /// Moves the origin of the angles to the current target, and shifts the estimates accordingly.
    #[inline]
    pub(super) fn turn_to_target(&mut self, now: Instant) {
        if self.next_target.is_none_or(|begins| now < begins) {
            return;
        }
        let origin = self.reference.origin(now);
        let by = self.origin.beyond(&origin);
        self.estimator.shift(by);
        for (axis, belief) in self.beliefs.iter_mut().enumerate() {
            belief.angle += by[axis];
        }
        self.origin = origin;
        self.next_target = self.reference.next_target(now);
    }
}
