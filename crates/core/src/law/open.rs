//! No law: the body moves as the manoeuvre and the disturbances drive it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Cause, Control, Goal, Guards, Hold, Phase};
use crate::belief::Belief;
use crate::time::Instant;

/// Open loop.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Open {}

impl Control for Open {
    fn decide(&mut self, _: Instant, _: Cause, _: &Goal, _: &Belief) -> Hold {
        Hold { torque: 0.0, until: None, guards: Guards::NONE }
    }

    fn state(&self) -> Phase {
        Phase::Open
    }
}
