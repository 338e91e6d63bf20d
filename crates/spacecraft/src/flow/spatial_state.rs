//! The state of a spatial body.

use super::{Elastic, Rigid, RigidTurn};
use crate::attitude::vector;
use crate::body::Spatial;
use crate::motion::Phase;

/// Where a spatial body is.
#[derive(Clone, Debug, PartialEq)]
pub struct SpatialState {
    /// The rigid motion.
    pub turn: RigidTurn,
    /// One phase for each elastic mode: displacement (m sqrt(kg)), and rate over natural frequency.
    pub modes: Vec<Phase>,
}

impl SpatialState {
    /// The state at the start of a run.
    pub fn start(body: &Spatial, rigid: &Rigid) -> Self {
        Self { turn: rigid.start(body.attitude.get(), vector(&body.rate)), modes: Elastic::start(body) }
    }

    /// Whether every number is finite.
    pub fn is_finite(&self) -> bool {
        // All are looked at: branches would cost more.
        let finite = |all: bool, number: &f64| all & number.is_finite();
        let turn = self.turn.attitude.coords.iter().fold(true, finite);
        let turn = Rigid::momentum(&self.turn).iter().fold(turn, finite);
        let mode = |all: bool, phase: &Phase| finite(finite(all, &phase.displacement), &phase.quadrature);
        self.modes.iter().fold(turn, mode)
    }
}
