//! Control laws: state machines that respond to every event about an axis with a command.

mod active_damping;
mod attitude;
mod attitude_profile;
mod axes_laws;
mod b_dot;
mod command;
mod compensator;
mod compensator_input;
mod controllers;
mod direction_motion;
mod direction_pair;
mod discrete_matrices;
mod distribution;
mod error_measure;
mod filter;
mod frame;
mod law_facts;
mod law_state;
mod linear_law;
mod mode_laws;
mod one_axis_state_space;
mod open_loop;
mod output_quantity;
mod pd;
mod per_axis_laws;
mod phase_plane;
mod properties;
mod relay;
mod requirements;
mod setpoint;
mod shaped_slew;
#[cfg(test)]
mod slew_tests;
mod stages;
mod state_space;
mod switching_lines;
mod target_checks;
mod target_frame;
mod three_axis_law;
mod three_axis_state_space;
mod torque_conditions;
mod tunable;

use flexsc_dynamics::guard::Guard;
use flexsc_flight_precision::Precision;
use flexsc_formats::document::ConfigError;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::actuator::PulseWidth;
use crate::kinds::kinds;
use crate::offers::{LawOffers, LawPlace, Offers};
use crate::part::Part;
use crate::requirement::Requirements;
pub use crate::state_estimate::EstimateNeeds;
use flexsc_numerics::time::{Instant, Span};

use crate::state_estimate::{DampingStatus, StateEstimate};

pub use active_damping::{ActiveDamping, DampingGuards};
pub use attitude::{AttitudeLaw, Integral};
pub use attitude_profile::AttitudeProfile;
pub use b_dot::BDot;
pub use command::{Command, CommandQuantity};
pub use compensator::Compensator;
pub use controllers::{AxisDecision, Controllers, Event};
pub use direction_motion::SkyDirection;
pub use direction_pair::{DirectionPair, PointedAxis};
pub use distribution::TorqueDistribution;
pub use error_measure::AttitudeErrorMeasure;
pub use filter::{Coefficients, Filter, Lead, LowPass, Notch};
pub use flexsc_record::Phase;
pub use frame::Frame;
pub use law_facts::LawFacts;
pub use law_state::{LawState, ReferenceNeeds};
pub use linear_law::{LAST_ANGLE, LinearLaw};
pub use open_loop::Open;
pub use output_quantity::OutputQuantity;
pub use pd::{Differentiation, Extra, Pd, ScheduledGain};
pub use per_axis_laws::PerAxisLaws;
pub use phase_plane::{AttitudeTarget, PhasePlane};
pub use properties::PlacedLaw;
pub use relay::{Relay, RelayRun, RelaySides};
pub use setpoint::{ErrorBand, Setpoint};
pub use stages::{Stage, Stages};
pub use state_space::{StateSpace, TimeDomain};
pub use switching_lines::{error_band, switching_lines};
pub use target_frame::TargetFrame;
pub use three_axis_law::{ThreeAxisInput, ThreeAxisLaw, ThreeAxisOutput};
pub use torque_conditions::TorqueConditions;
pub use tunable::{Tunable, TunedNumbers};

kinds! {
    /// The kinds of law.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[schemars(rename = "Law")]
    pub enum LawKind: dyn LawSpec {
        /// Relay with dead zone, hysteresis and a timed brake.
        "relay" Relay(Relay),
        /// Sampled proportional-derivative feedback of the angle.
        "pd" Pd(Pd),
        /// Sampled feedback of the attitude, as an acceleration.
        "attitude" Attitude(AttitudeLaw),
        /// A sampled compensator, given by its matrices.
        "state_space" StateSpace(StateSpace),
        /// No law: the default of a scenario with a manoeuvre.
        "open" Open(Open),
        /// A relay in the phase plane, with pulses of computed length.
        "phase_plane" PhasePlane(PhasePlane),
        /// A separate law about each of three axes.
        "per_axis" PerAxis(Box<PerAxisLaws>),
        /// Magnetic moments against the measured change of the field, to detumble a body.
        "b_dot" BDot(BDot),
        /// Laws that act one after another.
        "stages" Stages(Stages),
    }
    own "A law from another crate; a scenario file cannot name it."
}

/// Settings of a law. A law acts about one axis; on a three-axis body there is one about each axis.
pub trait LawSpec: Send + Sync {
    /// Returns the run-time state of the law about an axis with this actuator authority.
    fn start(&self, authority: &Authority) -> Box<dyn Law>;

    /// Returns the run-time state of a law about three axes together with these actuator authorities; `None` for a law
    /// about one axis.
    fn start_three_axis(&self, _authorities: &[Authority]) -> Option<Box<dyn ThreeAxisLaw>> {
        None
    }

    /// Returns the offers of the law to the other parts of a scenario; by default those of a law without a period that
    /// reads estimates of the motion.
    fn offers(&self) -> LawOffers {
        LawOffers::new(None, EstimateNeeds::Motion)
    }

    /// Checks the settings against each other; returns a key within the law and the reason.
    fn validate(&self) -> Option<ConfigError> {
        None
    }

