//! State of a spatial body.

use flexsc_numerics::attitude::vector;

use super::{ElasticModes, RigidBody, RigidState};
use crate::ModeState;
use crate::three_axis_model::ThreeAxisModel;

/// State of a three-axis body: rigid motion and modes.
#[derive(Clone, Debug, PartialEq)]
pub struct ThreeAxisState {
    /// Attitude and angular momentum of the rigid part; in two-way coupled motion, those of the mean axes.
    pub turn: RigidState,
    /// State of each elastic mode: displacement, and rate over natural frequency (m sqrt(kg)).
    pub modes: Vec<ModeState>,
}

impl ThreeAxisState {
    /// Returns the state at the start of a run.
    pub fn start(body: &ThreeAxisModel, rigid: &RigidBody) -> Self {
        Self { turn: rigid.start(body.attitude.get(), vector(&body.rate)), modes: ElasticModes::start(body) }
    }

    /// Returns true if every number is finite.
    pub fn is_finite(&self) -> bool {
        // All numbers are tested, because branches would cost more.
        let finite = |all: bool, number: &f64| all & number.is_finite();
        let turn = self.turn.attitude.coords.iter().fold(true, finite);
        let turn = RigidBody::momentum(&self.turn).iter().fold(turn, finite);
        let mode = |all: bool, phase: &ModeState| finite(finite(all, &phase.displacement), &phase.quadrature);
        self.modes.iter().fold(turn, mode)
    }
}
