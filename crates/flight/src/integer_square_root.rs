//! Square root by integers alone, one binary digit at a time.

use crate::binary64::{FRACTION_MASK, IMPLICIT_BIT, nan};

/// Biased exponent of infinities and NaN.
const EXPONENT_LIMIT: u64 = 0x7ff;

/// Returns the square root of x, rounded to the nearest; NaN below zero, and zero with its sign.
///
/// The 53 digits of the root and one more, which decides the rounding, come from trial subtraction; a root of 53 digits
/// is never half-way between two numbers.
#[must_use]
pub fn root_by_digits(x: f64) -> f64 {
    let bits = x.to_bits();
    if x == 0.0 {
        return x;
    }
    if x.is_nan() || (bits >> 63) != 0 {
        return nan();
    }
    let biased = bits >> 52;
    if biased == EXPONENT_LIMIT {
        return x;
    }
    let mut significand = bits & FRACTION_MASK;
    // Subnormal numbers have a lesser exponent than the stored one.
    let mut exponent = biased as i64;
    if biased == 0 {
        let shift = significand.leading_zeros() - 11;
        significand <<= shift;
        exponent = 1 - i64::from(shift);
    } else {
        significand |= IMPLICIT_BIT;
    }
    exponent -= 1023;
    if exponent.rem_euclid(2) == 1 {
        significand <<= 1;
    }

    let mut remainder = significand << 1;
    let mut root: u64 = 0;
    let mut doubled_root: u64 = 0;
    let mut digit: u64 = IMPLICIT_BIT << 1;
    while digit != 0 {
        let trial = doubled_root + digit;
        if trial <= remainder {
            doubled_root = trial + digit;
            remainder -= trial;
            root += digit;
        }
        remainder <<= 1;
        digit >>= 1;
    }
    if remainder != 0 {
        root += root & 1;
    }
    let root_exponent = (1022 + exponent.div_euclid(2)) as u64;
    f64::from_bits((root >> 1) + (root_exponent << 52))
}
