//! The table `[reference]`: what metrics compare with.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::quantity::Positive;

/// Levels of other runs that the metrics compare with.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Reference {
    /// Mean envelope without adaptation (rad), for the metric `envelope_reduction`; left out, the mean over
    /// the run's own first window.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub envelope: Option<Positive>,
    /// Distance from the goal that counts as settled (rad), for the metrics `goal`, `time_outside_s` and `settling_time_s`.
    /// Left out, what is promised: after a manoeuvre a thousandth of its angle, by a PD law 5 % of the distance at which the
    /// goal begins, by a relay its dead zone and its hysteresis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub band: Option<Positive>,
}

impl Reference {
    /// Whether the scenario leaves everything out.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}
