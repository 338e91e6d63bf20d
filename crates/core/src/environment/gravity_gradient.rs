//! Gravity gradient on a circular orbit (\[Hughes86\]).
//!
//! At the rate n of the orbit and with the direction o of the nadir, the field of gravity less what makes the centre of mass fall is
//! n² (3 o o' - 1) r. Its torque on a body is 3 n² o x J o. A mode that changes the inertia by J1 for a unit is pushed by
//! n² (tr J1/2 - 3/2 o' J1 o), which is the integral of its shape times that field.

use nalgebra::{Matrix3, Quaternion};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::orbit::Orbit;
use crate::attitude::{Attitude, Vector};
use crate::quantity::Positive;

/// Gravity gradient.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GravityGradient {
    /// Rate of the circular orbit (rad/s).
    pub orbit_rate: Positive,
    /// How the local axes lie at the start, a unit quaternion \[w, x, y, z\] that turns vectors of the local axes (x along the
    /// velocity, y against the orbit's normal, z nadir) into inertial ones; left out, they are the inertial ones then.
    #[serde(default)]
    pub local: Attitude,
}

impl GravityGradient {
    /// The orbit.
    fn orbit(&self) -> Orbit {
        Orbit::new(self.orbit_rate, self.local)
    }

    /// The torque in the body's axes (N m) at a time since the start (s).
    pub(super) fn torque(&self, t: f64, attitude: &Quaternion<f64>, inertia: &Matrix3<f64>) -> Vector {
        let (orbit, rate) = (self.orbit(), self.orbit_rate.get());
        let nadir = orbit.nadir(t, attitude);
        nadir.cross(&(inertia * nadir)) * (3.0 * rate * rate)
    }

    /// The tensor (1/s²) whose product with J1, element by element, is the force on a mode.
    pub(super) fn tide(&self, t: f64, attitude: &Quaternion<f64>) -> Matrix3<f64> {
        let (nadir, rate) = (self.orbit().nadir(t, attitude), self.orbit_rate.get());
        (Matrix3::identity() - nadir * nadir.transpose() * 3.0) * (0.5 * rate * rate)
    }

    /// No torque on a body of this inertia is larger (N m).
    pub(super) fn bound(&self, inertia: &Matrix3<f64>) -> f64 {
        let rate = self.orbit_rate.get();
        3.0 * rate * rate * inertia.norm()
    }
}
