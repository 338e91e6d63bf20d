//! Sine functions of time, as parts of a torque.

use flexsc_dynamics::sine::SineTorque;
use flexsc_numerics::quantity::{Finite, Positive};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// amplitude sin(frequency t + phase), t from the start of the run.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sine {
    /// Amplitude (N m).
    pub amplitude: Finite,
    /// Frequency (rad/s).
    pub frequency: Positive,
    /// Phase at the start of the run (rad); pi/2 makes a cosine.
    #[serde(default)]
    pub phase: Finite,
}

impl From<&Sine> for SineTorque {
    fn from(sine: &Sine) -> Self {
        Self { amplitude: sine.amplitude.get(), frequency: sine.frequency.get(), phase: sine.phase.get() }
    }
}
