//! The loop of plain runs: a law that decides at events, about a body in closed form, with nothing beside it but windows of the
//! envelope.
//!
//! It does what the loop of all runs does, in the same order, and leaves out what comes to nothing there.

use super::plant::{Exerted, Plant};
use super::{MOST_DECISIONS, Simulation, SimulationError};
use crate::belief::Belief;
use crate::estimator::Estimator;
use crate::law::{Command, Event};
use crate::record::Record;
use crate::scenario::Scenario;
use crate::sensor::Sensor;
use crate::time::{Instant, Span};

/// Whether runs of a scenario are plain.
pub fn is_plain(scenario: &Scenario) -> bool {
    let observes = |estimator: &Estimator| estimator.envelope().is_some();
    scenario.axis_count() == 1
        && scenario.linear.is_none()
        && scenario.chain.is_none()
        && scenario.drift.is_none()
        && scenario.plan.is_none()
        && scenario.disturbance.is_empty()
        && scenario.environment.is_none()
        && scenario.study.sampling.is_none()
        && scenario.actuator.is_ideal()
        && !scenario.has_own_parts()
        && scenario.sensor.iter().all(|sensor| matches!(sensor, Sensor::Continuous))
        && scenario.estimator.as_ref().is_none_or(observes)
}

impl Simulation {
    /// Runs as far as an instant, as long as nothing is due that is not plain.
    pub(super) fn run_plainly(
        &mut self,
        until: Instant,
        record: &mut impl Record,
    ) -> Result<(), SimulationError> {
        let is_idle = self.telling.due().is_none()
            && self.telling.scene.is_none()
            && self.drive.due.is_none()
            && self.sensing.next.is_none()
            && self.next_target.is_none()
            && self.meter.is_none()
            && self.read.is_none()
            && !(self.met || self.steered || self.laws.are_steered());
        if !(self.plain && is_idle) {
            return Ok(());
        }
        let run = self.go_plainly(until, record);
        let rigid = if let Plant::Planar(plant) = &self.plant { plant.state().rigid_rate } else { 0.0 };
        self.drive.command(self.now, self.laws.commands(), &self.beliefs, [rigid, 0.0, 0.0]);
        run
    }

    fn go_plainly(&mut self, until: Instant, record: &mut impl Record) -> Result<(), SimulationError> {
        let last = until.min(self.end);
        loop {
            let closes = self.monitor.as_ref().map(|monitor| monitor.closes);
            let trip = self.trip.map(|(at, _)| at);
            let due = [trip, self.laws.until(), closes];
            let next = due.into_iter().flatten().fold(self.end + Span::TICK, Instant::min);
            if next > last {
                return Ok(());
            }
            record.poll()?;
            if next > self.now {
                self.now = next;
                self.decisions = 0;
            }
            let event = match self.trip {
                Some((at, guard)) if at == next => Event::Guard(guard),
                _ => Event::Due { sampled: false },
            };
            if closes == Some(next) {
                self.close_window(record)?;
            }
            if matches!(event, Event::Guard(_)) || self.laws.until() == Some(next) {
                self.decide_plainly(event, record)?;
            }
        }
    }

    fn decide_plainly(&mut self, event: Event, record: &mut impl Record) -> Result<(), SimulationError> {
        let now = self.now;
        self.decisions += 1;
        if self.decisions > MOST_DECISIONS {
            return Err(SimulationError::Chatter { at: now, count: self.decisions });
        }
        let Plant::Planar(plant) = &mut self.plant else { return Ok(()) };
        let sensed = plant.view(now);
        if !(sensed.angle.is_finite() && sensed.rate.is_finite()) {
            return Err(SimulationError::NonFinite { at: now });
        }
        for Belief { angle, rate, .. } in &mut self.beliefs {
            (*angle, *rate) = (sensed.angle, sensed.rate);
        }
        let before = self.laws.about(0).state();
        let cause = self.ask(event);
        let Command::Torque(torque) = self.laws.commands()[0] else { return Ok(()) };
        let Plant::Planar(plant) = &mut self.plant else { return Ok(()) };
        plant.tell_course(now, &self.exerted, record)?;
        self.exerted = Exerted { constant: torque, feedback: torque, back_emf: (0.0, false) };
        if let Some(monitor) = &mut self.monitor {
            monitor.command(now, plant.state(), torque);
        }
        // As a sum of torques has no negative zero.
        plant.depart_under(0.0 + torque);
        let guards = self.laws.guards();
        self.trip = if guards.is_empty() {
            None
        } else {
            let ends = self.laws.until().map_or(self.end, |until| until.min(self.end));
            plant.trip(guards, ends.since(now), record)?
        };
        self.tell_switching(before, cause, [sensed.angle, sensed.rate], torque, record)
    }
}
