//! State of a spatial body.

use flexsc_numerics::attitude::vector;

use super::{ElasticModes, RigidBody, RigidState};
use crate::ModeState;
use crate::three_axis_model::ThreeAxisModel;

/// State of a spatial body: rigid motion and modal phases.
#[derive(Clone, Debug, PartialEq)]
pub struct ThreeAxisState {
    /// Rigid rotation.
    pub turn: RigidState,
    /// Phase of each elastic mode: displacement (m sqrt(kg)), and rate over natural frequency.
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
