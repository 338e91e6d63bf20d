//! Environment of a body: torque, tidal forces on the modes, and thermal forces.
//!
//! The level of a thermal force approaches a target exponentially, and the target changes stepwise.

use flexsc_numerics::attitude::Vector;
use nalgebra::{Matrix3, Quaternion};

/// Torques and forces on a body that depend on time or attitude within a segment: of the environment and of periodic
/// disturbances.
pub trait Surroundings {
    /// Returns the torque in the body's axes (N m) at a time `t` since the start (s), for the attitude of the hub and
    /// the present inertia of the body (kg m²).
    fn torque(&self, t: f64, attitude: &Quaternion<f64>, inertia: &Matrix3<f64>) -> Vector;

    /// Returns the tidal tensor (1/s²), whose elementwise product with the change of inertia per unit of a mode sums
    /// to the force on the mode; `None` without such a force.
    fn tidal_tensor(&self, t: f64, attitude: &Quaternion<f64>) -> Option<Matrix3<f64>>;

    /// Returns the thermal forces on the modes.
    fn thermal_forces(&self) -> &[ThermalForces] {
        &[]
    }

    /// Returns an upper bound of the torque's magnitude (N m).
    fn bound(&self) -> f64;

    /// Returns the rate at which the torque varies by itself, for a body at rest (rad/s).
    fn frequency(&self) -> f64;
}

/// Environment, and the time of the start of a segment or step since the start of the run (s).
pub type TimedSurroundings<'a> = Option<(&'a dyn Surroundings, f64)>;

/// Thermal forces on the modes with one common level and time constant.
#[derive(Clone, Debug, PartialEq)]
pub struct ThermalForces {
    /// Force on each mode at a level of 1 (N/sqrt(kg)).
    pub forces: Vec<f64>,
    /// Time constant (s).
    time_constant: f64,
    /// Changes of the target: time (s), level at that time, and target from then on.
    changes: Vec<[f64; 3]>,
}

impl ThermalForces {
    /// Creates the forces at level 0; `aims` gives the time since the start (s) and the target of each change.
    pub fn new(forces: Vec<f64>, time_constant: f64, aims: impl IntoIterator<Item = [f64; 2]>) -> Self {
        let mut heated = Self { forces, time_constant, changes: Vec::new() };
        for [from, aim] in aims {
            let level = heated.level(from);
            heated.changes.push([from, level, aim]);
        }
        heated
    }

    /// Returns the level at a time `t` since the start (s).
    pub fn level(&self, t: f64) -> f64 {
        let past = self.changes.partition_point(|[from, ..]| *from <= t);
        past.checked_sub(1).map_or(0.0, |last| {
            let [from, level, aim] = self.changes[last];
            aim + (level - aim) * libm::exp((from - t) / self.time_constant)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_go_on_from_where_they_are() {
        let heated = ThermalForces::new(vec![1.0], 10.0, [[5.0, -1.0], [15.0, 0.0]]);
        assert_eq!([heated.level(0.0), heated.level(5.0)], [0.0, 0.0]);
        let cold = libm::exp(-1.0) - 1.0;
        assert!((heated.level(15.0) - cold).abs() < 1e-16);
        assert!((heated.level(25.0) - cold * libm::exp(-1.0)).abs() < 1e-16);
    }
}
