//! Vectors in SIMD lanes.

use std::ops::{Add, Sub};

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::lanes::LaneFloat;
use nalgebra::Matrix3;

/// Four vectors stored as structure of arrays: the x, y and z components, four lanes each.
///
/// Aligned so that no register of four straddles two cache lines: memory of this type in a function also aligns the
/// registers that the compiler stores there.
#[derive(Copy, Clone, Debug, Default)]
#[repr(align(32))]
pub(super) struct StoredVectors(pub [[f64; 4]; 3]);

/// Vector in each SIMD lane.
#[derive(Copy, Clone)]
pub(super) struct Vectors<R> {
    pub x: R,
    pub y: R,
    pub z: R,
}

/// Returns the vector in a lane of stored vectors.
#[inline]
pub(super) fn vector(StoredVectors([x, y, z]): &StoredVectors, lane: usize) -> Vector {
    Vector::new(x[lane], y[lane], z[lane])
}

/// Returns the length of a vector. nalgebra's `norm` takes the root by an SSE instruction, which stalls on registers
/// of AVX used before it.
#[inline(always)]
pub(super) fn length(v: &Vector) -> f64 {
    f64::sqrt(v.norm_squared())
}

impl<R: LaneFloat> Vectors<R> {
    /// Copies one vector into every lane.
    #[inline(always)]
    pub fn splat(kind: R, v: &Vector) -> Self {
        Self { x: kind.splat(v.x), y: kind.splat(v.y), z: kind.splat(v.z) }
    }

    /// Loads stored vectors.
    #[inline(always)]
    pub fn load(kind: R, from: &StoredVectors) -> Self {
        let [x, y, z] = &from.0;
        Self { x: kind.load(x), y: kind.load(y), z: kind.load(z) }
    }

    /// Stores the vectors.
    #[inline(always)]
    pub fn store(self, to: &mut StoredVectors) {
        let [x, y, z] = &mut to.0;
        self.x.store(x);
        self.y.store(y);
        self.z.store(z);
    }

    #[inline(always)]
    pub fn dot(self, other: Self) -> R {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    #[inline(always)]
    pub fn dot_shared(self, other: &Vector) -> R {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Self {
            x: self.y * other.z - self.z * other.y,
            y: self.z * other.x - self.x * other.z,
            z: self.x * other.y - self.y * other.x,
        }
    }

    #[inline(always)]
    pub fn scaled(self, by: R) -> Self {
        Self { x: self.x * by, y: self.y * by, z: self.z * by }
    }

    /// Adds `v` times a factor per lane.
    #[inline(always)]
    pub fn add_scaled(self, v: &Vector, by: R) -> Self {
        Self { x: self.x + by * v.x, y: self.y + by * v.y, z: self.z + by * v.z }
    }

    /// Returns the products of a matrix with the vectors.
    #[inline(always)]
    pub fn transform(self, m: &Matrix3<f64>) -> Self {
        Self {
            x: self.x * m.m11 + self.y * m.m12 + self.z * m.m13,
            y: self.x * m.m21 + self.y * m.m22 + self.z * m.m23,
            z: self.x * m.m31 + self.y * m.m32 + self.z * m.m33,
        }
    }

    /// Returns the products of the symmetric tensors xx, yy, zz, yz, zx and xy (one per lane) with the vectors.
    #[inline(always)]
    pub fn transform_symmetric(self, [xx, yy, zz, yz, zx, xy]: &[R; 6]) -> Self {
        Self {
            x: self.x * *xx + self.y * *xy + self.z * *zx,
            y: self.x * *xy + self.y * *yy + self.z * *yz,
            z: self.x * *zx + self.y * *yz + self.z * *zz,
        }
    }
}

impl<R: LaneFloat> Add for Vectors<R> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }
}

impl<R: LaneFloat> Sub for Vectors<R> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y, z: self.z - other.z }
    }
}
