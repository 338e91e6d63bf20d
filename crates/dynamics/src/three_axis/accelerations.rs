//! Right-hand side of the equations of motion at an instant: the accelerations.

use flexsc_numerics::attitude::Vector;

use super::constants::centrifugal_terms;
use super::motion::ThreeAxisMotion;
use super::rotors::{RotorStage, RotorState, SlipDirection, change_of_inertia, gimbal};
use super::surroundings::TimedSurroundings;

/// Accelerations of hub, modes and centre of mass at an instant.
#[derive(Clone, Debug)]
pub struct Accelerations {
    /// Angular acceleration of the hub, in its axes (rad/s²).
    pub hub: Vector,
    /// Acceleration of each mode (m sqrt(kg)/s²).
    pub modes: Vec<f64>,
    /// Acceleration of the centre of mass by point forces, in the hub's axes (m/s²).
    pub centre: Vector,
    /// Force of the rotors' imbalance on the body, in the hub's axes (N).
    pub shaking: Vector,
}

impl ThreeAxisMotion {
    /// Returns the accelerations at the current instant, under the loads of the segment.
    pub fn accelerations(&self, surroundings: TimedSurroundings) -> Accelerations {
        self.accelerations_with(&self.slips, surroundings)
    }

    /// Returns the accelerations at the current instant for given slip states of the rotors.
    pub(super) fn accelerations_with(
        &self,
        slips: &[SlipDirection],
        surroundings: TimedSurroundings,
    ) -> Accelerations {
        let (model, view) = (&self.model, &self.view);
        let bearings_now = self.current_bearings(slips);
        let (inertia_change, inertia_rate) = change_of_inertia(self, view);
        let mut torque = self.loads.torque;
        for (arm, q) in self.loads.force_arms.iter().zip(&view.displacements) {
            torque += arm * *q;
        }
        let (mut tide, mut thermal) = (None, Vec::new());
        if let Some((surroundings, since)) = surroundings {
            let t = since + self.time;
            let sky = surroundings.sky_at(t);
            torque += surroundings.torque(&sky, &view.attitude, &(model.inertia + inertia_change));
            tide = if model.changes_inertia { surroundings.tidal_tensor(&sky, &view.attitude) } else { None };
            let forces = surroundings.thermal_forces().iter().enumerate();
            thermal.extend(forces.map(|(index, of)| (of, surroundings.thermal_level(index, t))));
        }
        let mut stage = RotorStage::default();
        stage.at.extend(self.current.rotor_states.iter().map(|rotor: &RotorState| rotor.values));
        stage.rates.resize(stage.at.len(), Vector::zeros());
        stage.modal_rates.extend(view.rates.iter().filter(|_| bearings_now.has_tilts()));
        torque += bearings_now.update_rates(&view.rate, &mut stage);
        let mut rotor_torque = if self.bearings.is_empty() {
            self.loads.rotors.iter().fold(Vector::zeros(), |sum, rotor| sum + rotor.axis * rotor.torque)
        } else {
            bearings_now.stored(stage.rates.iter().map(|rate| rate.x))
        };
        if let Some((_, change)) = gimbal::total_momentum(&self.loads.gimbals, self.time) {
            rotor_torque += change;
        }
        let mut elastic_acceleration = Vector::zeros();
        let mut modes = Vec::with_capacity(model.modes.len());
        for (index, mode) in model.modes.iter().enumerate() {
            let (q, rate) = (view.displacements[index], view.rates[index]);
            let mut force =
                mode.centrifugal_force(&centrifugal_terms(&view.rate)) + bearings_now.force(index, &stage);
            force += self.loads.forces.get(index).copied().unwrap_or(0.0);
            if let Some(tide) = &tide {
                force += mode.tidal_force(tide);
            }
            for (source, level) in &thermal {
                force += source.forces[index] * level;
            }
            if let Some(damping) = &model.coupled_damping {
                force -= view
                    .rates
                    .iter()
                    .enumerate()
                    .map(|(other, of)| damping[(index, other)] * of)
                    .sum::<f64>();
            }
            let w = mode.frequency;
            modes.push(force - w * w * q - 2.0 * mode.damping * w * rate);
            elastic_acceleration += mode.rotation * modes[index];
        }
        let rigid_momentum_rate =
            torque - view.rate.cross(&view.momentum) - rotor_torque - inertia_rate * view.rate;
        // Rate of Gt, which forces the modes, and acceleration of the hub.
        let (forcing, hub) = model.momentum_and_rate(
            &rigid_momentum_rate,
            &elastic_acceleration,
            &(inertia_change + bearings_now.stuck_inertia()),
        );
        for (acceleration, mode) in modes.iter_mut().zip(&model.modes) {
            *acceleration += mode.rotation.dot(&forcing);
        }
        Accelerations {
            hub,
            modes,
            centre: self.loads.com_acceleration,
            shaking: bearings_now.imbalance_force(&stage.imbalance_terms),
        }
    }
}
