//! A magnetic moment of the body in the field of a dipole along the planet's axis, on a circular orbit (\[Hughes86\]).
//!
//! At the angle u past the ascending node of an orbit of inclination i, and with b = mu/R³, the field in local axes is
//! b (cos u sin i, -cos i, 2 sin u sin i).

use nalgebra::Quaternion;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::orbit::{Orbit, into};
use crate::attitude::{Attitude, Vector, vector};
use crate::quantity::{Finite, Positive};

/// A magnetic moment in the field of a dipole.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Dipole {
    /// Magnetic moment of the body (A m²), in its axes.
    pub moment: [Finite; 3],
    /// Field over the magnetic equator at the orbit's radius R (T), mu/R³: around the Earth mu is 7.8e15 T m³.
    pub strength: Positive,
    /// Inclination of the orbit to the magnetic equator (rad).
    pub inclination: Finite,
    /// Angle from the ascending node at the start (rad).
    #[serde(default)]
    pub from_node: Finite,
    /// Rate of the circular orbit (rad/s).
    pub orbit_rate: Positive,
    /// How the local axes lie at the start, as of a gravity gradient.
    #[serde(default)]
    pub local: Attitude,
}

impl Dipole {
    /// The field in inertial axes (T) at a time since the start (s).
    pub(super) fn field(&self, t: f64) -> Vector {
        let (across, along) = libm::sincos(self.inclination.get());
        let (sin, cos) = libm::sincos(self.from_node.get() + self.orbit_rate.get() * t);
        let local = Vector::new(cos * across, -along, 2.0 * sin * across) * self.strength.get();
        Orbit::new(self.orbit_rate, self.local).inertial(t, &local)
    }

    /// The torque in the body's axes (N m) at a time since the start (s).
    pub(super) fn torque(&self, t: f64, attitude: &Quaternion<f64>) -> Vector {
        vector(&self.moment).cross(&into(attitude, &self.field(t)))
    }

    /// No torque is larger (N m).
    pub(super) fn bound(&self) -> f64 {
        2.0 * self.strength.get() * vector(&self.moment).norm()
    }
}
