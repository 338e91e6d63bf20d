//! Least and greatest of two numbers, limits, and rounding to integers.

use crate::binary32::{FRACTION_MASK, biased_exponent};

/// Biased exponent of 1.
const ONE_EXPONENT: u32 = 127;

/// Biased exponent from which on every number is an integer.
const INTEGER_EXPONENT: u32 = 127 + 23;

/// Greatest number below 1/2.
const BELOW_HALF: f32 = 0.499_999_97;

/// Returns the lesser of a and b: the other one if one is NaN, and a if both are zeros of any sign.
#[inline]
#[must_use]
pub fn min(a: f32, b: f32) -> f32 {
    if b < a || a.is_nan() {
        return b;
    }
    a
}

/// Returns the greater of a and b: the other one if one is NaN, and a if both are zeros of any sign.
#[inline]
#[must_use]
pub fn max(a: f32, b: f32) -> f32 {
    if b > a || a.is_nan() {
        return b;
    }
    a
}

/// Returns x within limits: lower if x is below it, upper if x is above it, else x, NaN included.
///
/// With the limits in the wrong order, or NaN, it still returns; `f32::clamp` would panic.
#[inline]
#[must_use]
pub fn clamp(x: f32, lower: f32, upper: f32) -> f32 {
    let mut limited = x;
    if limited < lower {
        limited = lower;
    }
    if limited > upper {
        limited = upper;
    }
    limited
}

/// Returns the integer nearest to x, half-way cases away from zero; the sign of x is kept.
#[inline]
#[must_use]
pub fn round(x: f32) -> f32 {
    // A number just below 1/2 must not be rounded up to 1.
    trunc(x + BELOW_HALF.copysign(x))
}

/// Returns x without its fraction; the sign of x is kept.
#[inline]
#[must_use]
pub fn trunc(x: f32) -> f32 {
    let exponent = biased_exponent(x);
    if exponent >= INTEGER_EXPONENT {
        return x;
    }
    if exponent < ONE_EXPONENT {
        return 0.0_f32.copysign(x);
    }
    f32::from_bits(x.to_bits() & !(FRACTION_MASK >> (exponent - ONE_EXPONENT)))
}
