//! Measures of the attitude error: by the vector part of the quaternion, or by Rodrigues parameters.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::belief::Belief;

/// How a rotation by an angle a from the target is converted into an error. For small angles both equal the angle.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Measure {
    /// 2 sin(a/2): twice the vector part of the quaternion.
    #[default]
    Quaternion,
    /// 4 tan(a/4): four times the modified Rodrigues parameters.
    Rodrigues,
}

impl Measure {
    /// Returns true for the default.
    pub fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// Returns the error about the axis of a state estimate (rad).
    pub fn of(self, belief: &Belief) -> f64 {
        match self {
            Self::Quaternion => belief.angle,
            Self::Rodrigues => {
                let half = 0.5 * belief.whole;
                let cosine = f64::sqrt((1.0 - half * half).max(0.0));
                belief.angle * 2.0 / (1.0 + cosine)
            }
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
            let whole = 2.0 * libm::sin(0.5 * angle);
            let belief = Belief { angle: share * whole, whole, ..Belief::default() };
            assert_eq!(Measure::Quaternion.of(&belief), share * whole);
            let found = Measure::Rodrigues.of(&belief);
            assert!((found - share * 4.0 * libm::tan(0.25 * angle)).abs() < 1e-14, "{angle} {found}");
        }
    }
}
