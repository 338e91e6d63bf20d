//! A circular orbit: its local axes, and the transformation of vectors between local, inertial and body axes.
//!
//! Local axes are z to the planet's centre (nadir), y against the orbit's normal, x along the velocity. They turn at
//! the orbit's rate about -y.

use flexsc_numerics::attitude::{Attitude, Vector};
use flexsc_numerics::flight_types::{from_vector3, to_quaternion, to_vector3};
use flexsc_numerics::quantity::Positive;
use nalgebra::{Matrix3, Quaternion};

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
}

/// Transforms an inertial vector to the body's axes; the attitude quaternion need not have length 1.
pub fn to_body(attitude: &Quaternion<f64>, v: &Vector) -> Vector {
    from_vector3(&to_quaternion(attitude).to_body(&to_vector3(v)))
}

/// Returns the rotation of inertial vectors to the axes of a body; the attitude quaternion need not have length 1.
#[inline]
pub(super) fn body_axes(attitude: &Quaternion<f64>) -> Matrix3<f64> {
    let Quaternion { coords } = attitude;
    let [x, y, z, w] = (*coords).into();
    let twice = 2.0 / attitude.norm_squared();
    let (tx, ty, tz) = (twice * x, twice * y, twice * z);
    let (xx, yy, zz) = (tx * x, ty * y, tz * z);
    let (xy, yz, zx) = (tx * y, ty * z, tz * x);
    let (wx, wy, wz) = (tx * w, ty * w, tz * w);
    Matrix3::new(
        1.0 - (yy + zz),
        xy + wz,
        zx - wy,
        xy - wz,
        1.0 - (zz + xx),
        yz + wx,
        zx + wy,
        yz - wx,
        1.0 - (xx + yy),
    )
}

/// Returns the product of a matrix and a vector, in registers.
#[inline(always)]
pub(super) fn transformed(by: &Matrix3<f64>, v: &Vector) -> Vector {
    Vector::new(
        by.m11 * v.x + by.m12 * v.y + by.m13 * v.z,
        by.m21 * v.x + by.m22 * v.y + by.m23 * v.z,
        by.m31 * v.x + by.m32 * v.y + by.m33 * v.z,
    )
}
