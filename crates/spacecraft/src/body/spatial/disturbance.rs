//! Torque of the environment: a constant, and a part with the orbit's period.

use flexsc_dynamics::periodic_torque::PeriodicTorque;
use flexsc_numerics::attitude::vector;
use flexsc_numerics::quantity::{Finite, Positive};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A torque in the body's axes: constant + amplitude sin(2 pi t/period + phase) about each.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Periodic {
    /// Constant part (N m).
    #[serde(default)]
    pub constant: [Finite; 3],
    /// Amplitude of the periodic part (N m), about each axis: amplitude sin(2 pi t/period + phase).
    #[serde(default)]
    pub amplitude: [Finite; 3],
    /// Period (s); about 5560 s for a station in a low orbit.
    #[serde(default = "orbit")]
    pub period: Positive,
    /// Phase at the start (rad).
    #[serde(default)]
    pub phase: [Finite; 3],
}

fn orbit() -> Positive {
    Positive::new(5560.0).unwrap_or(Positive::ONE)
}

impl From<&Periodic> for PeriodicTorque {
    fn from(key: &Periodic) -> Self {
        Self {
            constant: vector(&key.constant),
            amplitude: vector(&key.amplitude),
            period: key.period.get(),
            phase: vector(&key.phase),
        }
    }
}
