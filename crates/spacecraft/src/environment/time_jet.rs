//! Numbers with their first two derivatives in time, for expressions that are differentiated along a motion.

use std::ops::{Add, Mul, Sub};

/// Number with its first and its second derivative in time.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub(super) struct TimeJet(pub [f64; 3]);

/// Number of a recurrence: a value, or one with derivatives.
pub(super) trait JetNumber:
    Copy + Default + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Mul<f64, Output = Self>
{
}

impl JetNumber for f64 {}
impl JetNumber for TimeJet {}

impl Add for TimeJet {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self(std::array::from_fn(|order| self.0[order] + other.0[order]))
    }
}

impl Sub for TimeJet {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self(std::array::from_fn(|order| self.0[order] - other.0[order]))
    }
}

impl Mul<f64> for TimeJet {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        Self(self.0.map(|part| part * factor))
    }
}

impl Mul for TimeJet {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let ([a, da, dda], [b, db, ddb]) = (self.0, other.0);
        Self([a * b, da * b + a * db, dda * b + 2.0 * (da * db) + a * ddb])
    }
}

impl TimeJet {
    /// Returns the inverse of a number other than 0.
    pub fn inverse(self) -> Self {
        let [a, da, dda] = self.0;
        let rate = da / a;
        Self([1.0 / a, -rate / a, (2.0 * rate * rate - dda / a) / a])
    }

    /// Returns the square root of a positive number.
    pub fn square_root(self) -> Self {
        let [a, da, dda] = self.0;
        let root = f64::sqrt(a);
        let rate = 0.5 * da / root;
        Self([root, rate, (0.5 * dda - rate * rate) / root])
    }
}
