//! Bounds of the frequency ratios of filters that estimate natural frequencies.

use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::Positive;

use super::FrequencyTracking;

impl FrequencyTracking {
    /// Checks the bounds of a frequency ratio; returns a key within the filter and the reason.
    pub(super) fn validate(&self) -> Option<ConfigError> {
        let ([low, high], ratio) = (self.bounds.map(Positive::get), self.ratio.get());
        if low >= high {
            let why = format!("must be [low, high] in this order, got [{low}, {high}]");
            return Some(ConfigError::new("bounds", why));
        }
        let why = || format!("must lie within the bounds [{low}, {high}], got {ratio}");
        (!(low..=high).contains(&ratio)).then(|| ConfigError::new("ratio", why()))
    }
}
