//! Run-time state of the laws of a run, one about each axis, with their current outputs.

use super::{Authority, Cause, Command, Control, Damped, Goal, Hold, Law, Phase};
use crate::belief::Belief;
use crate::guard::Guard;
use crate::own::Halt;
use crate::time::Instant;

/// Run-time state of the laws of all axes.
#[derive(Clone, Debug)]
pub struct Controls {
    axes: Vec<Held>,
    /// Earliest time of the laws' next decision.
    until: Option<Instant>,
    /// Commands set from outside, which replace the laws' outputs.
    steered: Option<[Command; 3]>,
}

/// Law with its current output.
#[derive(Clone, Debug)]
struct Held {
    law: Box<dyn Control>,
    hold: Hold,
    /// Key prefix of the law within a law `per_axis`; else empty.
    place: String,
}

/// Event to which laws respond.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Event {
    /// Start of the run.
    Start,
    /// Trip of a guard on the angle of a one-axis body.
    Guard(usize),
    /// Sample, or time of the next decision.
    Due {
        /// True if a sample was taken, at which guards are tested.
        sampled: bool,
    },
}

impl Controls {
    /// Creates the laws before a run, about axes with these actuator authorities.
    pub fn new(law: &Law, authorities: &[Authority]) -> Self {
        let axis = |(axis, authority)| {
            let place = if let Law::PerAxis(laws) = law { laws.place(axis) } else { String::new() };
            Held { law: law.about(axis).start(authority), hold: Hold::NONE, place }
        };
        Self { axes: authorities.iter().enumerate().map(axis).collect(), until: None, steered: None }
    }

    /// Sets commands that replace the laws' outputs from now on; the laws no longer decide.
    pub fn steer(&mut self, commands: [Command; 3]) {
        if self.steered.replace(commands).is_none() {
            self.until = None;
            self.axes.iter_mut().for_each(|held| held.hold = Hold::NONE);
        }
    }

    /// Returns true if commands are set from outside.
    pub fn are_steered(&self) -> bool {
        self.steered.is_some()
    }

    /// Lets the laws that an event concerns decide. Returns the cause of the first decision, if any.
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

    /// Sets the state of the single relay law, which starts at `now`, after a push that started at `pushed`.
    pub fn begin(&mut self, phase: Phase, now: Instant, pushed: Instant) {
        let [held] = &mut self.axes[..] else { return };
        if let Some(relay) = held.law.relay() {
            held.hold = relay.begin(phase, now, pushed);
            self.until = held.hold.until;
        }
    }

    /// Returns true if a law must decide at `now`, because of its time or of a sample.
    pub fn concerned(&self, now: Instant, sampled: bool, beliefs: &[Belief]) -> bool {
        self.until == Some(now)
            || sampled
                && self
                    .axes
                    .iter()
                    .zip(beliefs)
                    .any(|(held, belief)| held.hold.guards.iter().any(|guard| guard.holds(belief.angle)))
    }

    /// Returns the earliest time of the laws' next decision.
    pub fn until(&self) -> Option<Instant> {
        self.until
    }

    /// Returns the guards of the first axis.
    pub fn guards(&self) -> &[Guard] {
        &self.axes[0].hold.guards
    }

    /// Returns the command about each axis.
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

    /// Returns the law about an axis.
    pub fn about(&self, axis: usize) -> &dyn Control {
        &*self.axes[axis].law
    }

    /// Returns the error that a law of another crate failed with.
    pub fn halted(&self) -> Option<Halt> {
        self.axes.iter().find_map(|held| held.law.halted())
    }

    /// Sets a parameter of all laws, or of the law about one axis that the key selects.
    pub fn tune(&mut self, key: &str, value: f64) {
        for held in &mut self.axes {
            if let Some(key) = key.strip_prefix(held.place.as_str()) {
                held.law.tune(key, value);
            }
        }
    }

    /// Returns the longest lead time after a sample for which laws read predicted elastic rates (s).
    pub fn ahead(&self) -> f64 {
        self.axes.iter().map(|held| held.law.ahead()).fold(0.0, f64::max)
    }

    /// Returns the status of active damping in the last cycle about each axis; the default for laws without it.
    pub fn damped(&self) -> Vec<Damped> {
        self.axes.iter().map(|held| held.law.damped().copied().unwrap_or_default()).collect()
    }
}
