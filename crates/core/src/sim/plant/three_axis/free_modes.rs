//! Free modes of a three-axis body: drifting ones, and all modes in the form that the monitor of the envelope takes.

use flexsc_dynamics::{AxisState, ModeState};
use flexsc_numerics::attitude::Vector;
use flexsc_spacecraft::body::Drift;
use flexsc_spacecraft::body::spatial::Spatial;
use flexsc_spacecraft::flow::DriftingModes;
use flexsc_spacecraft::wrench::Wrench;

use super::ThreeAxisPlant;

impl ThreeAxisPlant {
    /// Returns the plant with drifting modal frequencies, if `drift` is given.
    #[must_use]
    pub fn drifting(mut self, body: &Spatial, drift: Option<&Drift>) -> Self {
        self.drifting = drift.map(|drift| DriftingModes::new(body, drift));
        self
    }

    /// Begins a motion segment of drifting modes at the current start, under the modal forces from then on.
    pub(super) fn drift_on(&mut self) {
        if let Some(drifting) = &mut self.drifting {
            drifting.depart(self.segment_start.seconds(), &self.forces);
        }
    }

    /// Returns the free modes at the current instant, scaled to the size of their rotations of the first sensor (rad).
    pub fn swings(&self) -> AxisState {
        let phase = |(phase, shape): (&ModeState, &Vector)| {
            let size = shape.norm();
            ModeState { displacement: size * phase.displacement, quadrature: size * phase.quadrature }
        };
        let modes = self.state.modes.iter().zip(&self.sensor_rotations).map(phase).collect();
        AxisState { modes, ..AxisState::default() }
    }

    /// Returns the modal forces of an actuator's wrench (N/sqrt(kg)).
    pub fn modal_forces(&self, wrench: &Wrench) -> Vec<f64> {
        let change = wrench.rotors.iter().fold(Vector::zeros(), |sum, of| sum + of.axis * of.torque);
        let hub = Vector::from(wrench.hub) - change;
        let given = wrench.forces.iter().copied().chain(std::iter::repeat(0.0));
        self.torque_rotations.iter().zip(given).map(|(shape, force)| force + shape.dot(&hub)).collect()
    }
}
