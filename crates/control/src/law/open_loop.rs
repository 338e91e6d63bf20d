//! The open loop: no feedback, so that only the manoeuvre and the disturbances drive the body.

use flexsc_numerics::time::Instant;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    Authority, ControlOutput, DecisionCause, EstimateNeeds, Law, LawSpec, LawState, Phase, Setpoint,
};
use crate::offers::LawOffers;
use crate::part::Part;
use crate::state_estimate::StateEstimate;

/// Open loop.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Open {}

impl LawSpec for Open {
    fn start(&self, _: &Authority) -> Box<dyn Law> {
        self.copy()
    }

    fn offers(&self) -> LawOffers {
        let offers = LawOffers::new(None, EstimateNeeds::Nothing);
        LawOffers { is_open: true, has_single_precision: true, ..offers }
    }
}

impl Part for Open {}

impl Law for Open {
    fn decide(&mut self, _: Instant, _: DecisionCause, _: &Setpoint, _: &StateEstimate) -> ControlOutput {
        ControlOutput::NONE
    }

    fn state(&self) -> LawState<'_> {
        LawState::new(Phase::Open)
    }

    fn copy(&self) -> Box<dyn Law> {
        Box::new(self.clone())
    }
}