    /// Adds the requirements of the law on the other parts of a scenario.
    fn requires(&self, _place: &LawPlace, _offers: &Offers, _needs: &mut Requirements) {}

    /// Returns the error band about the setpoint within which the law is expected to stay.
    fn expected_band(&self) -> ErrorBand {
        ErrorBand::None
    }

    /// Returns an estimate of the largest torque (N m) that the law commands.
    fn expected_torque(&self, _conditions: &TorqueConditions) -> f64 {
        0.0
    }

    /// Returns the parameters that an adaptation may tune.
    fn tunable(&self) -> Vec<Tunable> {
        Vec::new()
    }
}

impl dyn LawSpec {
    /// Returns the law's own period, at which it samples and commands; `None` if it decides at events.
    pub fn period(&self) -> Option<Span> {
        self.offers().period
    }

    /// Returns the estimates that the law reads.
    pub fn needs(&self) -> EstimateNeeds {
        self.offers().needs
    }

    /// Returns true if the law is a relay, whose torque changes only with its state.
    pub fn is_switching(&self) -> bool {
        self.offers().is_switching
    }
}

/// Run-time state of a law about one axis.
pub trait Law: Part {
    /// Responds to an event with a command, and the conditions of the next decision.
    fn decide(
        &mut self,
        now: Instant,
        cause: DecisionCause,
        goal: &Setpoint,
        state_estimate: &StateEstimate,
    ) -> ControlOutput;

    /// Returns the state of the law.
    fn state(&self) -> LawState<'_>;

    /// Sets a parameter of [`LawSpec::tunable`].
    fn tune(&mut self, _key: &str, _value: f64) {}

    /// Returns the references that the law reads besides the current state estimate.
    fn reference_needs(&self) -> ReferenceNeeds {
        ReferenceNeeds::default()
    }

    /// Returns the relay law, if the law is one.
    fn as_relay(&mut self) -> Option<&mut RelayRun> {
        None
    }

    /// Returns a copy in the same state.
    fn copy(&self) -> Box<dyn Law>;
}

impl Clone for Box<dyn Law> {
    fn clone(&self) -> Self {
        self.copy()
    }
}

/// Authority of an actuator about an axis, in the laws' model.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Authority {
    /// Index of the axis: 0, or 0 to 2 for roll, pitch and yaw.
    pub axis: usize,
    /// Largest accelerations in the positive and the negative direction (rad/s²); infinite without a limit.
    pub accelerations: [f64; 2],
    /// Quantisation of the actuator's pulse lengths.
    pub width: PulseWidth,
    /// Time from a command to its execution (s).
    pub delay: f64,
    /// Elastic rate above which active damping acts (rad/s).
    pub threshold: f64,
    /// Precision of the flight computer.
    pub precision: Precision,
}

impl LawKind {
    /// Returns the law about an axis: 0, or 0 to 2 for roll, pitch and yaw.
    pub fn about(&self, axis: usize) -> &Self {
        if let Self::PerAxis(laws) = self { laws.about(axis) } else { self }
    }

    /// Returns the stages of a law in sequence; empty for any other law.
    pub fn stages(&self) -> &[Stage] {
        if let Self::Stages(laws) = self { laws.as_slice() } else { &[] }
    }

    /// Returns the law of a stage of a law in sequence, to be replaced; `None` of any other law.
    pub fn stage_law_mut(&mut self, index: usize) -> Option<&mut Self> {
        if let Self::Stages(laws) = self { laws.law_mut(index) } else { None }
    }

    /// Returns true if the law changes the actuators that execute its commands.
    pub fn selects_actuators(&self) -> bool {
        self.stages().iter().any(|stage| stage.actuators.is_some())
    }
}

impl Default for LawKind {
    fn default() -> Self {
        Self::Open(Open::default())
    }
}

/// Cause of a decision.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum DecisionCause {
    /// Start of the run.
    Start,
    /// Trip of the guard with this index.
    Guard(usize),
    /// Time set by the previous decision.
    Timeout,
}

/// Output of a law: the command from now on, and the conditions of the next decision.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct ControlOutput {
    /// Command to the actuator.
    pub command: Command,
    /// Time of the next decision.
    pub until: Option<Instant>,
    /// Guards, of which any trip causes the next decision.
    pub guards: Guards,
}

impl ControlOutput {
    /// No torque, without a further decision.
    pub const NONE: Self = Self { command: Command::Torque(0.0), until: None, guards: Guards::NONE };
}

/// Set of at most two guards.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Guards([Guard; 2], usize);

impl Guards {
    /// Empty set of guards.
    pub const NONE: Self = Self([Guard::at_least(0.0); 2], 0);

    /// Creates a set of one guard, of index 0.
    pub const fn one(guard: Guard) -> Self {
        Self([guard; 2], 1)
    }

    /// Creates a set of two guards, of indices 0 and 1.
    pub const fn two(first: Guard, second: Guard) -> Self {
        Self([first, second], 2)
    }
}

impl std::ops::Deref for Guards {
    type Target = [Guard];
    #[inline]
    fn deref(&self) -> &[Guard] {
        &self.0[..self.1]
    }
}
