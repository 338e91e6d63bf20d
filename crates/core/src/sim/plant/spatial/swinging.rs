//! The free modes of a body with three axes: those that drift, and all as the monitor of the envelope takes them.

use super::SpatialPlant;
use crate::attitude::Vector;
use crate::body::Drift;
use crate::body::spatial::Spatial;
use crate::flow::DriftingModes;
use crate::motion::{Phase, State};
use crate::wrench::Wrench;

impl SpatialPlant {
    /// The same with modes whose frequencies drift.
    #[must_use]
    pub fn drifting(mut self, body: &Spatial, drift: Option<&Drift>) -> Self {
        self.drifting = drift.map(|drift| DriftingModes::new(body, drift));
        self
    }

    /// Begins the motion of modes that drift at the departure, under the forces that act from then on.
    pub(super) fn drift_on(&mut self) {
        if let Some(drifting) = &mut self.drifting {
            drifting.depart(self.departed.seconds(), &self.forces);
        }
    }

    /// The free modes at the instant seen last by the size of the rotations that they give the first sensor (rad).
    pub fn swings(&self) -> State {
        let phase = |(phase, shape): (&Phase, &Vector)| {
            let size = shape.norm();
            Phase { displacement: size * phase.displacement, quadrature: size * phase.quadrature }
        };
        let modes = self.state.modes.iter().zip(&self.sensed).map(phase).collect();
        State { modes, ..State::default() }
    }

    /// The modal forces of what an actuator exerts (N/sqrt(kg)).
    pub fn modal_forces(&self, wrench: &Wrench) -> Vec<f64> {
        let change = wrench.rotors.iter().fold(Vector::zeros(), |sum, of| sum + of.axis * of.torque);
        let hub = Vector::from(wrench.hub) - change;
        let given = wrench.forces.iter().copied().chain(std::iter::repeat(0.0));
        self.hub.iter().zip(given).map(|(shape, force)| force + shape.dot(&hub)).collect()
    }
}
