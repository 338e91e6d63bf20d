//! The recurrence of the paper: one mode as a difference equation that is linear in its parameters (\[Timakov14\], page
//! 41 and equation (8)), with the weights W1 to W8.
//!
//! A = 2 exp(-zeta w T) cos(w_d T) and B = exp(-2 zeta w T), of which A is identified and B is not. A pulse counts as
//! an impulse at the end of its cycle, so that one as long as the cycle biases the influence by some 18 % at 0.2 Hz.

mod observer;

use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::{Finite, NonNegative, Positive};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Tracker;

pub use observer::RecurrenceObserver;

/// The recurrence observer as a scenario describes it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Recurrence {
    /// Damping ratio of the mode, which is not identified.
    pub damping: NonNegative,
    /// Weights W1 to W3, for cycles in which no thruster fires.
    pub coast: RecurrenceWeights,
    /// Weights W5 to W7, for cycles in which a thruster fires.
    pub active: RecurrenceWeights,
    /// Frequency gain kappa: W4 times the amplitude of the elastic rate. With the default weights it converges below 0.043.
    pub frequency_gain: NonNegative,
    /// Influence gain: W8 times the absolute value of the excitation from which the influence is identified.
    pub influence_gain: NonNegative,
    /// Amplitude of the elastic rate (rad/s) below which the frequency is not updated.
    pub gate: Positive,
    /// Bounds of the influence, as multiples of its initial value.
    pub influence_bounds: [NonNegative; 2],
    /// Default bounds of a frequency: its initial value divided by this factor, and multiplied by it.
    pub reach: Positive,
}

/// Fractions of an innovation by which the estimates are corrected.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Weights")]
pub struct RecurrenceWeights {
    /// The rigid rate: W1 or W5.
    pub rigid: Finite,
    /// The elastic rate: W2 or W6.
    pub elastic: Finite,
    /// The elastic rate of the next sample, subtracted: W3 or W7.
    pub next: Finite,
}

impl Default for RecurrenceWeights {
    fn default() -> Self {
        let [rigid, elastic, next] = [0.05, 0.2, 0.15].map(|weight| Finite::new(weight).expect("finite"));
        Self { rigid, elastic, next }
    }
}

impl Default for Recurrence {
    fn default() -> Self {
        let from_zero = |value| NonNegative::new(value).expect("0 or more");
        let positive = |value| Positive::new(value).expect("positive");
        Self {
            damping: from_zero(0.005),
            coast: RecurrenceWeights::default(),
            active: RecurrenceWeights::default(),
            frequency_gain: from_zero(0.006),
            influence_gain: from_zero(0.25),
            gate: positive(5e-6),
            influence_bounds: [0.1, 10.0].map(from_zero),
            reach: positive(3.0),
        }
    }
}

impl Recurrence {
    /// Checks the settings against each other, a tracker and the sampling period (s); returns the first inconsistent
    /// key and the reason.
    pub fn validate(&self, tracker: &Tracker, period: f64) -> Option<ConfigError> {
        let trackers = std::slice::from_ref(tracker);
        super::validate(self.damping, self.influence_bounds, self.reach, trackers, 1, period)
    }
}
