//! Square root by integers alone, one binary digit at a time.

use crate::binary32::{FRACTION_MASK, IMPLICIT_BIT, nan};

/// Biased exponent of infinities and NaN.
const EXPONENT_LIMIT: u32 = 0xff;

/// Returns the square root of x, rounded to the nearest; NaN below zero, and zero with its sign.
///
/// The 24 digits of the root and one more, which decides the rounding, come from trial subtraction; a root of 24 digits
/// is never half-way between two numbers.
#[must_use]
pub fn sqrt(x: f32) -> f32 {
    let bits = x.to_bits();
    if x == 0.0 {
        return x;
    }
    if x.is_nan() || (bits >> 31) != 0 {
        return nan();
    }
    let biased = bits >> 23;
    if biased == EXPONENT_LIMIT {
        return x;
    }
    let mut significand = bits & FRACTION_MASK;
    // Subnormal numbers have a lesser exponent than the stored one.
    let mut exponent = biased as i32;
    if biased == 0 {
        let shift = significand.leading_zeros() - 8;
        significand <<= shift;
        exponent = 1 - shift as i32;
    } else {
        significand |= IMPLICIT_BIT;
    }
    exponent -= 127;
    if exponent.rem_euclid(2) == 1 {
        significand <<= 1;
    }

    let mut remainder = significand << 1;
    let mut root: u32 = 0;
    let mut doubled_root: u32 = 0;
    let mut digit: u32 = IMPLICIT_BIT << 1;
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
    let root_exponent = (126 + exponent.div_euclid(2)) as u32;
    f32::from_bits((root >> 1) + (root_exponent << 23))
}
