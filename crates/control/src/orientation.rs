//! Orientation of a body with one axis or three.

use flexsc_flight_precision::Precision;
use flexsc_numerics::attitude::{Vector, rotation, rotation_vector};
use flexsc_numerics::flight_types::to_quaternion;
use nalgebra::Quaternion;

/// Orientation of a body.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum Orientation {
    /// Angle of a one-axis body (rad).
    Angle(f64),
    /// Attitude of a three-axis body: the rotation from body axes to inertial axes.
    Attitude(Quaternion<f64>),
}

impl Orientation {
    /// Angle 0 of a one-axis body.
    pub const ZERO_ANGLE: Self = Self::Angle(0.0);

    /// Returns the attitude; `None` for an angle.
    pub fn attitude(&self) -> Option<Quaternion<f64>> {
        if let Self::Attitude(q) = self { Some(*q) } else { None }
    }

    /// Returns the origin of a first difference: angle 0, or the attitude itself.
    #[must_use]
    pub fn difference_origin(&self) -> Self {
        self.attitude().map_or(Self::ZERO_ANGLE, Self::Attitude)
    }

    /// Returns the rotation vector from another orientation to this one (rad); for one angle, the difference about the first axis.
    #[inline]
    pub fn error_from(&self, other: &Self) -> [f64; 3] {
        match (self, other) {
            (Self::Attitude(q), Self::Attitude(goal)) => rotation_vector(goal, q).into(),
            (Self::Angle(angle), Self::Angle(goal)) => [angle - goal, 0.0, 0.0],
            // All orientations of a run are of the same kind.
            _ => [f64::NAN; 3],
        }
    }

    /// Returns the rotation vector to another orientation (rad), as a flight computer of this precision computes it; for one angle, the
    /// difference about the first axis.
    pub fn angles_to(&self, other: &Self, precision: Precision) -> [f64; 3] {
        match (self, other) {
            (Self::Attitude(from), Self::Attitude(to)) => {
                let angles = precision.rotation(&to_quaternion(from), &to_quaternion(to));
                [angles.x, angles.y, angles.z]
            }
            _ => other.error_from(self),
        }
    }

    /// Returns the orientation measured with these angles (rad): the first angle itself, or the attitude with these
    /// small rotations.
    #[must_use]
    #[inline]
    pub fn rotated_by(&self, angles: [f64; 3]) -> Self {
        match self {
            Self::Angle(_) => Self::Angle(angles[0]),
            Self::Attitude(q) => Self::Attitude(q * rotation(&Vector::from(angles))),
        }
    }
}
