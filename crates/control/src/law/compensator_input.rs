//! Inputs of a compensator about three axes, by their names.

use std::fmt;

use flexsc_numerics::attitude::AXES;

/// Input of a compensator about three axes.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum CompensatorInput {
    /// Component of the rotation vector from the estimated attitude to the target (rad): `roll`.
    Angle(usize),
    /// Component of the vector part of the quaternion of that rotation: `quaternion_x`.
    VectorPart(usize),
    /// Error of the rate about an axis (rad/s): `roll_rate`.
    Rate(usize),
    /// Speed of a reaction wheel (rad/s): `wheel0_speed`.
    WheelSpeed(usize),
}

impl CompensatorInput {
    /// Names that an input may have, for errors.
    pub const ACCEPTED: &str = "`roll`, `pitch`, `yaw`, `quaternion_x`, `quaternion_y`, `quaternion_z`, `roll_rate`, \
                                `pitch_rate`, `yaw_rate`, or `wheel0_speed` and so on";

    /// Returns the input of this name, if there is one.
    pub fn from_name(name: &str) -> Option<Self> {
        let axis = |name: &str| AXES.iter().position(|axis| *axis == name);
        if let Some(axis) = axis(name) {
            return Some(Self::Angle(axis));
        }
        if let Some(component) = name.strip_prefix("quaternion_") {
            return ["x", "y", "z"].iter().position(|own| *own == component).map(Self::VectorPart);
        }
        if let Some(axis) = name.strip_suffix("_rate").and_then(axis) {
            return Some(Self::Rate(axis));
        }
        let wheel = name.strip_prefix("wheel")?.strip_suffix("_speed")?.parse().ok()?;
        // One name for one wheel: no `wheel01_speed`.
        Some(Self::WheelSpeed(wheel)).filter(|input| input.to_string() == name)
    }

    /// Returns true for a component of the attitude error.
    pub fn is_attitude(self) -> bool {
        matches!(self, Self::Angle(_) | Self::VectorPart(_))
    }
}

impl fmt::Display for CompensatorInput {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Angle(axis) => out.write_str(AXES[*axis]),
            Self::VectorPart(component) => write!(out, "quaternion_{}", ["x", "y", "z"][*component]),
            Self::Rate(axis) => write!(out, "{}_rate", AXES[*axis]),
            Self::WheelSpeed(wheel) => write!(out, "wheel{wheel}_speed"),
        }
    }
}
