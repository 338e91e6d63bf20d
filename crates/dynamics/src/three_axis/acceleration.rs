//! Right-hand side of the equations of motion at an instant: the accelerations.

use flexsc_numerics::attitude::Vector;

use super::bearing::{RotorStage, RotorState, SlipDirection};
use super::flow::ThreeAxisMotion;
use super::gimbal;
use super::model::{Surroundings, centrifugal_terms};
use super::slipping::inertia_change;

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
    pub fn accelerations(&self, around: Option<(&dyn Surroundings, f64)>) -> Accelerations {
        self.accelerated(&self.slips, around)
    }

    /// Returns the accelerations at the current instant for given slip states of the rotors.
    pub(super) fn accelerated(
        &self,
        slips: &[SlipDirection],
        around: Option<(&dyn Surroundings, f64)>,
    ) -> Accelerations {
        let (model, seen) = (&self.model, &self.seen);
        let bearings_now = self.current_bearings(slips);
        let (shape, change) = inertia_change(self, seen);
        let mut torque = self.acting.torque;
        for (lever, q) in self.acting.levers.iter().zip(&seen.displacements) {
            torque += lever * *q;
        }
        let (mut tide, mut warm) = (None, (&[][..], 0.0));
        if let Some((around, since)) = around {
            let t = since + self.now;
            torque += around.torque(t, &seen.attitude, &(model.inertia + shape));
            tide = if model.stretches { around.tidal_tensor(t, &seen.attitude) } else { None };
            warm = (around.thermal_forces(), t);
        }
        let mut spun = RotorStage::default();
        spun.at.extend(self.here.spins.iter().map(|spin: &RotorState| spin.sums));
        spun.now.resize(spun.at.len(), Vector::zeros());
        torque += bearings_now.update_rates(&seen.rate, &mut spun);
        let mut slipping = if self.bearings.is_empty() {
            self.acting.rotors.iter().fold(Vector::zeros(), |sum, rotor| sum + rotor.axis * rotor.torque)
        } else {
            bearings_now.stored(spun.now.iter().map(|now| now.x))
        };
        if let Some((_, change)) = gimbal::sum(&self.acting.gimbals, self.now) {
            slipping += change;
        }
        let mut pushed = Vector::zeros();
        let mut modes = Vec::with_capacity(model.modes.len());
        for (index, mode) in model.modes.iter().enumerate() {
            let (q, rate) = (seen.displacements[index], seen.rates[index]);
            let mut force = mode.centrifugal_force(&centrifugal_terms(&seen.rate))
                + bearings_now.force(index, &spun.waves);
            force += self.acting.forces.get(index).copied().unwrap_or(0.0);
            if let Some(tide) = &tide {
                force += mode.tidal_force(tide);
            }
            for heated in warm.0 {
                force += heated.forces[index] * heated.level(warm.1);
            }
            if let Some(beside) = &model.beside {
                force -=
                    seen.rates.iter().enumerate().map(|(other, of)| beside[(index, other)] * of).sum::<f64>();
            }
            let w = mode.frequency;
            modes.push(force - w * w * q - 2.0 * mode.damping * w * rate);
            pushed += mode.rotation * modes[index];
        }
        let turning = torque - seen.rate.cross(&seen.momentum) - slipping - change * seen.rate;
        // Rate of Gt, which forces the modes, and acceleration of the hub.
        let (felt, hub) = model.momentum_and_rate(&turning, &pushed, &(shape + bearings_now.stuck_inertia()));
        for (acceleration, mode) in modes.iter_mut().zip(&model.modes) {
            *acceleration += mode.rotation.dot(&felt);
        }
        Accelerations {
            hub,
            modes,
            centre: self.acting.push,
            shaking: bearings_now.imbalance_force(&spun.waves),
        }
    }
}
