//! Small rotations of a three-axis body about a fixed target, with the bounds within which they are computed.

use flexsc_dynamics::three_axis_model::SmallAngleBounds;
use flexsc_numerics::quantity::{Fraction, Positive};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Linear rotation about a fixed target, in closed form, within bounds.
///
/// The rotation of the mean axes about each body axis must stay within both bounds: a run that leaves them ends with an
/// error.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SmallAngles {
    /// Largest rotation from the target about each axis (rad).
    #[serde(default = "largest_angle")]
    pub angle: Fraction,
    /// Largest rate about each axis (rad/s).
    #[serde(default = "largest_rate")]
    pub rate: Positive,
}

fn largest_angle() -> Fraction {
    Fraction::new(0.1).unwrap_or(Fraction::HALF)
}

fn largest_rate() -> Positive {
    Positive::new(0.01).unwrap_or(Positive::ONE)
}

impl From<SmallAngles> for SmallAngleBounds {
    fn from(bounds: SmallAngles) -> Self {
        Self { angle: bounds.angle.get(), rate: bounds.rate.get() }
    }
}

impl Default for SmallAngles {
    fn default() -> Self {
        Self { angle: largest_angle(), rate: largest_rate() }
    }
}
