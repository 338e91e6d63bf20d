//! Control laws: state machines that answer every event with a hold.

mod damping;
mod open;
mod pd;
mod phase_plane;
mod relay;
mod switching_lines;

use crate::belief::Belief;
use crate::guard::Guard;
use crate::label::labels;
use crate::one_of::one_of;
use crate::time::Instant;

pub use damping::{Damped, Damping, DampingGuards, DampingRelay};
pub use open::Open;
pub use pd::{Differentiation, Extra, Pd, ScheduledGain};
pub use phase_plane::{PhasePlane, PhasePlaneLaw, Target};
pub use relay::{Relay, Sides};
pub use switching_lines::{SwitchingLines, band};

one_of! {
    /// The kinds of law.
    Law: Control {
        /// Relay with dead zone, hysteresis and a timed brake.
        Relay(Relay),
        /// Sampled proportional and derivative feedback of the angle.
        Pd(Pd),
        /// None: what a scenario with a manoeuvre has by default.
        Open(Open),
        /// Relays in the phase planes of three axes, with pulses of jets.
        PhasePlane(PhasePlane),
    }
}

/// What every law does.
pub trait Control {
    /// Answers an event. A law of three axes leaves a body with one angle alone.
    fn decide(&mut self, _now: Instant, _cause: Cause, _goal: &Goal, _belief: &Belief) -> Hold {
        Hold::NONE
    }

    /// The state that the law is in.
    fn state(&self) -> Phase;

    /// Whether the law's switchings tell all that it does: its torque changes with its state alone.
    fn switches(&self) -> bool {
        false
    }

    /// How near to the goal the law promises to stay.
    fn promise(&self) -> Promise {
        Promise::Nothing
    }

    /// The value that the law's tunable parameter starts with; NaN if it has none.
    fn gain(&self) -> f64 {
        f64::NAN
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
}

impl Goal {
    /// Angle and rate at an instant.
    pub fn at(&self, now: Instant) -> (f64, f64) {
        (self.angle + self.rate * now.since(self.from).seconds(), self.rate)
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

labels! {
    /// The states of all laws, by the names under which they are logged.
    Phase {
        /// Open loop: no feedback acts.
        Open = "OPEN",
        /// PD: the sampled feedback acts.
        Feedback = "PD",
        /// Relay: weak push before the first boundary is reached.
        Start = "W0",
        /// Relay: strong push to the left, from beyond the right boundary.
        RightPush = "RACC",
        /// Relay: strong timed brake of the leftward motion.
        RightBrake = "RBRK",
        /// Relay: weak push to the right, while coasting inside the dead zone.
        WeakRight = "W+",
        /// Relay: strong push to the right, from beyond the left boundary.
        LeftPush = "LACC",
        /// Relay: strong timed brake of the rightward motion.
        LeftBrake = "LBRK",
        /// Relay: weak push to the left, while coasting inside the dead zone.
        WeakLeft = "W-",
    }
}

impl Phase {
    /// Whether the strong torque is on.
    pub const fn is_strong(self) -> bool {
        matches!(self, Self::RightPush | Self::RightBrake | Self::LeftPush | Self::LeftBrake)
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

/// A law's answer: the torque from now on, and when to be asked again.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Hold {
    /// Torque command (N m), or reduced moment (rad/s²) on a body without inertia.
    pub torque: f64,
    /// Ask again at this instant.
    pub until: Option<Instant>,
    /// Ask again when one of these trips.
    pub guards: Guards,
}

impl Hold {
    /// No torque, for good.
    pub const NONE: Self = Self { torque: 0.0, until: None, guards: Guards::NONE };
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
