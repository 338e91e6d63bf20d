//! Control step: the laws that an event concerns decide once, and the actuator executes their commands.

use flexsc_control::law::{DecisionCause, Event};
use flexsc_record::Record;

use super::{MOST_DECISIONS, Simulation, SimulationError};
use crate::relay_setup::SWITCHINGS;

impl Simulation {
    /// Asks the laws that an event concerns; returns the cause of a switching.
    pub(super) fn ask_laws(&mut self, event: Event) -> Option<DecisionCause> {
        let Self { guidance: reference, now, controllers: laws, estimates: state_estimates, .. } = self;
        if laws.is_external() {
            return None;
        }
        if state_estimates.len() > 1 {
            let square: f64 = state_estimates
                .iter()
                .map(|state_estimate| state_estimate.angle * state_estimate.angle)
                .sum();
            for state_estimate in state_estimates.iter_mut() {
                state_estimate.total_angle = f64::sqrt(square);
            }
        }
        let led = reference.reference_motion(*now, state_estimates);
        laws.decide(
            *now,
            event,
            |axis, law| reference.setpoint_for(law, *now, led.map(|led| led[axis])),
            state_estimates,
        )
    }

    /// Counts a switching, and refuses to go on with a law that switches without end.
    fn has_switched(&mut self) -> Result<(), SimulationError> {
        let (count, since) = &mut self.switchings;
        *count += 1;
        if *count < SWITCHINGS {
            return Ok(());
        }
        let lasted = self.now.since(*since).seconds();
        (*count, *since) = (0, self.now);
        if lasted >= self.shortest_window {
            return Ok(());
        }
        Err(SimulationError::LawChatter { at: self.now, count: SWITCHINGS, span: self.shortest_window })
    }

    /// Lets the laws decide on `event`, and begins a motion segment under their commands.
    pub(super) fn control_step(
        &mut self,
        event: Event,
        record: &mut dyn Record,
    ) -> Result<(), SimulationError> {
        let now = self.now;
        self.external_command_pending = false;
        self.decisions_at_now += 1;
        if self.decisions_at_now > MOST_DECISIONS {
            return Err(SimulationError::Chatter { at: now, count: self.decisions_at_now });
        }
        self.plant.evaluate(now)?;
        self.update_angle_origin(now);
        if self.sensors.next.is_none() {
            // A continuous sensor gives the true state.
            let truth = self.plant.truth();
            let angles = truth.orientation.rotated_by(truth.sensor_angles()).error_from(&self.angle_origin);
            for (axis, state_estimate) in self.estimates.iter_mut().enumerate() {
                (state_estimate.angle, state_estimate.rate) = (angles[axis], truth.rate[axis]);
            }
        } else {
            self.estimator.predict(now, &self.angle_origin, &mut self.estimates);
        }
        let before = self.controllers.about(0).state().phase;
        let states = self.states();
        let cause = self.ask_laws(event);
        self.count_switchings(states);
        if !matches!(cause, Some(DecisionCause::Start) | None)
            && self.controllers.about(0).state().phase != before
        {
            self.has_switched()?;
        }
        self.set_magnetic_field();
        let truth = self.plant.truth();
        let sensed = [truth.sensor_angles()[0], truth.rate[0]];
        self.loads.command(now, self.controllers.outputs(), &self.estimates, truth.rigid);
        self.begin_segment(record)?;
        self.record_switching(before, cause, sensed, record)
    }
}
