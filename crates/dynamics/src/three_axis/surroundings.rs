//! Environment of a body: torque, tidal forces on the modes, and thermal forces.

use flexsc_numerics::attitude::Vector;
use nalgebra::{Matrix3, Quaternion};

/// Surroundings of a body at an instant, for any attitude: quantities are 0 where they are absent or have no torque.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct SkyAt {
    /// Torque that acts whatever the attitude, in the body's axes (N m).
    pub torque: Vector,
    /// Direction to the planet's centre in inertial axes, a unit vector.
    pub nadir: Vector,
    /// Gravity per unit of distance from the centre of mass, mu/R³ (1/s²).
    pub tide: f64,
    /// Magnetic field in inertial axes (T).
    pub field: Vector,
    /// Direction to the Sun in inertial axes, a unit vector.
    pub sun: Vector,
    /// Pressure of sunlight relative to that at 1 au.
    pub pressure: f64,
    /// Part of the Sun's disc in view.
    pub part_in_view: f64,
    /// Velocity of the body relative to the air in inertial axes (m/s).
    pub flow: Vector,
    /// Density of the air (kg/m³).
    pub density: f64,
}

/// Torques and forces on a body that depend on time or attitude within a segment: of the environment and of periodic
/// disturbances.
pub trait Surroundings {
    /// Returns the surroundings at a time `t` since the start (s), from which torques follow for any attitude.
    fn sky_at(&self, t: f64) -> SkyAt;

    /// Returns the torque under a sky in the body's axes (N m), for the attitude of the hub and the present inertia of the body
    /// (kg m²).
    fn torque(&self, sky: &SkyAt, attitude: &Quaternion<f64>, inertia: &Matrix3<f64>) -> Vector;

    /// Returns the part of the torque under a sky (N m) that depends on where appendages that turn are, in addition to `torque`.
    fn panel_torque(&self, _sky: &SkyAt, _attitude: &Quaternion<f64>, _panels: &PanelPlaces<'_>) -> Vector {
        Vector::zeros()
    }

    /// Returns the tidal tensor under a sky (1/s²), whose elementwise product with the change of inertia per unit of a mode sums
    /// to the force on the mode; `None` without such a force.
    fn tidal_tensor(&self, sky: &SkyAt, attitude: &Quaternion<f64>) -> Option<Matrix3<f64>>;

    /// Returns the thermal forces on the modes.
    fn thermal_forces(&self) -> &[ThermalForces] {
        &[]
    }

    /// Returns the level of the thermal forces of an index at a time `t` since the start (s).
    fn thermal_level(&self, _index: usize, _t: f64) -> f64 {
        0.0
    }

    /// Returns an upper bound of the torque's magnitude (N m).
    fn bound(&self) -> f64;

    /// Returns the rate at which the torque varies by itself, for a body at rest (rad/s).
    fn frequency(&self) -> f64;

    /// Returns the rate at which the torque varies by itself from a time `t` since the start (s) until the next change of
    /// the load (rad/s); it exceeds `frequency` only in short intervals between such changes.
    fn frequency_at(&self, _t: f64) -> f64 {
        self.frequency()
    }
}

/// Places of the appendages of a body at an instant, where drives or hinges turn any of them.
#[derive(Copy, Clone, Debug)]
pub struct PanelPlaces<'a> {
    /// Centre of mass of the body from its origin, in the body's axes (m).
    pub centre: Vector,
    /// Rotation from the axes of each appendage to the body's.
    pub axes: &'a [Matrix3<f64>],
}

/// Environment, and the time of the start of a segment or step since the start of the run (s).
pub type TimedSurroundings<'a> = Option<(&'a dyn Surroundings, f64)>;

/// Thermal forces on the modes with one common level.
#[derive(Clone, Debug, PartialEq)]
pub struct ThermalForces {
    /// Force on each mode at a level of 1 (N/sqrt(kg)).
    pub forces: Vec<f64>,
}
