//! Flexible body in three-axis rotation: inertia, free modes and ideal rotors.

use flexsc_numerics::attitude::Vector;
use nalgebra::{DMatrix, Matrix3};

/// Free mode of the whole body, in axes that follow its total momentum, mass-normalised.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeMode {
    /// Natural frequency W (rad/s).
    pub frequency: f64,
    /// Damping ratio.
    pub damping: f64,
    /// Rotation of the hub per unit of the mode (rad/(m sqrt(kg))).
    pub rotation: Vector,
    /// Change of the inertia tensor per unit of the mode (sqrt(kg) m).
    pub moments: Matrix3<f64>,
}

/// Flexible body in three-axis rotation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FlexibleBody {
    /// Inertia tensor about the centre of mass (kg m²), without the spin inertia of the rotors.
    pub inertia: Matrix3<f64>,
    /// Free modes.
    pub modes: Vec<FreeMode>,
    /// Damping matrix of all modes (1/s) if its off-diagonal entries matter; its diagonal then replaces the modes'
    /// damping ratios.
    pub damping: Option<DMatrix<f64>>,
}

/// Ideal rotor, with h' = u.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Rotor {
    /// Spin axis, a unit vector in the body's axes.
    pub axis: Vector,
    /// Absolute angular momentum about the axis, including the part due to the body's rate (N m s).
    pub momentum: f64,
    /// Torque on the rotor about its axis, of motor and bearing together (N m), constant during a segment.
    pub torque: f64,
}
