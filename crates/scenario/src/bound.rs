//! Table `[[bound]]`: ranges of an output of the linear body, which `flexsc bound` proves or refutes.

use std::collections::BTreeMap;

use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::{Finite, NonNegative, Positive};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Claim that an output of the linear body stays within limits, from every state at the start and under every input
/// of given ranges. The control loop does not act in it, and a run does not read it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Bound")]
pub struct BoundSpec {
    /// Output of the linear model, such as `rate` about one axis and `yaw_rate` about three.
    pub output: String,
    /// True if the output is without the rigid motion.
    #[serde(default)]
    pub elastic: bool,
    /// Limits \[low, high\] of the output, in its unit; default: none, and the range is computed alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limits: Option<[Finite; 2]>,
    /// End of the interval of time from the start (s); default: the `duration`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub until: Option<Positive>,
    /// Range \[low, high\] of states at the start, by the names of the linear model, in their units; `displacements`
    /// and `rates` stand for all modes. Other states are 0.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub start: BTreeMap<String, [Finite; 2]>,
    /// Range \[low, high\] of inputs that are constant in time, such as `torque_yaw`.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub constant_inputs: BTreeMap<String, [Finite; 2]>,
    /// Range \[low, high\] within which inputs vary in time in any way, such as `torque_yaw`.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub varying_inputs: BTreeMap<String, [Finite; 2]>,
    /// Largest deviation of each natural frequency, as a part of its value.
    #[serde(default)]
    pub frequency_error: NonNegative,
    /// Largest deviation of each damping ratio, as a part of its value.
    #[serde(default)]
    pub damping_error: NonNegative,
}

impl BoundSpec {
    /// Checks the values against each other; returns the inconsistent key and the reason.
    pub(super) fn validate(&self) -> Option<ConfigError> {
        if let Some(fault) = self.limits.and_then(|limits| unordered("limits", limits)) {
            return Some(fault);
        }
        let tables = [
            ("start", &self.start),
            ("constant_inputs", &self.constant_inputs),
            ("varying_inputs", &self.varying_inputs),
        ];
        let ranges =
            tables.into_iter().flat_map(|(table, ranges)| ranges.iter().map(move |range| (table, range)));
        let mut faults =
            ranges.filter_map(|(table, (name, range))| unordered(&format!("{table}.{name}"), *range));
        if let Some(fault) = faults.next() {
            return Some(fault);
        }
        let errors = [("frequency_error", self.frequency_error), ("damping_error", self.damping_error)];
        let large = errors.into_iter().find(|(_, error)| error.get() >= 1.0);
        large.map(|(key, error)| {
            ConfigError::new(key, format!("must be a part of the value below 1, got {}", error.get()))
        })
    }
}

/// Returns the fault of a range that does not go from low to high.
fn unordered(key: &str, range: [Finite; 2]) -> Option<ConfigError> {
    let [low, high] = range.map(Finite::get);
    (low > high)
        .then(|| ConfigError::new(key, format!("must be [low, high] in this order, got [{low}, {high}]")))
}
