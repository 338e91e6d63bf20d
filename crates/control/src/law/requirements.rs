//! Requirements and offers of the law of a scenario, about all axes.

use super::{AttitudeErrorMeasure, EstimateNeeds, LawKind};
use crate::offers::{LawOffers, LawPlace, Offers};
use crate::requirement::{Requirements, Rule};

impl LawKind {
    /// Adds the requirements of the law about each axis.
    pub fn add_requirements(&self, offers: &Offers, needs: &mut Requirements) {
        let is_per_axis = matches!(self, Self::PerAxis(_));
        if is_per_axis {
            needs.set_part(self.key());
            offers.require_three_axes(needs, Rule::AxisLaws, "", "");
        }
        let observes = offers.estimator.is_some_and(|of| of.dominant_mode || of.is_assessed_only);
        for axis in 0..offers.body.axes {
            let law = self.about(axis);
            needs.set_part(self.key_about(axis));
            needs.report(Rule::Law, law.inconsistency());
            law.requires(&LawPlace { axis, is_per_axis }, offers, needs);
            needs.require(
                Rule::DominantMode,
                observes || law.needs() != EstimateNeeds::DominantMode,
                "extra",
                "feeds back the dominant mode, which an `[estimator]` that acts at samples (`truth`, `kalman`, \
                 `extended_kalman`, `unscented_kalman`, `adaptive`) tells, and there is none",
            );
        }
    }

    /// Returns the offers of the law to the other parts of a scenario. A law of another crate may have states.
    pub fn offers(&self) -> LawOffers {
        let offers = (**self).offers();
        LawOffers { has_states: offers.has_states || matches!(self, Self::Own(_)), ..offers }
    }
}

/// Adds the requirement of three axes for a measure of the error other than the default.
pub(super) fn require_measure(measure: AttitudeErrorMeasure, offers: &Offers, needs: &mut Requirements) {
    let is_met = offers.body.axes == 3 || measure == AttitudeErrorMeasure::default();
    needs.require(Rule::Law, is_met, "error", "applies only to rotations about three axes");
}
