//! The recursive gradient: exact pulses, the sensitivities of the prediction to every parameter, and steps along them that are
//! normalised by their mean square (recursive prediction error method, L. Ljung; the tuning is ours).

mod observer;
mod parameter;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Tracker;
use crate::document::Fault;
use crate::quantity::{Fraction, NonNegative, Positive};

pub use observer::GradientObserver;

/// A gradient observer as a scenario describes it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Gradient {
    /// Damping ratio of the modes, which is not identified.
    pub damping: NonNegative,
    /// Gain of the rigid rate: the part of an innovation that it takes.
    pub rigid_gain: Fraction,
    /// Gain of each elastic rate; default: 0.15 for one mode and 0.1 for several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub elastic_gain: Option<Fraction>,
    /// Rate of the identification, 0 for none. Sufficient for its convergence: below 0.05 over the number of modes.
    pub rate: NonNegative,
    /// While a mode's elastic rate is below this amplitude (rad/s), its frequency learns nothing.
    pub gate: Positive,
    /// Between which multiples of its value at the start an influence is looked for.
    pub influence_bounds: [NonNegative; 2],
    /// A frequency without bounds of its own is looked for from its value divided by this to its value times this.
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
    /// The first key that does not fit the others, these trackers, so many inputs or the period of the samples (s), and what
    /// is wrong with it.
    pub fn inconsistency(&self, trackers: &[Tracker], inputs: usize, period: f64) -> Option<Fault> {
        super::inconsistency(self.damping, self.influence_bounds, self.reach, trackers, inputs, period)
    }
}
