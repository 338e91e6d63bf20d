//! A circular orbit: its local axes, and the transformation of vectors between local, inertial and body axes.
//!
//! Local axes are z to the planet's centre (nadir), y against the orbit's normal, x along the velocity. They turn at
//! the orbit's rate about -y.

use flexsc_numerics::attitude::{Attitude, Vector};
use flexsc_numerics::flight_types::{from_vector3, to_quaternion, to_vector3};
use flexsc_numerics::quantity::Positive;
use nalgebra::Quaternion;

/// Circular orbit.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Orbit {
    /// Rate of the orbit (rad/s).
    pub rate: f64,
    /// Quaternion that transforms vectors from the local axes at the start to inertial axes.
    start: Quaternion<f64>,
}

impl Orbit {
    /// Creates the orbit of this rate (rad/s) with the given orientation of the local axes at the start.
    pub fn new(rate: Positive, start: Attitude) -> Self {
        Self { rate: rate.get(), start: start.get() }
    }

    /// Returns a vector of the local axes at `t` seconds after the start, in inertial axes.
    pub fn to_inertial(self, t: f64, v: &Vector) -> Vector {
        let (sin, cos) = libm::sincos(self.rate * t);
        let at_start = Vector::new(cos * v.x - sin * v.z, v.y, sin * v.x + cos * v.z);
        to_body(&self.start.conjugate(), &at_start)
    }

    /// Returns the direction to the planet's centre in the axes of a body of the given attitude.
    pub fn nadir(&self, t: f64, attitude: &Quaternion<f64>) -> Vector {
        to_body(attitude, &self.to_inertial(t, &Vector::z()))
    }
}

/// Transforms an inertial vector to the body's axes; the attitude quaternion need not have length 1.
pub fn to_body(attitude: &Quaternion<f64>, v: &Vector) -> Vector {
    from_vector3(&to_quaternion(attitude).to_body(&to_vector3(v)))
}
