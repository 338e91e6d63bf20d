//! Pulses of jets in groups: for each axis one group that turns the body one way, and one for the other way.

use crate::pulse_width::PulseQuantum;
use crate::vector3::Vector3;

/// Two groups of jets about an axis, and their pulses.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct JetPair {
    /// Acceleration by the group of the positive direction (rad/s²).
    pub acceleration_plus: f64,
    /// Size of the acceleration by the group of the negative direction (rad/s²).
    pub acceleration_minus: f64,
    /// Torque of the group of the positive direction (N m).
    pub torque_plus: f64,
    /// Size of the torque of the group of the negative direction (N m).
    pub torque_minus: f64,
    /// Period of the pulses (s).
    pub period: f64,
    /// Quantisation of pulse lengths.
    pub quantum: PulseQuantum,
}

impl JetPair {
    /// Returns the on-time (s) for a demanded length (s), with the sign of the demand; 0 for a demand of 0 or NaN.
    #[inline]
    fn signed_on_time(&self, demand: f64, length: f64) -> f64 {
        if demand == 0.0 || demand.is_nan() {
            return 0.0;
        }
        let on: f64 = self.quantum.on_time(length, self.period);
        let sign: f64 = 1.0_f64.copysign(demand);
        sign * on
    }

    /// Returns the on-time (s) that changes the rate by a demand (rad/s): positive for the group of the positive direction.
    #[inline]
    pub fn on_time_of_change(&self, change: f64) -> f64 {
        let acceleration: f64 = if change < 0.0 { self.acceleration_minus } else { self.acceleration_plus };
        self.signed_on_time(change, change.abs() / acceleration)
    }

    /// Returns the on-time (s) that gives a demanded mean torque (N m): positive for the group of the positive direction.
    #[inline]
    pub fn on_time_of_torque(&self, torque: f64) -> f64 {
        let most: f64 = if torque < 0.0 { self.torque_minus } else { self.torque_plus };
        self.signed_on_time(torque, torque.abs() / most * self.period)
    }
}

/// Torques about all axes of the two groups of a pair (N m).
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct JetTorques {
    /// Torque of the group of the positive direction.
    pub plus: Vector3,
    /// Torque of the group of the negative direction.
    pub minus: Vector3,
}

impl JetTorques {
    /// Returns the angular impulse (N m s) of an on-time (s), whose sign chooses the group.
    pub fn impulse(&self, on_time: f64) -> Vector3 {
        let torque: Vector3 = if on_time < 0.0 { self.minus } else { self.plus };
        torque.scaled(on_time.abs())
    }
}
