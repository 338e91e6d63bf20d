//! Interface of laws about three axes together, from the errors about all axes to the commands about them.

use flexsc_numerics::time::Instant;

use super::{Command, DecisionCause, LawState, ReferenceNeeds, Setpoint};
use crate::part::Part;
use crate::state_estimate::StateEstimate;

/// Input of a law about three axes at a decision.
pub struct ThreeAxisInput<'a> {
    /// Setpoint about each axis.
    pub setpoints: [Setpoint; 3],
    /// State estimate about each axis.
    pub estimates: &'a [StateEstimate],
    /// Function that returns the speeds of the reaction wheels (rad/s), as available to their drives.
    pub wheel_speeds: &'a dyn Fn() -> Vec<f64>,
}

impl ThreeAxisInput<'_> {
    /// Returns the errors of angle (rad) and rate (rad/s) about each axis: setpoint minus estimate.
    pub fn errors(&self, now: Instant) -> [[f64; 2]; 3] {
        let mut errors = [[0.0; 2]; 3];
        for ((error, setpoint), estimate) in errors.iter_mut().zip(&self.setpoints).zip(self.estimates) {
            let (angle, rate) = setpoint.at(now);
            *error = [angle - estimate.angle, rate - estimate.rate];
        }
        errors
    }
}

/// Output of a law about three axes: the commands from now on, and the time of the next decision.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct ThreeAxisOutput {
    /// Command about each axis.
    pub commands: [Command; 3],
    /// Time of the next decision.
    pub until: Option<Instant>,
}

impl ThreeAxisOutput {
    /// No torque, without a further decision.
    pub const NONE: Self = Self { commands: [Command::Torque(0.0); 3], until: None };
}

/// Run-time state of a law about three axes together.
pub trait ThreeAxisLaw: Part {
    /// Responds to an event with the commands about all axes, and the time of the next decision.
    fn decide(&mut self, now: Instant, cause: DecisionCause, input: &ThreeAxisInput<'_>) -> ThreeAxisOutput;

    /// Returns the state of the law.
    fn state(&self) -> LawState<'_>;

    /// Sets a parameter of [`LawSpec::tunable`](super::LawSpec::tunable).
    fn tune(&mut self, _key: &str, _value: f64) {}

    /// Returns the references that the law reads besides the current state estimates.
    fn reference_needs(&self) -> ReferenceNeeds {
        ReferenceNeeds::default()
    }

    /// Returns a copy in the same state.
    fn copy(&self) -> Box<dyn ThreeAxisLaw>;
}

impl Clone for Box<dyn ThreeAxisLaw> {
    fn clone(&self) -> Self {
        self.copy()
    }
}
