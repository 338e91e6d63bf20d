//! Requirement on the contrast (MTF) of an image: `quantity = "mtf"`, which linear tools judge and runs do not.

use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::{Positive, Share};

use super::requirement::{ErrorAxis, Requirement, given};

/// Word of the quantity.
pub const MTF: &str = "mtf";

/// Least contrast that the motion of a line of sight has to leave an image at a spatial frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct ContrastRequirement {
    /// Name of the requirement.
    pub name: String,
    /// Key of the requirement, such as `requirement[0]`.
    pub key: String,
    /// Index of the line of sight, and its point.
    pub line: (usize, String),
    /// Axis of the body about which the line of sight moves; `None` for the worst.
    pub axis: Option<ErrorAxis>,
    /// Spatial frequency (cycles/rad).
    pub spatial_frequency: f64,
    /// Length of the exposure (s); `None` for one without end.
    pub exposure: Option<f64>,
    /// Least contrast.
    pub least: f64,
}

impl Requirement {
    /// Returns true for a requirement on the contrast of an image.
    pub fn is_of_contrast(&self) -> bool {
        self.quantity.as_deref() == Some(MTF)
    }

    /// Returns the keys of a contrast, each with whether it is given.
    pub(super) fn contrast_keys(&self) -> [(&'static str, bool); 3] {
        [
            ("spatial_frequency", self.spatial_frequency.is_some()),
            ("exposure", self.exposure.is_some()),
            ("least", self.least.is_some()),
        ]
    }

    /// Returns the requirement on the contrast of an image by the line of sight that it names.
    ///
    /// # Errors
    /// A key that is missing, and one of another quantity.
    pub(super) fn contrast(
        &self,
        key: &str,
        line: (usize, String),
    ) -> Result<ContrastRequirement, ConfigError> {
        let of_others: Vec<(&'static str, bool)> = self
            .index_keys()
            .into_iter()
            .filter(|(key, _)| !["point", "axis"].contains(key))
            .chain(self.scope_keys())
            .chain(self.time_keys())
            .chain([
                ("limit", self.limit.is_some()),
                ("level", self.level.is_some()),
                ("interpretation", self.interpretation.is_some()),
                ("confidence", self.confidence.is_some()),
            ])
            .collect();
        if let Some(key) = given(&of_others) {
            let why = match key {
                "limit" => "is a largest value, and the contrast `mtf` has a least one: write `least`",
                "window" => "is that of an index: the `exposure` of an image is its own key",
                _ => "is not for the contrast `mtf`, which has one value for the linear loop",
            };
            return Err(ConfigError::new(key, why));
        }
        let absent: Vec<&str> = self
            .contrast_keys()
            .into_iter()
            .filter(|(key, is_given)| !is_given && *key != "exposure")
            .map(|(key, _)| key)
            .collect();
        let (Some(frequency), Some(least)) = (self.spatial_frequency, self.least) else {
            let (first, others) =
                absent.split_first().map_or(("least", &[][..]), |(first, rest)| (*first, rest));
            let also = others.first().map_or_else(String::new, |other| format!(", and so is `{other}`"));
            let why = format!(
                "is missing{also}: the contrast `mtf` is at least `least` at a `spatial_frequency`, such as \"0.5 cycles/arcsec\""
            );
            return Err(ConfigError::new(first, why));
        };
        Ok(ContrastRequirement {
            name: self.name.clone(),
            key: key.to_owned(),
            line,
            axis: self.axis,
            spatial_frequency: frequency.get(),
            exposure: self.exposure.map(Positive::get),
            least: Share::get(least),
        })
    }
}

impl ContrastRequirement {
    /// Returns the names that the outputs of the line of sight may have: about each axis of the body that counts.
    pub fn outputs(&self) -> Vec<String> {
        let axes = [ErrorAxis::X, ErrorAxis::Y, ErrorAxis::Z];
        let counts = axes.into_iter().filter(|axis| self.axis.is_none_or(|own| own == *axis));
        counts.map(|axis| format!("line_of_sight{}_{}", self.line.0, axis.letter())).collect()
    }
}
