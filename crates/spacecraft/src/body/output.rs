//! Observed coordinates: the effect of the modes at a place of the structure.

use flexsc_dynamics::axis_model::AxisOutput;
use flexsc_numerics::quantity::Finite;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A coordinate that is observed in addition to the hub's angle: y = rigid x_r + sum modes\[i\] x_i.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// Name, such as `tip`.
    pub name: String,
    /// Unit.
    #[serde(default = "radians")]
    pub unit: String,
    /// Weight of the rigid angle.
    #[serde(default)]
    pub rigid: Finite,
    /// Weight of each mode's displacement, in the order of the modes.
    pub modes: Vec<Finite>,
}

pub(super) fn radians() -> String {
    "rad".to_owned()
}

impl From<&Output> for AxisOutput {
    fn from(output: &Output) -> Self {
        let Output { name, unit, rigid, modes } = output.clone();
        Self { name, unit, rigid, modes }
    }
}

impl From<&AxisOutput> for Output {
    fn from(output: &AxisOutput) -> Self {
        let AxisOutput { name, unit, rigid, modes } = output.clone();
        Self { name, unit, rigid, modes }
    }
}
