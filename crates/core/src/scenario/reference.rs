//! The table `[reference]`: what metrics compare with.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::document::Fault;
use crate::quantity::{Positive, Time};

/// Levels of other runs that the metrics compare with.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Reference {
    /// Mean envelope without adaptation (rad), for the metric `envelope_reduction`; default: the mean over
    /// the run's own first window.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub envelope: Option<Positive>,
    /// Distance from the goal that counts as settled (rad), for the metrics `goal`, `time_outside_s` and `settling_time_s`.
    /// By default, what is promised: after a manoeuvre a thousandth of its angle, by a PD law 5 % of the distance at which the
    /// goal begins, by a relay its dead zone and its hysteresis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub band: Option<Positive>,
    /// What is asked of the pointing of a body with three axes over a part of the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pointing: Option<Pointing>,
}

/// What is asked of the pointing over a part of the run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Pointing {
    /// From when to when (s) the angle beyond the target counts, for the metric `pointing_rms_rad`.
    pub window: [Time; 2],
    /// What its root mean square is to be at most (rad), for the metric `requirement`; default: nothing is asked.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rms: Option<Positive>,
}

impl Pointing {
    /// Whether a time (s) counts.
    pub fn counts(&self, t: f64) -> bool {
        let [from, to] = self.window.map(Time::get);
        from <= t && t <= to
    }

    /// What is wrong on a body with so many axes: a key, and why.
    pub fn fault(&self, axes: usize) -> Option<Fault> {
        let [from, to] = self.window.map(Time::get);
        if axes == 1 {
            return Some(Fault::new("", "is for a body with three axes: one with one angle has a `band`"));
        }
        let why = format!("must be [from, to] in this order, got [{from}, {to}]");
        (from >= to).then(|| Fault::new("window", why))
    }
}

impl Reference {
    /// Whether the scenario leaves everything out.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}
