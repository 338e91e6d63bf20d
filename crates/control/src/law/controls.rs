//! The laws of a run at work, one about each axis, with what each holds.

use super::{Authority, Cause, Command, Control, Damped, Goal, Hold, Law, Phase};
use crate::belief::Belief;
use crate::guard::Guard;
use crate::own::Halt;
use crate::time::Instant;

/// The laws at work.
#[derive(Clone, Debug)]
pub struct Controls {
    axes: Vec<Held>,
    /// When any of them wants to be asked again.
    until: Option<Instant>,
    /// What is commanded in their place, from outside.
    steered: Option<[Command; 3]>,
}

/// A law, and what it holds.
#[derive(Clone, Debug)]
struct Held {
    law: Box<dyn Control>,
    hold: Hold,
    /// Where it stands within a law of its own about each axis.
    place: String,
}

/// What has come up at an instant.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Event {
    /// The run begins.
    Start,
    /// A guard of the one angle tripped.
    Guard(usize),
    /// A sample was taken, or the time of a hold has come.
    Due {
        /// Whether a sample was taken, at which guards are tested.
        sampled: bool,
    },
}

impl Controls {
    /// The laws before a run, about axes on which the actuator has these authorities.
    pub fn new(law: &Law, authorities: &[Authority]) -> Self {
        let axis = |(axis, authority)| {
            let place = if let Law::PerAxis(laws) = law { laws.place(axis) } else { String::new() };
            Held { law: law.about(axis).start(authority), hold: Hold::NONE, place }
        };
        Self { axes: authorities.iter().enumerate().map(axis).collect(), until: None, steered: None }
    }

    /// Commands in the place of the laws from now on, which nobody asks any more.
    pub fn steer(&mut self, commands: [Command; 3]) {
        if self.steered.replace(commands).is_none() {
            self.until = None;
            self.axes.iter_mut().for_each(|held| held.hold = Hold::NONE);
        }
    }

    /// Whether commands come from outside.
    pub fn are_steered(&self) -> bool {
        self.steered.is_some()
    }

    /// Asks the laws that an event concerns; tells the cause for the first of them that answers.
    pub fn decide(
        &mut self,
        now: Instant,
        event: Event,
        goal: impl Fn(usize, &dyn Control) -> Goal,
        beliefs: &[Belief],
    ) -> Option<Cause> {
        let mut first = None;
        for (axis, (held, belief)) in self.axes.iter_mut().zip(beliefs).enumerate() {
            let timeout = held.hold.until.filter(|until| *until == now).map(|_| Cause::Timeout);
            let cause = match event {
                Event::Start => Some(Cause::Start),
                Event::Guard(guard) => Some(Cause::Guard(guard)),
                Event::Due { sampled: true } => {
                    let holds = |guard: &Guard| guard.holds(belief.angle);
                    held.hold.guards.iter().position(holds).map(Cause::Guard).or(timeout)
                }
                Event::Due { sampled: false } => timeout,
            };
            if let Some(cause) = cause {
                held.hold = held.law.decide(now, cause, &goal(axis, &*held.law), belief);
                first = first.or(Some(cause));
            }
        }
        self.until = self.axes.iter().filter_map(|held| held.hold.until).min();
        first
    }

    /// Puts the one relay law into a state that begins at an instant, after a push that began at another.
    pub fn begin(&mut self, phase: Phase, now: Instant, pushed: Instant) {
        let [held] = &mut self.axes[..] else { return };
        if let Some(relay) = held.law.relay() {
            held.hold = relay.begin(phase, now, pushed);
            self.until = held.hold.until;
        }
    }

    /// Whether a law is concerned by a sample, or by the time that has come.
    pub fn concerned(&self, now: Instant, sampled: bool, beliefs: &[Belief]) -> bool {
        self.until == Some(now)
            || sampled
                && self
                    .axes
                    .iter()
                    .zip(beliefs)
                    .any(|(held, belief)| held.hold.guards.iter().any(|guard| guard.holds(belief.angle)))
    }

    /// When any of them wants to be asked again.
    pub fn until(&self) -> Option<Instant> {
        self.until
    }

    /// The guards of the first axis.
    pub fn guards(&self) -> &[Guard] {
        &self.axes[0].hold.guards
    }

    /// What they command, about each axis.
    pub fn commands(&self) -> [Command; 3] {
        if let Some(commands) = self.steered {
            return commands;
        }
        let mut commands = [Command::Torque(0.0); 3];
        for (held, command) in self.axes.iter().zip(&mut commands) {
            *command = held.hold.command;
        }
        commands
    }

    /// The law about an axis.
    pub fn about(&self, axis: usize) -> &dyn Control {
        &*self.axes[axis].law
    }

    /// Why one from outside cannot go on.
    pub fn halted(&self) -> Option<Halt> {
        self.axes.iter().find_map(|held| held.law.halted())
    }

    /// Tunes a number of all of them, or of the one about an axis that the key names.
    pub fn tune(&mut self, key: &str, value: f64) {
        for held in &mut self.axes {
            if let Some(key) = key.strip_prefix(held.place.as_str()) {
                held.law.tune(key, value);
            }
        }
    }

    /// How far ahead of a sample they want to know elastic rates (s).
    pub fn ahead(&self) -> f64 {
        self.axes.iter().map(|held| held.law.ahead()).fold(0.0, f64::max)
    }

    /// What active damping did in the last cycle, about each axis; of laws without it, nothing.
    pub fn damped(&self) -> Vec<Damped> {
        self.axes.iter().map(|held| held.law.damped().copied().unwrap_or_default()).collect()
    }
}
