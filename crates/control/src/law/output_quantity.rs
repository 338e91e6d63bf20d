//! Quantity that a compensator commands.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Quantity that the output commands.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "Commands")]
pub enum OutputQuantity {
    /// A torque (N m; for a wheel, units of its command).
    #[default]
    Torque,
    /// An angular acceleration (rad/s²): that of the reference is added, and the sum is multiplied by the whole inertia.
    Acceleration,
}
