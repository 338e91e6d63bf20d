//! Conversion of the laws' commands to demands on the actuator: accelerations become torques J a + w x (J w + h).

use flexsc_flight::torque_distribution;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::flight_types::{to_matrix3, to_vector3};
use nalgebra::Matrix3;

use super::Command;
use crate::actuator::Demand;
use crate::state_estimate::{StateEstimate, estimated_rates};

/// Distribution of commands to demands, with the inertia in the model.
#[derive(Clone, Debug, PartialEq)]
pub struct TorqueDistribution {
    /// Inertia tensor, without the rotors' own about their axes (kg m²); of a one-axis body only the first element is
    /// used.
    inertia: Matrix3<f64>,
}

impl TorqueDistribution {
    /// Creates the distribution of a one-axis body with this inertia (kg m²).
    pub fn for_one_axis(inertia: f64) -> Self {
        Self { inertia: Matrix3::from_diagonal_element(inertia) }
    }

    /// Creates the distribution of a three-axis body with this inertia tensor (kg m²).
    pub fn for_three_axes(inertia: Matrix3<f64>) -> Self {
        Self { inertia }
    }

    /// Returns the inertia tensor in the model (kg m²).
    pub fn inertia(&self) -> &Matrix3<f64> {
        &self.inertia
    }

    /// Returns the demand about each axis, for the estimated motion of a body whose rotors store the momentum that `stored`
    /// returns for the estimated rate (rad/s; N m s, body axes).
    pub fn demands(
        &self,
        commands: [Command; 3],
        state_estimates: &[StateEstimate],
        stored: impl FnOnce([f64; 3]) -> [f64; 3],
    ) -> [Demand; 3] {
        let torques = if commands.iter().any(|command| matches!(command, Command::Acceleration(_))) {
            let rate = estimated_rates(state_estimates);
            self.torques(commands, rate, stored(rate))
        } else {
            [0.0; 3]
        };
        let mut demands = [Demand::Torque(0.0); 3];
        for ((demand, command), torque) in demands.iter_mut().zip(commands).zip(torques) {
            *demand = match command {
                Command::Torque(torque) => Demand::Torque(torque),
                Command::Change(change) => Demand::Change(change),
                Command::Moment(moment) => Demand::Moment(moment),
                Command::Acceleration(_) => Demand::Torque(torque),
            };
        }
        demands
    }

    fn torques(&self, commands: [Command; 3], rate: [f64; 3], stored: [f64; 3]) -> [f64; 3] {
        let accelerations =
            commands.map(
                |command| if let Command::Acceleration(acceleration) = command { acceleration } else { 0.0 },
            );
        let [acceleration, rate, stored] =
            [accelerations, rate, stored].map(|v| to_vector3(&Vector::from(v)));
        let torque = torque_distribution::torque(&to_matrix3(&self.inertia), &acceleration, &rate, &stored);
        [torque.x, torque.y, torque.z]
    }
}
