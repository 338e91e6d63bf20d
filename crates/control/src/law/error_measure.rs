//! Measures of the attitude error: by the vector part of the quaternion, or by Rodrigues parameters.

use flexsc_flight::error_measure::ErrorMeasure;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::state_estimate::StateEstimate;

/// How a rotation by an angle a from the target is converted into an error. For small angles both equal the angle.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "Measure")]
pub enum AttitudeErrorMeasure {
    /// 2 sin(a/2): twice the vector part of the quaternion.
    #[default]
    Quaternion,
    /// 4 tan(a/4): four times the modified Rodrigues parameters.
    Rodrigues,
}

impl AttitudeErrorMeasure {
    /// Returns true for the default.
    pub fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// Returns the error about the axis of a state estimate (rad).
    pub fn error(self, state_estimate: &StateEstimate) -> f64 {
        self.flight().error(state_estimate.angle, state_estimate.total_angle)
    }

    /// Returns the measure as flight code has it.
    pub fn flight(self) -> ErrorMeasure {
        match self {
            Self::Quaternion => ErrorMeasure::Quaternion,
            Self::Rodrigues => ErrorMeasure::Rodrigues,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_are_the_angle_for_small_ones_and_differ_for_large_ones() {
        // Rotation by 1.2 rad about (3, 0, 4)/5.
        for (angle, share) in [(1.2, 0.6), (1.2, 0.8), (-1e-4, 0.6), (3.1, 1.0)] {
            let estimated = StateEstimate {
                angle: share * angle,
                total_angle: f64::abs(angle),
                ..StateEstimate::default()
            };
            let found = AttitudeErrorMeasure::Quaternion.error(&estimated);
            assert!((found - share * 2.0 * libm::sin(0.5 * angle)).abs() < 1e-15, "{angle} {found}");
            let found = AttitudeErrorMeasure::Rodrigues.error(&estimated);
            assert!((found - share * 4.0 * libm::tan(0.25 * angle)).abs() < 1e-14, "{angle} {found}");
        }
    }
}
