//! Requirements and offers of the law of a scenario, about all axes.

use super::{AttitudeErrorMeasure, EstimateNeeds, LawKind, PlacedLaw};
use crate::offers::{LawOffers, LawPlace, Offers};
use crate::requirement::Requirements;

impl LawKind {
    /// Adds the requirements of the law about each axis, in each of its stages or modes.
    pub fn add_requirements(&self, offers: &Offers, needs: &mut Requirements) {
        needs.set_part(self.key());
        if matches!(self, Self::Stages(_)) {
            needs.report(self.validate());
        }
        let observes = offers.estimator.is_some_and(|of| of.dominant_mode || of.is_assessed_only);
        for axis in 0..offers.body.axes {
            for placed in self.laws_about(axis) {
                let PlacedLaw { key, law, is_per_axis, .. } = &placed;
                if *is_per_axis && axis == 0 {
                    needs.set_part(key.split(".roll").next().unwrap_or_default().to_owned());
                    offers.require_three_axes(needs, "", "");
                }
                needs.set_part(key.clone());
                needs.report(law.validate());
                let place = LawPlace { axis, is_per_axis: *is_per_axis };
                law.requires(&place, &offers.serving_law(|kind| placed.selects(kind)), needs);
                needs.require(
                    observes || law.needs() != EstimateNeeds::DominantMode,
                    "extra",
                    "feeds back the dominant mode, which an `[estimator]` that acts at samples (`truth`, `kalman`, \
                     `extended_kalman`, `unscented_kalman`, `adaptive`) tells, and there is none",
                );
            }
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
    needs.require_axes(is_met, "error", "applies only to rotations about three axes");
}
