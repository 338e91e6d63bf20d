//! Shape of a mode at a point of the structure.

use flexsc_numerics::quantity::Finite;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The shape of a mode at a point.
#[derive(Copy, Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Shape {
    /// Displacement of the point per unit of the modal displacement (1/sqrt(kg)).
    #[serde(default)]
    pub translation: [Finite; 3],
    /// Rotation at the point per unit of the modal displacement (rad/(m sqrt(kg))).
    #[serde(default)]
    pub rotation: [Finite; 3],
}
