//! Least and greatest of two numbers, limits, and rounding to integers.

use crate::binary64::{BELOW_HALF, FRACTION_MASK, INTEGER_EXPONENT, ONE_EXPONENT, biased_exponent};

/// Returns the lesser of a and b: the other one if one is NaN, and a if both are zeros of any sign.
#[inline]
#[must_use]
pub fn min(a: f64, b: f64) -> f64 {
    if b < a || a.is_nan() {
        return b;
    }
    a
}

/// Returns the greater of a and b: the other one if one is NaN, and a if both are zeros of any sign.
#[inline]
#[must_use]
pub fn max(a: f64, b: f64) -> f64 {
    if b > a || a.is_nan() {
        return b;
    }
    a
}

/// Returns x within limits: lower if x is below it, upper if x is above it, else x, NaN included.
///
/// With the limits in the wrong order, or NaN, it still returns; `f64::clamp` would panic.
#[inline]
#[must_use]
pub fn clamp(x: f64, lower: f64, upper: f64) -> f64 {
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
pub fn round(x: f64) -> f64 {
    // A number just below 1/2 must not be rounded up to 1.
    trunc(x + BELOW_HALF.copysign(x))
}

/// Returns x without its fraction; the sign of x is kept.
#[inline]
#[must_use]
pub fn trunc(x: f64) -> f64 {
    let exponent = biased_exponent(x);
    if exponent >= INTEGER_EXPONENT {
        return x;
    }
    if exponent < ONE_EXPONENT {
        return 0.0_f64.copysign(x);
    }
    f64::from_bits(x.to_bits() & !(FRACTION_MASK >> (exponent - ONE_EXPONENT)))
}

/// Returns the greatest integer that is not above x; the sign of a zero is kept.
#[inline]
#[must_use]
pub fn floor(x: f64) -> f64 {
    let exponent = biased_exponent(x);
    if exponent >= INTEGER_EXPONENT {
        return x;
    }
    if exponent < ONE_EXPONENT {
        if x < 0.0 {
            return -1.0;
        }
        return 0.0_f64.copysign(x);
    }
    let fraction = FRACTION_MASK >> (exponent - ONE_EXPONENT);
    let mut bits = x.to_bits();
    if x < 0.0 {
        bits += fraction;
    }
    f64::from_bits(bits & !fraction)
}
