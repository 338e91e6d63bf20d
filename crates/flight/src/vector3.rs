//! Vectors along the axes of the body or of inertial space.

use crate::maths::max;
use crate::square_root::sqrt;

/// Vector of three components.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Vector3 {
    /// Component along x.
    pub x: f64,
    /// Component along y.
    pub y: f64,
    /// Component along z.
    pub z: f64,
}

impl Vector3 {
    /// Zero vector.
    pub const ZERO: Self = Self { x: 0.0, y: 0.0, z: 0.0 };

    /// Returns the vector of three components.
    #[inline]
    pub fn new(x: f64, y: f64, z: f64) -> Self {
        Self { x, y, z }
    }

    /// Returns the component along an axis: 0 for x, 1 for y, else that along z.
    #[inline]
    pub fn component(&self, axis: usize) -> f64 {
        match axis {
            0 => self.x,
            1 => self.y,
            _ => self.z,
        }
    }

    /// Returns the sum of two vectors.
    #[inline]
    pub fn plus(&self, other: &Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }

    /// Returns the difference of two vectors.
    #[inline]
    pub fn minus(&self, other: &Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y, z: self.z - other.z }
    }

    /// Returns the vector multiplied by a number.
    #[inline]
    pub fn scaled(&self, by: f64) -> Self {
        Self { x: self.x * by, y: self.y * by, z: self.z * by }
    }

    /// Returns the vector divided by a number.
    #[inline]
    pub fn divided(&self, by: f64) -> Self {
        Self { x: self.x / by, y: self.y / by, z: self.z / by }
    }

    /// Returns the scalar product of two vectors.
    #[inline]
    pub fn dot(&self, other: &Self) -> f64 {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// Returns the vector product of two vectors.
    #[inline]
    pub fn cross(&self, other: &Self) -> Self {
        Self {
            x: self.y * other.z - self.z * other.y,
            y: self.z * other.x - self.x * other.z,
            z: self.x * other.y - self.y * other.x,
        }
    }

    /// Returns the square of the length.
    #[inline]
    pub fn norm_squared(&self) -> f64 {
        self.dot(self)
    }

    /// Returns the length.
    #[inline]
    pub fn norm(&self) -> f64 {
        sqrt(self.norm_squared())
    }

    /// Returns the largest size of a component.
    #[inline]
    pub fn largest_size(&self) -> f64 {
        let most: f64 = max(self.x.abs(), self.y.abs());
        max(most, self.z.abs())
    }

    /// Returns the unit vector in the same direction.
    #[inline]
    pub fn normalized(&self) -> Self {
        self.divided(self.norm())
    }
}
