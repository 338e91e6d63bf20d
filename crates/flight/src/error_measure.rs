//! Measures of the attitude error: by the vector part of the quaternion, or by Rodrigues parameters.

use crate::trigonometry::{sin, tan};

/// Conversion of a rotation by an angle a from the target to an error. For small angles both equal the angle.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum ErrorMeasure {
    /// 2 sin(a/2): twice the vector part of the quaternion.
    Quaternion,
    /// 4 tan(a/4): four times the modified Rodrigues parameters.
    Rodrigues,
}

impl ErrorMeasure {
    /// Returns the error (rad) about an axis, of a rotation vector with this component (rad) and this length (rad), which is 0
    /// of a body with one angle.
    #[inline]
    pub fn error(self, component: f64, length: f64) -> f64 {
        // Estimates about single axes may add up to more than half a turn.
        let angle: f64 = if length < core::f64::consts::PI { length } else { core::f64::consts::PI };
        if angle == 0.0 {
            return component;
        }
        let measure: f64 = match self {
            Self::Quaternion => 2.0 * sin(0.5 * angle),
            Self::Rodrigues => 4.0 * tan(0.25 * angle),
        };
        component * (measure / angle)
    }
}
