//! Custom actuator: a servo that gives torques in whole steps up to a limit, about each axis.

use flexsc_core::control::actuator::{Actuator, ActuatorSpec, AxisActuatorContext, Demand};
use flexsc_core::numerics::time::Instant;
use flexsc_core::spacecraft::wrench::Wrench;

/// Servo with its largest torque and its step (N m).
#[derive(Copy, Clone, Debug)]
pub struct Servo {
    pub most: f64,
    pub step: f64,
}

/// Run-time state of the servo: demanded and executed torque about each axis (N m), and the inertias (kg m²).
#[derive(Clone, Debug)]
struct Turning(Servo, [[f64; 2]; 3], Vec<f64>);

impl ActuatorSpec for Servo {
    fn start(&self, settings: &[AxisActuatorContext]) -> Box<dyn Actuator> {
        Box::new(Turning(*self, [[0.0; 2]; 3], settings.iter().map(|setting| setting.inertia).collect()))
    }

    fn limit(&self, _: usize) -> Option<f64> {
        Some(self.most)
    }
}

impl Actuator for Turning {
    fn command(&mut self, _: Instant, demands: &[Demand], _: [f64; 3]) {
        let Self(servo, torques, _) = self;
        for (torque, demand) in torques.iter_mut().zip(demands) {
            if let Demand::Torque(asked) = *demand {
                *torque = [asked, ((asked / servo.step).round() * servo.step).clamp(-servo.most, servo.most)];
            }
        }
    }

    fn apply(&self, _: Instant, onto: &mut Wrench) {
        onto.hub.iter_mut().zip(&self.1).for_each(|(hub, [_, given])| *hub += given);
    }

    fn demanded_torque(&self, axis: usize) -> f64 {
        self.1[axis][0]
    }

    fn held_torque(&self, axis: usize) -> f64 {
        self.1[axis][1]
    }

    fn reduced_moment(&self, axis: usize) -> f64 {
        self.1[axis][1] / self.2[axis]
    }

    fn copy(&self) -> Box<dyn Actuator> {
        Box::new(self.clone())
    }
}
