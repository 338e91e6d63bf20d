//! The ideal observer: the true dominant mode.

use flexsc_numerics::random::Seed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::requirements::require_modes;
use super::sampled::AxisEstimators;
use super::{EstimateOutputs, Estimator, EstimatorContext, EstimatorSpec};
use crate::offers::{EstimatorOffers, Offers};
use crate::requirement::Requirements;

/// An ideal observer.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Truth")]
pub struct IdealObserver {
    /// Angle and rate that the law reads in addition to the dominant mode: `modes` for the measured ones, `hub`, or `rigid`;
    /// default: `modes` for a law that reads the dominant mode, else `hub`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub feeds: Option<EstimateOutputs>,
}

impl EstimatorSpec for IdealObserver {
    fn start(&self, known: &EstimatorContext<'_>, seed: Seed) -> Box<dyn Estimator> {
        AxisEstimators::start(known, seed, |_, _| None)
    }

    fn offers(&self) -> EstimatorOffers {
        EstimatorOffers { dominant_mode: true, needs_reader: true, ..EstimatorOffers::default() }
    }

    fn requires(&self, offers: &Offers, needs: &mut Requirements) {
        require_modes(self, offers, needs);
    }

    fn feeds(&self, dominant: bool) -> EstimateOutputs {
        EstimateOutputs::given_or_default(self.feeds, dominant)
    }
}
