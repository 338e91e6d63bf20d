//! Frame of a target: one with a name, or the attitude by two directions.

use flexsc_formats::document::ConfigError;
use flexsc_spacecraft::environment::OrbitEnvironment;
use flexsc_spacecraft::manoeuvre::AttitudeMotion;

use super::Frame;
use super::direction_pair::DirectionPair;

/// Frame relative to which the attitude of a target is given.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum TargetFrame {
    /// Frame with a name.
    Named(Frame),
    /// Attitude with two axes of the body along two directions.
    Directions(DirectionPair),
}

impl TargetFrame {
    /// Inertial axes.
    pub const INERTIAL: Self = Self::Named(Frame::Inertial);

    /// Returns attitude, rate and acceleration of the frame `t` (s) after the start, under a sky that defines it.
    pub fn state_at(&self, sky: &OrbitEnvironment, t: f64) -> AttitudeMotion {
        match self {
            Self::Named(frame) => frame.state_at(sky, t),
            Self::Directions(pair) => pair.state_at(sky, t),
        }
    }

    /// Returns true if the frame rotates under a sky that defines it.
    pub fn rotates(&self, sky: &OrbitEnvironment) -> bool {
        match self {
            Self::Named(frame) => frame.rotates(sky),
            Self::Directions(pair) => pair.rotates(sky),
        }
    }

    /// Returns the name of the frame for messages.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Named(frame) => frame.name(),
            Self::Directions(_) => " from the attitude by two directions",
        }
    }

    /// Checks that the frame is defined under a sky from a time (s) on; returns the key within the target and the reason
    /// if not.
    pub fn validate(&self, sky: &OrbitEnvironment, from: f64) -> Option<ConfigError> {
        match self {
            Self::Named(frame) => frame.validate(sky),
            Self::Directions(pair) => pair.validate(sky, from),
        }
    }
}
