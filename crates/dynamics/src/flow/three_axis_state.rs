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
        // All numbers are tested, because branches would cost more: the sum carries into the sign bit if all bits of the exponent
        // are set.
        let exponent = f64::INFINITY.to_bits();
        let add =
            |any: u64, number: &f64| any | ((number.to_bits() & exponent) + f64::MIN_POSITIVE.to_bits());
        let turn = self.turn.attitude.coords.iter().fold(0, add);
        let turn = RigidBody::momentum(&self.turn).iter().fold(turn, add);
        let mode = |any: u64, phase: &ModeState| add(add(any, &phase.displacement), &phase.quadrature);
        self.modes.iter().fold(turn, mode) >> 63 == 0
    }
}
