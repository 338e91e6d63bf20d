//! From sensor samples to state estimates, with angles counted from the current target.

use flexsc_control::actuator::PulsedActuator;
use flexsc_control::estimator::SampleContext;
use flexsc_numerics::time::Instant;
use flexsc_record::Record;

use super::{Simulation, SimulationError};

impl Simulation {
    /// Reads the sensors that are due and updates the estimates.
    pub(super) fn update_estimates(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let now = self.now;
        self.plant.evaluate(now)?;
        let measured = self.sample_read_ahead.take().unwrap_or_else(|| self.read_sensors());
        let (plant, origin, actuator) = (&self.plant, &self.angle_origin, &self.loads.actuator);
        let abilities = actuator.capabilities();
        let mut waveform_impulse = 0.0;
        if self.sensors.next.is_some() {
            let (from, to) = (self.inputs_known_until.seconds(), now.seconds());
            waveform_impulse = abilities.waveform.map_or(0.0, |of| of.waveform_impulse(from, to));
            self.inputs_known_until = now;
        }
        let taken = SampleContext {
            now,
            measured: measured.then_some(&self.sensors.measured[..]),
            readings: &self.sensors.new_readings,
            origin,
            truth: &|axis| plant.about_axis(axis, origin),
            held_torque: &|axis| actuator.effort(axis).held,
            pulses: abilities.pulses,
            waveform_impulse,
            ahead: self.controllers.lead_time(),
        };
        self.estimator.update(&taken, &mut self.estimates);
        if let Some(changes) = self.sensors.field_rate {
            self.estimates
                .iter_mut()
                .zip(&changes)
                .for_each(|(state_estimate, change)| state_estimate.field_rate = *change);
        }
        let queued = abilities.pulses.map_or([0.0; 3], PulsedActuator::queued_rate_change);
        for (state_estimate, queued) in self.estimates.iter_mut().zip(queued) {
            state_estimate.queued_rate = queued;
        }
        self.record_estimates(record)
    }

    /// Moves the origin of the angles to the current target, and shifts the estimates accordingly.
    #[inline]
    pub(super) fn update_angle_origin(&mut self, now: Instant) {
        if self.next_origin_change.is_none_or(|begins| now < begins) {
            return;
        }
        let origin = self.guidance.origin(now);
        let by = self.angle_origin.error_from(&origin);
        self.estimator.shift_origin(by);
        for (axis, state_estimate) in self.estimates.iter_mut().enumerate() {
            state_estimate.angle += by[axis];
        }
        self.angle_origin = origin;
        self.next_origin_change = self.guidance.next_change(now);
    }
}
