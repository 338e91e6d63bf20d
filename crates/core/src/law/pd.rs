//! The sampled PD law, u = -k_p (x - x_goal) - k_d (x' - x'_goal), held between its samples.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Cause, Control, Goal, Guards, Hold, Phase};
use crate::belief::Belief;
use crate::quantity::{NonNegative, Positive};
use crate::time::{Instant, Span};

/// The PD law. It takes over when the goal's manoeuvre ends.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Pd {
    /// Proportional gain (N m/rad).
    pub k_p: NonNegative,
    /// Derivative gain (N m s/rad).
    pub k_d: NonNegative,
    /// Period of its samples (s).
    pub period: Span,
    /// Largest torque (N m); left out, there is no limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limit: Option<Positive>,
    #[serde(skip)]
    active: bool,
}

impl Control for Pd {
    fn decide(&mut self, now: Instant, _: Cause, goal: &Goal, belief: &Belief) -> Hold {
        self.active = now >= goal.from;
        if !self.active {
            return Hold { torque: 0.0, until: Some(goal.from), guards: Guards::NONE };
        }
        let (angle, rate) = goal.at(now);
        let torque = -self.k_p.get() * (belief.angle - angle) - self.k_d.get() * (belief.rate - rate);
        let limit = self.limit.map_or(f64::INFINITY, Positive::get);
        Hold { torque: torque.clamp(-limit, limit), until: Some(now + self.period), guards: Guards::NONE }
    }

    fn state(&self) -> Phase {
        if self.active { Phase::Feedback } else { Phase::Open }
    }
}
