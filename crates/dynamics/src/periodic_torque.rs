//! Torque of the environment: a constant, and a part with the orbit's period.

use std::f64::consts::TAU;

use flexsc_numerics::attitude::Vector;

/// Torque in the body's axes: constant + amplitude sin(2 pi t/period + phase) about each.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct PeriodicTorque {
    /// Constant part (N m).
    pub constant: Vector,
    /// Amplitude of the periodic part (N m).
    pub amplitude: Vector,
    /// Period (s).
    pub period: f64,
    /// Phase at the start (rad).
    pub phase: Vector,
}

impl PeriodicTorque {
    /// Returns the torque at a time since the start (N m).
    pub fn at(&self, t: f64) -> Vector {
        let turns = TAU * t / self.period;
        let sine = |axis: usize| self.amplitude[axis] * libm::sin(turns + self.phase[axis]);
        self.constant + Vector::from_fn(|axis, _| sine(axis))
    }

    /// Returns an upper bound of the torque (N m).
    pub fn bound(&self) -> f64 {
        self.constant.norm() + self.amplitude.norm()
    }

    /// Returns the angular frequency of the periodic part (rad/s).
    pub fn frequency(&self) -> f64 {
        TAU / self.period
    }
}
