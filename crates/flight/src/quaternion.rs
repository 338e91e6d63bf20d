//! Attitudes as unit quaternions: the rotation from body axes to inertial axes.

use crate::inverse_trigonometry::atan2;
use crate::square_root::sqrt;
use crate::trigonometry::{SinCos, sincos};
use crate::vector3::Vector3;

/// Quaternion with scalar part w.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Quaternion {
    /// Scalar part.
    pub w: f64,
    /// Component along x.
    pub x: f64,
    /// Component along y.
    pub y: f64,
    /// Component along z.
    pub z: f64,
}

impl Quaternion {
    /// Attitude whose body axes are the inertial ones.
    pub const IDENTITY: Self = Self { w: 1.0, x: 0.0, y: 0.0, z: 0.0 };

    /// Returns the vector part.
    #[inline]
    pub fn vector(&self) -> Vector3 {
        Vector3 { x: self.x, y: self.y, z: self.z }
    }

    /// Returns the conjugate, for a unit quaternion the inverse rotation.
    #[inline]
    pub fn conjugate(&self) -> Self {
        Self { w: self.w, x: -self.x, y: -self.y, z: -self.z }
    }

    /// Returns the product of two quaternions.
    #[inline]
    pub fn times(&self, other: &Self) -> Self {
        Self {
            w: self.w * other.w - self.x * other.x - self.y * other.y - self.z * other.z,
            x: self.w * other.x + self.x * other.w + self.y * other.z - self.z * other.y,
            y: self.w * other.y - self.x * other.z + self.y * other.w + self.z * other.x,
            z: self.w * other.z + self.x * other.y - self.y * other.x + self.z * other.w,
        }
    }

    /// Returns the square of the length.
    #[inline]
    pub fn norm_squared(&self) -> f64 {
        (self.x * self.x + self.z * self.z) + (self.y * self.y + self.w * self.w)
    }

    /// Returns the quaternion divided by its length.
    #[inline]
    pub fn normalized(&self) -> Self {
        let norm: f64 = sqrt(self.norm_squared());
        Self { w: self.w / norm, x: self.x / norm, y: self.y / norm, z: self.z / norm }
    }

    /// Returns the rotation by a rotation vector (rad).
    #[inline]
    pub fn rotation(by: &Vector3) -> Self {
        let angle: f64 = by.norm();
        if angle == 0.0 {
            return Self::IDENTITY;
        }
        let half: SinCos = sincos(0.5 * angle);
        let vector: Vector3 = by.scaled(half.sin / angle);
        Self { w: half.cos, x: vector.x, y: vector.y, z: vector.z }
    }

    /// Returns the rotation vector (rad) from this attitude to another, in the body's axes and on the shorter way.
    #[inline]
    pub fn rotation_to(&self, to: &Self) -> Vector3 {
        let inverse: Self = self.conjugate();
        let difference: Self = inverse.times(to);
        let vector: Vector3 = difference.vector();
        let sine: f64 = vector.norm();
        let twice: f64 = 2.0_f64.copysign(difference.w);
        let scale: f64 = if sine == 0.0 { 1.0 } else { atan2(sine, difference.w.abs()) / sine };
        vector.scaled(twice * scale)
    }

    /// Returns the components of an inertial vector along the body's axes; the quaternion need not have length 1.
    #[inline]
    pub fn to_body(&self, inertial: &Vector3) -> Vector3 {
        let pure: Self = Self { w: 0.0, x: inertial.x, y: inertial.y, z: inertial.z };
        let inverse: Self = self.conjugate();
        let half: Self = inverse.times(&pure);
        let rotated: Self = half.times(self);
        let vector: Vector3 = rotated.vector();
        vector.divided(self.norm_squared())
    }
}
