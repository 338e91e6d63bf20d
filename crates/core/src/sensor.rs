//! How the angle is measured: continuously and exactly, or sampled with noise and a resolution.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::quantity::{Finite, NonNegative};
use crate::random::Stream;
use crate::time::Span;

/// The kinds of angle measurement.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Sensor {
    /// The true angle at every instant: guards trip at the exact crossing.
    #[default]
    Continuous,
    /// A sample at each period, held until the next: guards are tested at samples.
    Sampled(Sampled),
}

/// A sampled angle sensor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sampled {
    /// Period of the samples (s).
    pub period: Span,
    /// Standard deviation of the white noise (rad).
    #[serde(default)]
    pub noise: NonNegative,
    /// Constant error (rad).
    #[serde(default)]
    pub bias: Finite,
    /// Quantum of the output (rad); 0 for none.
    #[serde(default)]
    pub resolution: NonNegative,
}

impl Sensor {
    /// The period of the samples, if the sensor is sampled.
    pub fn period(&self) -> Option<Span> {
        match self {
            Self::Continuous => None,
            Self::Sampled(sampled) => Some(sampled.period),
        }
    }

    /// The measurement of a true angle (rad).
    pub fn measure(&self, angle: f64, noise: &mut Stream) -> f64 {
        match self {
            Self::Continuous => angle,
            Self::Sampled(sampled) => sampled.measure(angle, noise),
        }
    }
}

impl Sampled {
    fn measure(&self, angle: f64, noise: &mut Stream) -> f64 {
        let mut output = angle + self.bias.get();
        if self.noise.get() > 0.0 {
            output += self.noise.get() * noise.normal();
        }
        let quantum = self.resolution.get();
        if quantum > 0.0 { libm::round(output / quantum) * quantum } else { output }
    }
}
