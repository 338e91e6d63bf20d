//! Disturbance torques: constant from one time to another.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::quantity::{Finite, NonNegative};
use crate::time::{Instant, Span};

/// A disturbance torque.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Disturbance {
    /// Torque (N m).
    pub torque: Finite,
    /// When it begins (s).
    #[serde(default)]
    pub from: NonNegative,
    /// When it ends (s); left out, with the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<NonNegative>,
}

impl Disturbance {
    /// The instants at which it changes.
    pub fn edges(&self) -> impl Iterator<Item = Instant> {
        [Some(self.from), self.to].into_iter().flatten().map(at)
    }

    /// The torque at an instant (N m), right-continuous.
    pub fn torque(&self, now: Instant) -> f64 {
        let acts = at(self.from) <= now && self.to.is_none_or(|to| now < at(to));
        if acts { self.torque.get() } else { 0.0 }
    }
}

fn at(time: NonNegative) -> Instant {
    Instant::START + Span::from_seconds(time.get())
}
