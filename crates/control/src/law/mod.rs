//! Control laws: state machines that answer every event about an axis with a hold.

mod attitude;
mod b_dot;
mod controls;
mod damping;
mod distribution;
mod filter;
mod frame;
mod itinerary;
mod measure;
mod open;
mod pd;
mod per_axis;
mod phase_plane;
mod relay;
mod shaped;
#[cfg(test)]
mod slew_tests;
mod stages;
mod state_space;
mod switching_lines;
mod tunable;

use std::any::Any;
use std::fmt;
use std::ops::Deref;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::actuator::PulseWidth;
pub use crate::belief::Reads;
use crate::belief::{Belief, Damped};
use crate::document::Fault;
use crate::guard::Guard;
use crate::own::{Halt, Own};
use crate::quantity::Finite;
use crate::time::{Instant, Span};

pub use crate::record::Phase;
pub use attitude::{AttitudeLaw, Integral};
pub use b_dot::BDot;
pub use controls::{Controls, Event};
pub use damping::{ActiveDamping, DampingGuards, DampingRelay};
pub use distribution::TorqueDistribution;
pub use filter::{Coefficients, Filter, Lead, LowPass, Notch};
pub use frame::Frame;
pub use itinerary::Itinerary;
pub use measure::Measure;
pub use open::Open;
pub use pd::{Differentiation, Extra, Pd, ScheduledGain};
pub use per_axis::PerAxis;
pub use phase_plane::{PhasePlane, Target};
pub use relay::{Relay, Sides};
pub use stages::{Stage, Stages};
pub use state_space::{Commands, Of, StateSpace};
pub use switching_lines::{SwitchingLines, band};
pub use tunable::{Tunable, TunedNumbers};

/// The kinds of law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Law {
    /// Relay with dead zone, hysteresis and a timed brake.
    Relay(Relay),
    /// Sampled proportional-derivative feedback of the angle.
    Pd(Pd),
    /// Sampled feedback of the attitude, as an acceleration.
    Attitude(AttitudeLaw),
    /// A sampled compensator, given by its matrices.
    StateSpace(StateSpace),
    /// No law: the default of a scenario with a manoeuvre.
    Open(Open),
    /// A relay in the phase plane, with pulses of computed length.
    PhasePlane(PhasePlane),
    /// A separate law about each of three axes.
    PerAxis(Box<PerAxis>),
    /// Magnetic moments against the measured change of the field, to detumble a body.
    BDot(BDot),
    /// Laws that act one after another.
    Stages(Stages),
    /// A law from another crate; a scenario file cannot name it.
    Own(Own<dyn Rule + Send + Sync>),
}

/// What every kind of law tells of itself before a run. It acts about one axis; on a body with three, one about each.
pub trait Rule {
    /// The law at work about an axis on which an actuator has this authority.
    fn start(&self, authority: &Authority) -> Box<dyn Control>;

    /// Its own period, at which it samples and commands; none if events make it decide.
    fn period(&self) -> Option<Span> {
        None
    }

    /// Whether the law's switchings are all that it does: its torque changes with its state alone.
    fn switches(&self) -> bool {
        false
    }

    /// How near to the goal the law promises to stay.
    fn promise(&self) -> Promise {
        Promise::Nothing
    }

    /// What it reads of an estimator.
    fn reads(&self) -> Reads {
        Reads::Motion
    }

    /// The numbers that an adaptation may tune.
    fn tunable(&self) -> Vec<Tunable> {
        Vec::new()
    }

    /// What it is, for the program that brought it.
    fn any(&self) -> Option<&dyn Any> {
        None
    }
}

/// A law at work about one axis.
pub trait Control: fmt::Debug + Send + Sync {
    /// Answers an event.
    fn decide(&mut self, now: Instant, cause: Cause, goal: &Goal, belief: &Belief) -> Hold;

    /// The state that the law is in.
    fn state(&self) -> Phase;

    /// Why it cannot go on, of one from outside that cannot: the run ends there.
    fn halted(&self) -> Option<Halt> {
        None
    }

    /// A copy in the same state.
    fn copy(&self) -> Box<dyn Control>;

    /// The value of the number that was tuned last, or of its tunable number; NaN if it has none.
    fn tuned(&self) -> f64 {
        f64::NAN
    }

    /// Takes a number of [`Rule::tunable`] over.
    fn tune(&mut self, _key: &str, _value: f64) {}

    /// The relay law that it is, if it is one.
    fn relay(&mut self) -> Option<&mut Relay> {
        None
    }

    /// Whether it follows a manoeuvre while it lasts, and not only from its end on.
    fn tracks(&self) -> bool {
        false
    }

    /// How far ahead of a sample it wants to know the elastic rates (s).
    fn ahead(&self) -> f64 {
        0.0
    }

    /// What its active damping did in the last cycle, if it has any.
    fn damped(&self) -> Option<&Damped> {
        None
    }
}

impl Clone for Box<dyn Control> {
    fn clone(&self) -> Self {
        self.copy()
    }
}

/// What an actuator can do about an axis, as laws know it.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Authority {
    /// The axis: 0, or 0 to 2 for roll, pitch and yaw.
    pub axis: usize,
    /// Accelerations of plus and minus (rad/s²); endless without a limit.
    pub accelerations: [f64; 2],
    /// What it makes of a wanted pulse.
    pub width: PulseWidth,
    /// Time from a command to its execution (s).
    pub delay: f64,
    /// The elastic rate beyond which active damping acts (rad/s).
    pub threshold: f64,
}

