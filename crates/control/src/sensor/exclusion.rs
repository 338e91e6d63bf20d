//! Exclusion angles of a star tracker: the bright bodies that blind it.

use std::f64::consts::PI;

use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::quantity::{NonNegative, Positive};
use flexsc_spacecraft::environment::BrightBody;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::SensorKind;
use crate::offers::Offers;
use crate::one_or_many::OneOrMany;
use crate::requirement::Requirements;

/// Angles between the boresight and bright bodies below which a star tracker gives no measurement.
#[derive(Copy, Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Exclusion {
    /// Least angle to the Sun's centre (rad); default: the Sun does not blind it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sun: Option<Positive>,
    /// Least angle to the Moon's centre (rad), at the scenario's `epoch`; default: the Moon does not blind it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub moon: Option<Positive>,
    /// Least angle to the limb of the orbit's planet (rad); default: the planet does not blind it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limb: Option<NonNegative>,
}

impl Exclusion {
    /// Iterates over the bright bodies that blind the star tracker, each with its least angle (rad).
    pub fn limits(&self) -> impl Iterator<Item = (BrightBody, f64)> {
        let all = [
            (BrightBody::Sun, self.sun.map(Positive::get)),
            (BrightBody::Moon, self.moon.map(Positive::get)),
            (BrightBody::Limb, self.limb.map(NonNegative::get)),
        ];
        all.into_iter().filter_map(|(body, limit)| Some((body, limit?)))
    }

    /// Checks the angles; returns the first inconsistent key and the reason.
    pub(super) fn validate(&self) -> Option<ConfigError> {
        let (body, limit) = self.limits().find(|(_, limit)| *limit >= PI)?;
        let why = format!("must be below pi, which is blinded in every direction, got {limit}");
        Some(ConfigError::new(format!("exclusion.{}", body.name()), why))
    }

    /// Adds the requirements of the exclusion angles on the environment.
    pub(super) fn requires(&self, offers: &Offers, needs: &mut Requirements) {
        let around = &offers.environment;
        needs.require(
            self.sun.is_none() || around.sun,
            "exclusion.sun",
            "is an angle to `environment.sun`, and there is none",
        );
        needs.require(
            self.moon.is_none() || around.moon,
            "exclusion.moon",
            "is an angle to the Moon at the date: it needs the scenario's `epoch` and an `[environment]`",
        );
        needs.require(
            self.limb.is_none() || around.orbit,
            "exclusion.limb",
            "is an angle to the limb of the planet of `environment.orbit`, and there is none",
        );
        needs.require(
            self.moon.is_none() || around.is_below_moon,
            "exclusion.moon",
            "is an angle to the Moon as seen from an orbit about the Earth, within 1e8 m of its centre",
        );
    }
}

impl OneOrMany<SensorKind> {
    /// Iterates over the star trackers with exclusion angles: index among the sensors, boresight in the axes of the mount,
    /// and the angles.
    pub fn exclusions(&self) -> impl Iterator<Item = (usize, Vector, Exclusion)> {
        self.iter().enumerate().filter_map(|(index, sensor)| match sensor {
            SensorKind::StarTracker(tracker) => Some((index, tracker.body_direction(2), tracker.exclusion?)),
            _ => None,
        })
    }
}
