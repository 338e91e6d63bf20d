//! The recursive gradient: exact pulses, the sensitivities of the prediction to every parameter, and steps along them
//! that are normalised by their mean square (recursive prediction error method, L. Ljung; the tuning is ours).

mod observer;
mod parameter;

use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::{Fraction, NonNegative, Positive};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Tracker;

pub use observer::GradientObserver;

/// A gradient observer as a scenario describes it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Gradient {
    /// Damping ratio of the modes, which is not identified.
    pub damping: NonNegative,
    /// Gain of the rigid rate: the fraction of an innovation by which it is corrected.
    pub rigid_gain: Fraction,
    /// Gain of each elastic rate; default: 0.15 for one mode and 0.1 for several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub elastic_gain: Option<Fraction>,
    /// Rate of the identification; 0 for none. It converges if this is below 0.05 divided by the number of modes.
    pub rate: NonNegative,
    /// Amplitude of a mode's elastic rate (rad/s) below which its frequency is not updated.
    pub gate: Positive,
    /// Bounds of an influence, as multiples of its initial value.
    pub influence_bounds: [NonNegative; 2],
    /// Default bounds of a frequency: its initial value divided by this factor, and multiplied by it.
    pub reach: Positive,
}

impl Default for Gradient {
    fn default() -> Self {
        let fraction = |value| Fraction::new(value).expect("between 0 and 1");
        let from_zero = |value| NonNegative::new(value).expect("0 or more");
        let positive = |value| Positive::new(value).expect("positive");
        Self {
            damping: from_zero(0.005),
            rigid_gain: fraction(0.03),
            elastic_gain: None,
            rate: from_zero(0.02),
            gate: positive(5e-6),
            influence_bounds: [0.2, 5.0].map(from_zero),
            reach: positive(2.0),
        }
    }
}

impl Gradient {
    /// Checks the settings against each other, the trackers, the number of inputs and the sampling period (s); returns
    /// the first inconsistent key and the reason.
    pub fn validate(&self, trackers: &[Tracker], inputs: usize, period: f64) -> Option<ConfigError> {
        super::validate(self.damping, self.influence_bounds, self.reach, trackers, inputs, period)
    }
}
