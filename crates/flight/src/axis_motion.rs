//! Inputs of a law about an axis: the estimated motion and its reference.

use crate::square_root::sqrt;

/// Estimated motion about an axis.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct AxisMotion {
    /// Angle from the target (rad): of three axes, this component of the rotation vector.
    pub angle: f64,
    /// Length of that vector (rad); 0 of a body with one angle.
    pub total_angle: f64,
    /// Rate (rad/s).
    pub rate: f64,
    /// Commanded change of the rigid rate that is not yet executed (rad/s).
    pub queued_rate: f64,
    /// Displacement of the dominant mode (rad).
    pub displacement: f64,
    /// Rate of that displacement (rad/s).
    pub displacement_rate: f64,
    /// Natural frequency of the dominant mode (rad/s).
    pub frequency: f64,
}

/// Reference about an axis.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct AxisReference {
    /// Angle from the target (rad).
    pub angle: f64,
    /// Rate (rad/s).
    pub rate: f64,
    /// Feedforward acceleration (rad/s²).
    pub acceleration: f64,
}

/// Returns the length of the rotation vector (rad) with these components (rad).
#[inline]
pub fn total_angle(roll: f64, pitch: f64, yaw: f64) -> f64 {
    sqrt(roll * roll + pitch * pitch + yaw * yaw)
}
