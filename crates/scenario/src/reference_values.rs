//! Table `[reference]`: reference values of the metrics.

use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::{Positive, Time};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Reference values for the metrics.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Reference {
    /// Mean envelope without adaptation (rad), for the metric `envelope_reduction`; default: the mean over the run's own first
    /// window.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub envelope: Option<Positive>,
    /// Distance from the goal that counts as settled (rad), for the metrics `goal`, `time_outside_s` and `settling_time_s`.
    /// Default: after a manoeuvre, a thousandth of its angle; for a PD law, 5 % of the distance at the start of the goal; for a
    /// relay, the sum of its dead zone and hysteresis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub band: Option<Positive>,
    /// Pointing requirement of a body with three axes over a part of the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pointing: Option<Pointing>,
}

/// Pointing requirement over a part of the run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Pointing {
    /// Start and end (s) of the interval in which the pointing error is assessed, for the metric `pointing_rms_rad`.
    pub window: [Time; 2],
    /// Largest allowed root mean square of the pointing error (rad), for the metric `requirement`; default: no requirement.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rms: Option<Positive>,
}

impl Pointing {
    /// Returns true if a time (s) lies in the window.
    pub fn includes(&self, t: f64) -> bool {
        let [from, to] = self.window.map(Time::get);
        from <= t && t <= to
    }

    /// Checks the requirement for a body with `axes` axes; returns the error at its key.
    pub fn validate(&self, axes: usize) -> Option<ConfigError> {
        let [from, to] = self.window.map(Time::get);
        if axes == 1 {
            return Some(ConfigError::new(
                "",
                "is for a body with three axes: use `band` for a body with one angle",
            ));
        }
        let why = format!("must be [from, to] in this order, got [{from}, {to}]");
        (from >= to).then(|| ConfigError::new("window", why))
    }
}

impl Reference {
    /// Returns true if no reference value is given.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}
