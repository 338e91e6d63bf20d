//! Gravity gradient on an orbit (\[Hughes86\]).
//!
//! With the rate n of the orbit and the direction o of the nadir, the gravity relative to the centre of mass is n² (3 o
//! o' - 1) r. The torque on a body is 3 n² o x J o. The force on a mode that changes the inertia by J1 per unit is n²
//! (tr J1/2 - 3/2 o' J1 o), which is the integral of its shape times that field. On a Kepler orbit n² is mu/R³.

use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::{Attitude, Vector};
use flexsc_numerics::quantity::Positive;
use nalgebra::Matrix3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::OrbitEnvironment;
use super::orbit::{Orbit, transformed};

/// Gravity gradient.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GravityGradient {
    /// Rate of a circular orbit (rad/s); default: the environment's orbit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub orbit_rate: Option<Positive>,
    /// Orientation of that orbit's local axes at the start, a unit quaternion \[w, x, y, z\] that turns vectors of the local
    /// axes (x along the velocity, y against the orbit's normal, z nadir) into inertial ones; default: the inertial axes.
    #[serde(default, skip_serializing_if = "Attitude::is_identity")]
    pub local: Attitude,
}

impl GravityGradient {
    /// Returns the key and the reason, if the orbit is given twice or is missing.
    pub(super) fn fault(&self, on_orbit: bool) -> Option<ConfigError> {
        if !on_orbit {
            let why = "must be given where the environment has no `orbit`";
            return self.orbit_rate.is_none().then(|| ConfigError::new("orbit_rate", why));
        }
        let twice = [("orbit_rate", self.orbit_rate.is_some()), ("local", !self.local.is_identity())];
        let key = twice.into_iter().find(|(_, is_given)| *is_given)?.0;
        Some(ConfigError::new(key, "follows from the environment's `orbit`: leave it out"))
    }

    /// Returns the direction to the planet in inertial axes and n² (1/s²) at a time since the start (s), on an orbit of its own.
    pub(super) fn own_pull(&self, t: f64) -> Option<(Vector, f64)> {
        let rate = self.orbit_rate?;
        Some((Orbit::new(rate, self.local).to_inertial(t, &Vector::z()), rate.get() * rate.get()))
    }

    /// Returns the torque (N m) on a body of an inertia (kg m²), from the nadir direction and n² (1/s²), in the body's axes.
    pub(super) fn torque(nadir: &Vector, tide: f64, inertia: &Matrix3<f64>) -> Vector {
        nadir.cross(&transformed(inertia, nadir)) * (3.0 * tide)
    }

    /// Returns the tensor (1/s²) whose element-wise product with J1, summed, is the force on a mode, from the nadir direction and
    /// n² (1/s²), in the body's axes.
    pub(super) fn modal_tensor(nadir: &Vector, tide: f64) -> Matrix3<f64> {
        let (half, [x, y, z]) = (0.5 * tide, (*nadir).into());
        let (a, b, c) = (-3.0 * half * x, -3.0 * half * y, -3.0 * half * z);
        Matrix3::new(half + a * x, a * y, a * z, a * y, half + b * y, b * z, a * z, b * z, half + c * z)
    }

    /// Returns an upper bound of the torque on a body of this inertia (N m).
    pub(super) fn bound(&self, inertia: &Matrix3<f64>, sky: &OrbitEnvironment) -> f64 {
        let on_orbit = sky.orbit().map_or(0.0, |orbit| {
            let nearest = orbit.nearest();
            orbit.gravity() / (nearest * nearest * nearest)
        });
        3.0 * self.orbit_rate.map_or(on_orbit, |rate| rate.get() * rate.get()) * inertia.norm()
    }
}
