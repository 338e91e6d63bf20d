//! No law: the body moves as the manoeuvre and the disturbances drive it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Control, Phase};

/// Open loop.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Open {}

impl Control for Open {
    fn state(&self) -> Phase {
        Phase::Open
    }
}
