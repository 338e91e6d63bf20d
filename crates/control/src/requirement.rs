//! Requirements of a part on the other parts of a scenario, each with the text of its error.
//!
//! A kind states its requirements in its own file, as conditions on the `Offers` of all parts. The crate `scenario` asks every
//! part, and reports all requirements that are not met.

use flexsc_formats::document::ConfigError;

/// Error text for an array where a body with one angle needs a number.
pub const ONE_NUMBER: &str = "must be one number for a body with one angle, got one for each of three axes";

/// Error text for a part at a point that may move.
pub const OFF_HUB: &str =
    "must be a point of the hub: with drives or hinges, the motion of points on appendages is not computed";

/// Error text for wheels whose motion depends on that of a body with modes that do not act back.
pub const ROTATION: &str = "is for wheels on a `[spacecraft]`: the modes of a `[body.spatial]` do not act back on its rotation, \
                            against which wheels turn";

/// Errors of the parts of a scenario: of their own keys, and unmet requirements on the other parts.
#[derive(Clone, Debug, Default)]
pub struct Requirements {
    part: String,
    invalid: Vec<ConfigError>,
    wrong_axes: Vec<ConfigError>,
    unmet: Vec<ConfigError>,
}

impl Requirements {
    /// Sets the key of the part whose requirements follow.
    pub fn set_part(&mut self, key: String) {
        self.part = key;
    }

    /// Adds a requirement of the part at `key` within it; empty for the part itself.
    pub fn require(&mut self, is_met: bool, key: &str, why: &str) {
        self.require_with(is_met, key, || why.to_owned());
    }

    /// Adds a requirement of the part at `key` within it, with a text that is only composed if the requirement is not met.
    pub fn require_with(&mut self, is_met: bool, key: &str, why: impl FnOnce() -> String) {
        if !is_met {
            self.unmet.push(ConfigError::new(key, why()).within(&self.part));
        }
    }

    /// Adds a requirement of the part at a key of the scenario outside the part.
    pub fn require_elsewhere(&mut self, is_met: bool, key: &str, why: &str) {
        if !is_met {
            self.unmet.push(ConfigError::new(key, why));
        }
    }

    /// Adds the requirement, at `key` within the part, of a body with as many axes as the part is for.
    pub fn require_axes(&mut self, is_met: bool, key: &str, why: &str) {
        if !is_met {
            self.wrong_axes.push(ConfigError::new(key, why).within(&self.part));
        }
    }

    /// Adds the error that a check of the part's own keys has found, with its key within the part.
    pub fn report(&mut self, error: Option<ConfigError>) {
        self.invalid.extend(error.map(|error| error.within(&self.part)));
    }

    /// Returns the errors of the parts' own keys.
    pub fn invalid(&self) -> &[ConfigError] {
        &self.invalid
    }

    /// Returns the errors of parts that are for another number of axes than the body has.
    pub fn wrong_axes(&self) -> &[ConfigError] {
        &self.wrong_axes
    }

    /// Returns the errors of the other requirements. They presuppose parts for the axes of the body.
    pub fn unmet(&self) -> &[ConfigError] {
        &self.unmet
    }
}
