//! Runs in pieces: to an instant or to what comes next, between what is sensed there and what is done about it, with commands
//! from outside.

use super::{Simulation, SimulationError};
use crate::law::{Command, Event};
use crate::record::Record;
use crate::time::Instant;

/// What a run can be stopped at.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Occasion {
    /// A sensor measures: before anything is done about it.
    Sample,
    /// A law is about to decide.
    Decision,
    /// A law has changed its state.
    Switching,
    /// A window of the envelope's mean has ended: before anything is done about it.
    Window,
}

impl Simulation {
    /// Commands in the place of the scenario's laws from now on, about each axis, until it is told otherwise: the actuator of
    /// the scenario executes it. What a law would answer at the same instant is not asked any more.
    ///
    /// ```
    /// use flexsc_core::{Scenario, Simulation, law::Command, time::Instant};
    /// # use flexsc_core::time::Span;
    ///
    /// let text = "duration = 10.0\n[law.open]\n[body.planar]\ninertia = 2.0";
    /// let mut simulation = Simulation::new(&Scenario::parse("steered.toml", text)?, 0);
    /// simulation.steer([Command::Torque(0.5); 3]);
    /// simulation.run_up_to(Instant::START + Span::from_seconds(4.0), &mut ())?;
    /// assert_eq!(simulation.state().map(|state| state.rigid_rate), Some(1.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn steer(&mut self, commands: [Command; 3]) {
        self.laws.steer(commands);
        self.steered = true;
    }

    /// Where the run is in time.
    pub fn time(&self) -> Instant {
        self.now
    }

    /// Whether the run is over.
    pub fn is_done(&self) -> bool {
        self.now == self.end
    }

    /// Takes the first sample, if the run has not begun: what is measured and believed is known from then on.
    ///
    /// # Errors
    /// As a run.
    pub fn open(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        if self.telling.open(self.now, record)? {
            self.sense(record)?;
            self.unanswered = Some(Event::Start);
        }
        Ok(())
    }

    /// Runs to an instant, or to the end of the scenario if that is earlier. What is due there is sensed, and answered only when
    /// the run goes on: commands that come between act from this instant. Wherever a run is cut, it comes to the same.
    ///
    /// # Errors
    /// As a run.
    pub fn run_up_to(&mut self, until: Instant, record: &mut dyn Record) -> Result<(), SimulationError> {
        self.walk(until, None, record).map(|_| ())
    }

    /// Runs to what comes next, but not beyond an instant; tells whether it came.
    ///
    /// # Errors
    /// As a run.
    pub fn run_to_next(
        &mut self,
        occasion: Occasion,
        until: Instant,
        record: &mut dyn Record,
    ) -> Result<bool, SimulationError> {
        self.walk(until, Some(occasion), record)
    }

    /// Tells a record what it lacks of the present motion where the run is left before its end.
    ///
    /// # Errors
    /// A record that cannot be kept.
    pub fn leave(&self, record: &mut dyn Record) -> Result<(), SimulationError> {
        if !self.is_done() {
            self.plant.tell_course(self.now, &self.exerted, record)?;
            self.telling.events.left(self.now, record)?;
        }
        Ok(())
    }

    fn walk(
        &mut self,
        until: Instant,
        occasion: Option<Occasion>,
        record: &mut dyn Record,
    ) -> Result<bool, SimulationError> {
        let until = until.min(self.end);
        self.open(record)?;
        if until <= self.now && !self.is_done() {
            return Ok(false);
        }
        let mut came = self.resume(occasion, record)?;
        while !came && self.arrive(until, record)? {
            let closes = self.monitor.as_ref().is_some_and(|monitor| monitor.closes == self.now);
            let event = self.event();
            self.perceive(record)?;
            came = match occasion {
                Some(Occasion::Sample) => event == Event::Due { sampled: true },
                Some(Occasion::Decision) => self.concerns(event),
                Some(Occasion::Window) => closes,
                Some(Occasion::Switching) | None => false,
            };
            self.unanswered = Some(event);
            if (came || self.now == until) && !self.is_done() {
                self.plant.view(self.now)?;
                return Ok(came);
            }
            // What comes at the end is answered there.
            came |= self.resume(occasion, record)?;
            if came && self.is_done() {
                return self.run_until(until, record).map(|()| true);
            }
        }
        if !came {
            self.finish(record)?;
        }
        Ok(came)
    }

    /// Answers what came up before the run was stopped, or was commanded since; tells whether a law has switched, if that is
    /// asked for.
    pub(super) fn resume(
        &mut self,
        occasion: Option<Occasion>,
        record: &mut dyn Record,
    ) -> Result<bool, SimulationError> {
        let event = self.unanswered.take();
        let Some(event) = event.or(self.steered.then_some(Event::Due { sampled: false })) else {
            return Ok(false);
        };
        if occasion != Some(Occasion::Switching) {
            return self.reply(event, record).map(|()| false);
        }
        let states = |of: &Self| [0, 1, 2].map(|axis| of.laws.about(axis.min(of.beliefs.len() - 1)).state());
        let before = states(self);
        self.reply(event, record)?;
        Ok(event != Event::Start && states(self) != before)
    }

    fn reply(&mut self, event: Event, record: &mut dyn Record) -> Result<(), SimulationError> {
        if event == Event::Start { self.begin(record) } else { self.answer(event, record) }
    }

    /// Whether laws have to decide on what has come up.
    pub(super) fn concerns(&self, event: Event) -> bool {
        let sampled = event == Event::Due { sampled: true };
        matches!(event, Event::Guard(_)) || self.laws.concerned(self.now, sampled, &self.beliefs)
    }
}
