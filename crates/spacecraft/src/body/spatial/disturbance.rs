//! Torque of the environment: a constant, and a part with the orbit's period.

use std::f64::consts::TAU;

use flexsc_numerics::attitude::{Vector, vector};
use flexsc_numerics::quantity::{Finite, Positive};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A torque in the body's axes: constant + amplitude sin(2 pi t/period + phase) about each.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Periodic")]
pub struct PeriodicTorque {
    /// Constant part (N m).
    #[serde(default)]
    pub constant: [Finite; 3],
    /// Amplitude of the periodic part (N m).
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

impl PeriodicTorque {
    /// Returns the torque at a time since the start (N m).
    pub fn at(&self, t: f64) -> Vector {
        let turns = TAU * t / self.period.get();
        let sine = |axis: usize| self.amplitude[axis].get() * libm::sin(turns + self.phase[axis].get());
        vector(&self.constant) + Vector::from_fn(|axis, _| sine(axis))
    }

    /// Returns an upper bound of the torque (N m).
    pub fn bound(&self) -> f64 {
        vector(&self.constant).norm() + vector(&self.amplitude).norm()
    }

    /// Returns the angular frequency of the periodic part (rad/s).
    pub fn frequency(&self) -> f64 {
        TAU / self.period.get()
    }
}
