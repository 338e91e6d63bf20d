//! A magnetic moment of the body in the field of its planet: the environment's field, or on a circular orbit that of a
//! dipole along the planet's axis (\[Hughes86\]).
//!
//! On such an orbit, at the angle u past the ascending node, with inclination i and b = mu/R³, the field in local axes
//! is b (cos u sin i, -cos i, 2 sin u sin i).

use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::{Attitude, Vector, vector};
use flexsc_numerics::quantity::{Finite, Positive};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::orbit::Orbit;

/// A magnetic moment in the field of a dipole.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Dipole {
    /// Magnetic moment of the body (A m²), in its axes.
    pub moment: [Finite; 3],
    /// Field over the magnetic equator at the radius R of a circular orbit (T), mu/R³; for the Earth mu is 7.8e15 T m³.
    /// Default: the environment's magnetic field.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub strength: Option<Positive>,
    /// Inclination of that orbit to the magnetic equator (rad).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inclination: Option<Finite>,
    /// Angle from the ascending node at the start (rad).
    #[serde(default, skip_serializing_if = "is_zero")]
    pub from_node: Finite,
    /// Rate of that orbit (rad/s).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub orbit_rate: Option<Positive>,
    /// Orientation of the local axes at the start, as for a gravity gradient.
    #[serde(default, skip_serializing_if = "Attitude::is_identity")]
    pub local: Attitude,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks for a reference")]
fn is_zero(angle: &Finite) -> bool {
    *angle == Finite::ZERO
}

/// Field of a dipole along the planet's axis, on a circular orbit.
#[derive(Copy, Clone, Debug, PartialEq)]
pub(super) struct AxialDipole {
    strength: f64,
    inclination: f64,
    from_node: f64,
    /// Rate of the orbit (rad/s).
    pub rate: f64,
    orbit: Orbit,
}

impl AxialDipole {
    /// Returns the field in inertial axes (T) at a time since the start (s).
    pub fn at(&self, t: f64) -> Vector {
        let (across, along) = libm::sincos(self.inclination);
        let (sin, cos) = libm::sincos(self.from_node + self.rate * t);
        let local = Vector::new(cos * across, -along, 2.0 * sin * across) * self.strength;
        self.orbit.to_inertial(t, &local)
    }
}

impl Dipole {
    /// Returns the dipole's own field, if its keys are given.
    pub(super) fn own_field(&self) -> Option<AxialDipole> {
        let (strength, inclination, rate) = (self.strength?, self.inclination?, self.orbit_rate?);
        Some(AxialDipole {
            strength: strength.get(),
            inclination: inclination.get(),
            from_node: self.from_node.get(),
            rate: rate.get(),
            orbit: Orbit::new(rate, self.local),
        })
    }

    /// Returns the key and the reason, if the field is given twice or is missing.
    pub(super) fn validate(&self, on_orbit: bool, in_field: bool) -> Option<ConfigError> {
        let keys = [
            ("strength", self.strength.is_some()),
            ("inclination", self.inclination.is_some()),
            ("orbit_rate", self.orbit_rate.is_some()),
        ];
        if on_orbit {
            let other_keys =
                [("from_node", self.from_node != Finite::ZERO), ("local", !self.local.is_identity())];
            if let Some((key, _)) = keys.into_iter().chain(other_keys).find(|(_, is_given)| *is_given) {
                return Some(ConfigError::new(key, "follows from the environment's `orbit`: leave it out"));
            }
            let why = "needs a field: give the environment a `magnetic_field`";
            return (!in_field).then(|| ConfigError::new("moment", why));
        }
        let (key, _) = keys.into_iter().find(|(_, is_given)| !is_given)?;
        Some(ConfigError::new(key, "must be given where the environment has no `orbit`"))
    }

    /// Returns an upper bound of the torque (N m), in the dipole's own field or in one of strength `field` (T) at most.
    pub(super) fn bound(&self, field: f64) -> f64 {
        self.strength.map_or(field, |strength| 2.0 * strength.get()) * vector(&self.moment).norm()
    }
}
