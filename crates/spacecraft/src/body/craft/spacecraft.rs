//! Hub of a spacecraft, as a scenario describes it.

use flexsc_numerics::attitude::{Attitude, tensor, vector};
use flexsc_numerics::quantity::{Finite, Positive};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::appendage::Appendage;
use super::mass::MassProperties;
use crate::body::spatial::NamedPoint;
use crate::body::{InitialMotion, SmallAngles, StartValue};

/// A spacecraft: the rigid hub, to which appendages are clamped.
///
/// Positions are measured from a point O of the user's choice, in the axes of the hub, which are the body's axes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Spacecraft {
    /// Mass of the hub alone (kg).
    pub mass: Positive,
    /// Centre of mass of the hub alone (m).
    #[serde(default)]
    pub centre: [Finite; 3],
    /// Inertia tensor of the hub alone about its centre of mass, with wheels locked in it (kg m²), row by row.
    pub inertia: [[Finite; 3]; 3],
    /// Attitude at the start, a unit quaternion \[w, x, y, z\] that turns vectors of the body into inertial ones, or
    /// `"target"` for that of the target.
    #[serde(default)]
    pub attitude: StartValue<Attitude>,
    /// Rotation vector (rad) from `attitude` to the attitude at the start, in the body's axes, each component from
    /// -2π to 2π; default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub attitude_error: Option<[Finite; 3]>,
    /// Rates of the whole spacecraft at the start (rad/s), in the body's axes, or `"target"` for those of the target;
    /// without vibration they are the rates of the hub.
    #[serde(default)]
    pub rate: StartValue<[Finite; 3]>,
    /// Rates at the start in addition to `rate` (rad/s), in the body's axes, each at most 1000; default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate_error: Option<[Finite; 3]>,
    /// Small rotations about a fixed target, in closed form, in place of any rotation; `{}` takes both defaults.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub small_angles: Option<SmallAngles>,
    /// Whether runs keep the full damping matrix of the free modes, as linear tools always do; default: if its
    /// off-diagonal terms are not negligible.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub whole_damping: Option<bool>,
    /// Factor on the natural frequencies of all appendages; default: 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frequency_factor: Option<Positive>,
    /// Named points of the hub, at which jets and sensors are mounted; default: one at O, named `hub`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub points: Vec<NamedPoint>,
}

impl Spacecraft {
    /// Returns the attitude and rates at the start, as written.
    pub const fn initial_motion(&self) -> InitialMotion {
        InitialMotion::new((self.attitude, self.attitude_error), (self.rate, self.rate_error))
    }

    /// Returns the factor on the natural frequencies of an appendage: its own times that of all.
    pub fn frequency_factor(&self, appendage: &Appendage) -> f64 {
        let value = |factor: Option<Positive>| factor.map_or(1.0, Positive::get);
        value(appendage.frequency_factor) * value(self.frequency_factor)
    }

    /// Returns the mass properties of the hub.
    pub(super) fn mass_properties(&self) -> MassProperties {
        MassProperties { mass: self.mass.get(), centre: vector(&self.centre), inertia: tensor(&self.inertia) }
    }

    /// Returns the points of the hub: one at O, if none is named.
    pub(super) fn hub_points(&self) -> Vec<NamedPoint> {
        if self.points.is_empty() {
            return vec![NamedPoint { name: "hub".to_owned(), position: <[Finite; 3]>::default() }];
        }
        self.points.clone()
    }
}
