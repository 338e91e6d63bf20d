//! Observed coordinates: the effect of the modes at a place of the structure.

use flexsc_dynamics::AxisState;
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

impl Output {
    /// Returns the coordinate in a state.
    pub fn evaluate(&self, state: &AxisState) -> f64 {
        let modes = self.modes.iter().zip(&state.modes);
        modes.fold(self.rigid.get() * state.rigid_angle, |sum, (w, mode)| sum + w.get() * mode.displacement)
    }

    /// Returns the rate of the coordinate in a state, for modes of the given frequencies (rad/s).
    pub fn rate_of(&self, state: &AxisState, frequencies: &[f64]) -> f64 {
        let modes = self.modes.iter().zip(&state.modes).zip(frequencies);
        modes.fold(self.rigid.get() * state.rigid_rate, |sum, ((weight, mode), w)| {
            sum + weight.get() * w * mode.quadrature
        })
    }
}
