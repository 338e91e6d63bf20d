//! Control step: the laws that an event concerns decide once, and the actuator executes their commands.

use super::{MOST_DECISIONS, Simulation, SimulationError};
use crate::flight::SWITCHINGS;
use crate::law::{Cause, Event};
use crate::record::Record;

impl Simulation {
    /// Asks the laws that an event concerns; returns the cause of a switching.
    pub(super) fn ask(&mut self, event: Event) -> Option<Cause> {
        let Self { reference, now, laws, beliefs, .. } = self;
        if laws.are_steered() {
            return None;
        }
        if beliefs.len() > 1 {
            let square: f64 = beliefs.iter().map(|belief| belief.angle * belief.angle).sum();
            for belief in beliefs.iter_mut() {
                belief.whole = f64::sqrt(square);
            }
        }
        let led = reference.led(*now, beliefs);
        laws.decide(*now, event, |axis, law| reference.aim(law, *now, led.map(|led| led[axis])), beliefs)
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
    pub(super) fn decide(&mut self, event: Event, record: &mut dyn Record) -> Result<(), SimulationError> {
        let now = self.now;
        self.steered = false;
        self.decisions += 1;
        if self.decisions > MOST_DECISIONS {
            return Err(SimulationError::Chatter { at: now, count: self.decisions });
        }
        self.plant.view(now)?;
        self.turn_to_target(now);
        if self.sensing.next.is_none() {
            // A continuous sensor gives the true state.
            let truth = self.plant.viewed();
            let angles = truth.orientation.at(truth.seen()).beyond(&self.origin);
            for (axis, belief) in self.beliefs.iter_mut().enumerate() {
                (belief.angle, belief.rate) = (angles[axis], truth.rate[axis]);
            }
        } else {
            self.estimator.carry(now, &self.origin, &mut self.beliefs);
        }
        let before = self.laws.about(0).state();
        let states = self.states();
        let cause = self.ask(event);
        self.count_switchings(states);
        if !matches!(cause, Some(Cause::Start) | None) && self.laws.about(0).state() != before {
            self.has_switched()?;
        }
        self.feel();
        let truth = self.plant.viewed();
        let sensed = [truth.seen()[0], truth.rate[0]];
        self.drive.command(now, self.laws.commands(), &self.beliefs, truth.rigid);
        self.depart(record)?;
        self.tell_switching(before, cause, sensed, record)
    }
}
