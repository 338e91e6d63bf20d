//! Checks of the keys of a target against each other.

use flexsc_formats::document::ConfigError;
use flexsc_spacecraft::environment::OrbitEnvironment;
use flexsc_spacecraft::manoeuvre::{AttitudeTable, SlewProfile};

use super::{AttitudeTarget, Frame};

impl AttitudeTarget {
    /// Checks the target's keys against each other and the sky; returns the key and the reason.
    pub(super) fn validate(&self, sky: &OrbitEnvironment) -> Option<ConfigError> {
        let (given, missing) = match (&self.primary, &self.secondary) {
            (Some(_), None) => ("primary", "secondary"),
            (None, Some(_)) => ("secondary", "primary"),
            _ => ("", ""),
        };
        if !given.is_empty() {
            return Some(ConfigError::new(
                given,
                format!("needs `{missing}` too: two directions give the attitude"),
            ));
        }
        if self.primary.is_some() && self.frame != Frame::Inertial {
            return Some(ConfigError::new("frame", "must be left out with `primary` and `secondary`"));
        }
        if let Some(fault) = self.target_frame().validate(sky, self.from.get()) {
            return Some(fault);
        }
        let shaped = self.profile != SlewProfile::default();
        if !self.table.is_empty() {
            let other_keys = [
                ("roll", self.roll.get() != 0.0),
                ("pitch", self.pitch.get() != 0.0),
                ("yaw", self.yaw.get() != 0.0),
                ("acceleration", self.acceleration.is_some()),
                ("rate_limit", self.rate_limit.is_some()),
                ("profile", shaped),
                ("command", self.command.is_some()),
                ("duration", self.duration.is_some()),
                ("shaper", self.shaper.is_some()),
            ];
            if let Some((key, _)) = other_keys.into_iter().find(|(_, is_given)| *is_given) {
                return Some(ConfigError::new(
                    key,
                    "must be left out with a `table`, which gives the whole motion",
                ));
            }
            return AttitudeTable::validate(&self.table);
        }
        if let Some(fault) = self.validate_shape() {
            return Some(fault);
        }
        if self.rate_limit.is_some() && self.acceleration.is_none() {
            return Some(ConfigError::new("rate_limit", "needs the `acceleration` at which the rate rises"));
        }
        (shaped && self.acceleration.is_none())
            .then(|| ConfigError::new("profile", "needs the `acceleration` that it shapes"))
    }

    /// Returns the largest rate of the slew or the table in the target's frame (rad/s) with its key, if it has one.
    pub fn fastest(&self) -> Option<(&'static str, f64)> {
        if self.table.len() > 1 {
            return Some(("table", AttitudeTable::new(&self.table).fastest()));
        }
        self.rate_limit.map(|rate| ("rate_limit", rate.get()))
    }
}
