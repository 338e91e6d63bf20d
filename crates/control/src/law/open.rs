//! The open loop: no feedback, so that only the manoeuvre and the disturbances drive the body.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Authority, Cause, Control, Goal, Hold, Phase, Reads, Rule};
use crate::belief::Belief;
use crate::time::Instant;

/// Open loop.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Open {}

impl Rule for Open {
    fn start(&self, _: &Authority) -> Box<dyn Control> {
        self.copy()
    }

    fn reads(&self) -> Reads {
        Reads::Nothing
    }
}

impl Control for Open {
    fn decide(&mut self, _: Instant, _: Cause, _: &Goal, _: &Belief) -> Hold {
        Hold::NONE
    }

    fn state(&self) -> Phase {
        Phase::Open
    }

    fn copy(&self) -> Box<dyn Control> {
        Box::new(self.clone())
    }
}
