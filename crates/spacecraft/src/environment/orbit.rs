//! A circular orbit: its local axes, and vectors on the way between local, inertial and body axes.
//!
//! Local axes are z to the planet's centre (nadir), y against the orbit's normal, x along the velocity. They turn at the orbit's
//! rate about -y.

use nalgebra::Quaternion;

use crate::attitude::{Attitude, Vector};
use crate::quantity::Positive;

/// A circular orbit.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Orbit {
    /// Rate (rad/s).
    pub rate: f64,
    /// Turns vectors of the local axes at the start into inertial ones.
    start: Quaternion<f64>,
}

impl Orbit {
    /// The orbit of this rate (rad/s) whose local axes lie so at the start.
    pub fn new(rate: Positive, start: Attitude) -> Self {
        Self { rate: rate.get(), start: start.get() }
    }

    /// A vector of the local axes `t` seconds after the start, in inertial ones.
    pub fn inertial(&self, t: f64, v: &Vector) -> Vector {
        let (sin, cos) = libm::sincos(self.rate * t);
        let at_start = Vector::new(cos * v.x - sin * v.z, v.y, sin * v.x + cos * v.z);
        into(&self.start.conjugate(), &at_start)
    }

    /// The direction to the planet's centre in the axes of a body that faces this way.
    pub fn nadir(&self, t: f64, attitude: &Quaternion<f64>) -> Vector {
        into(attitude, &self.inertial(t, &Vector::z()))
    }
}

/// An inertial vector in the axes of a body that faces this way, whose quaternion may differ from length 1.
pub fn into(attitude: &Quaternion<f64>, v: &Vector) -> Vector {
    let turned = attitude.conjugate() * Quaternion::from_imag(*v) * attitude;
    turned.vector() / attitude.norm_squared()
}
