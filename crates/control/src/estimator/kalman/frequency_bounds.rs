//! Rules of filters that estimate natural frequencies: their bounds, and the damping of their modes.

use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::Positive;

use super::FrequencyTracking;
use crate::offers::Offers;
use crate::requirement::{Requirements, Rule};

impl FrequencyTracking {
    /// Checks the bounds of a frequency ratio; returns a key within the filter and the reason.
    pub(in crate::estimator) fn inconsistency(&self) -> Option<ConfigError> {
        let ([low, high], ratio) = (self.bounds.map(Positive::get), self.ratio.get());
        if low >= high {
            let why = format!("must be [low, high] in this order, got [{low}, {high}]");
            return Some(ConfigError::new("bounds", why));
        }
        let why = || format!("must lie within the bounds [{low}, {high}], got {ratio}");
        (!(low..=high).contains(&ratio)).then(|| ConfigError::new("ratio", why()))
    }

    /// Adds the requirement of modes that no damping matrix couples.
    pub(in crate::estimator) fn require_separate_modes(offers: &Offers, needs: &mut Requirements) {
        if let Some(matrix) = &offers.body.damping_matrix {
            let why = "couples modes, and a filter of their frequencies predicts each mode on its own: use `kalman`";
            needs.require_elsewhere(Rule::DampingMatrix, false, matrix, why);
        }
    }
}
