//! From what laws command to what the actuator is asked for: accelerations become torques J a + w x (J w + h).

use nalgebra::Matrix3;

use super::Command;
use crate::actuator::Demand;
use crate::attitude::Vector;
use crate::belief::Belief;

/// What it takes to turn the body as laws command.
#[derive(Clone, Debug, PartialEq)]
pub struct TorqueDistribution {
    /// The inertia tensor, without the rotors' own about their axes (kg m²); of a body with one angle the first element
    /// alone counts.
    inertia: Matrix3<f64>,
}

impl TorqueDistribution {
    /// For a body with one angle and this inertia (kg m²).
    pub fn of_one_angle(inertia: f64) -> Self {
        Self { inertia: Matrix3::from_diagonal_element(inertia) }
    }

    /// For a body with three axes and this inertia tensor (kg m²).
    pub fn of_three_axes(inertia: Matrix3<f64>) -> Self {
        Self { inertia }
    }

    /// What is demanded about each axis, of a body that is believed to move so, and whose rotors store this momentum in its
    /// axes (N m s).
    pub fn demands(
        &self,
        commands: [Command; 3],
        beliefs: &[Belief],
        stored: impl FnOnce() -> [f64; 3],
    ) -> [Demand; 3] {
        let torques = if commands.iter().any(|command| matches!(command, Command::Acceleration(_))) {
            self.torques(commands, beliefs, stored())
        } else {
            [0.0; 3]
        };
        let mut demands = [Demand::Torque(0.0); 3];
        for ((demand, command), turning) in demands.iter_mut().zip(commands).zip(torques) {
            *demand = match command {
                Command::Torque(torque) => Demand::Torque(torque),
                Command::Change(change) => Demand::Change(change),
                Command::Moment(moment) => Demand::Moment(moment),
                Command::Acceleration(_) => Demand::Torque(turning),
            };
        }
        demands
    }

    fn torques(&self, commands: [Command; 3], beliefs: &[Belief], stored: [f64; 3]) -> [f64; 3] {
        let mut rate = Vector::zeros();
        rate.iter_mut().zip(beliefs).for_each(|(rate, belief)| *rate = belief.rate);
        let wanted =
            commands.map(|command| if let Command::Acceleration(wanted) = command { wanted } else { 0.0 });
        let momentum = self.inertia * rate + Vector::from(stored);
        (self.inertia * Vector::from(wanted) + rate.cross(&momentum)).into()
    }
}