impl Deref for Law {
    type Target = dyn Rule;
    fn deref(&self) -> &Self::Target {
        match self {
            Self::Relay(law) => law,
            Self::Pd(law) => law,
            Self::Attitude(law) => law,
            Self::StateSpace(law) => law,
            Self::Open(law) => law,
            Self::PhasePlane(law) => law,
            Self::PerAxis(laws) => laws.as_ref(),
            Self::BDot(law) => law,
            Self::Stages(laws) => laws,
            Self::Own(law) => &**law,
        }
    }
}

impl Law {
    /// The law about an axis: 0, or 0 to 2 for roll, pitch and yaw.
    pub fn about(&self, axis: usize) -> &Self {
        if let Self::PerAxis(laws) = self { laws.about(axis) } else { self }
    }

    /// What single values cannot show to be wrong in its own keys: a key within the law, and why.
    pub fn inconsistency(&self) -> Option<Fault> {
        match self {
            Self::Attitude(law) => law.inconsistency(),
            Self::StateSpace(law) => law.inconsistency(),
            Self::PhasePlane(law) => law.inconsistency(),
            Self::Stages(laws) => laws.inconsistency(),
            Self::Relay(_)
            | Self::Pd(_)
            | Self::Open(_)
            | Self::PerAxis(_)
            | Self::BDot(_)
            | Self::Own(_) => None,
        }
    }

    /// The number that an adaptation tunes unless it names another; NaN of a law without any.
    pub fn tuned(&self) -> f64 {
        self.tunable().first().map_or(f64::NAN, |number| number.value)
    }

    /// The inertia tensor that it takes a body with three axes to have, row by row (kg m²), if it has one of its own.
    pub fn inertia(&self) -> Option<&[[Finite; 3]; 3]> {
        if let Self::Attitude(law) = self { law.inertia.as_ref() } else { None }
    }

    /// The kind, as a scenario names it.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Relay(_) => "relay",
            Self::Pd(_) => "pd",
            Self::Attitude(_) => "attitude",
            Self::StateSpace(_) => "state_space",
            Self::Open(_) => "open",
            Self::PhasePlane(_) => "phase_plane",
            Self::PerAxis(_) => "per_axis",
            Self::BDot(_) => "b_dot",
            Self::Stages(_) => "stages",
            Self::Own(_) => "own",
        }
    }
}

impl Default for Law {
    fn default() -> Self {
        Self::Open(Open::default())
    }
}

/// Where the body shall be: from an instant on at this angle, which from there moves at this rate.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Goal {
    /// When it begins: at the start, or at the end of the manoeuvre.
    pub from: Instant,
    /// Angle there (rad).
    pub angle: f64,
    /// Rate from there on (rad/s).
    pub rate: f64,
    /// Acceleration there (rad/s²), of a target that the body is led to.
    pub acceleration: f64,
}

impl Goal {
    /// Angle and rate at an instant.
    pub fn at(&self, now: Instant) -> (f64, f64) {
        // Of a goal at rest the time that has passed does not count.
        let travel = if self.rate == 0.0 { self.rate } else { self.rate * now.since(self.from).seconds() };
        (self.angle + travel, self.rate)
    }
}

/// How near to its goal a body shall stay.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum Promise {
    /// Nothing is promised.
    Nothing,
    /// Within so much of it (rad).
    Within(f64),
    /// Within this part of the distance at which the goal begins.
    Part(f64),
}

impl Promise {
    /// Half width of the band about the goal (rad), where the goal begins at this distance; NaN without one.
    pub fn band(self, distance: f64) -> f64 {
        match self {
            Self::Nothing => f64::NAN,
            Self::Within(band) => band,
            Self::Part(part) => part * distance,
        }
    }
}

/// Why a law is asked.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Cause {
    /// The run begins.
    Start,
    /// The guard of this index tripped.
    Guard(usize),
    /// The time of the hold has come.
    Timeout,
}

/// A law's answer: the command from now on, and when to be asked again.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Hold {
    /// What the actuator shall do.
    pub command: Command,
    /// Ask again at this instant.
    pub until: Option<Instant>,
    /// Ask again when one of these trips.
    pub guards: Guards,
}

/// A command about one axis.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum Command {
    /// A torque (N m), or reduced moment (rad/s²) on a body without inertia; of a wheel, units of its command.
    Torque(f64),
    /// A change of the rigid rate within the law's period (rad/s): the actuator makes a pulse of it.
    Change(f64),
    /// An angular acceleration (rad/s²): the inertia makes a torque of those about all axes.
    Acceleration(f64),
    /// A magnetic moment along the axis (A m²).
    Moment(f64),
}

impl Hold {
    /// No torque, for good.
    pub const NONE: Self = Self { command: Command::Torque(0.0), until: None, guards: Guards::NONE };
}

/// At most two guards.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Guards([Guard; 2], usize);

impl Guards {
    /// No guard.
    pub const NONE: Self = Self([Guard::at_least(0.0); 2], 0);

    /// One guard, of index 0.
    pub const fn one(guard: Guard) -> Self {
        Self([guard; 2], 1)
    }

    /// Two guards, of indices 0 and 1.
    pub const fn two(first: Guard, second: Guard) -> Self {
        Self([first, second], 2)
    }
}

impl std::ops::Deref for Guards {
    type Target = [Guard];
    fn deref(&self) -> &[Guard] {
        &self.0[..self.1]
    }
}
