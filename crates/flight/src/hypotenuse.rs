//! Hypotenuse of a right triangle: the algorithm of musl.
//!
//! Origin: musl, copyright 2005-2020 Rich Felker, et al., MIT licence.

use crate::square_root::sqrt;

/// Biased exponent of infinities and NaN.
const EXPONENT_LIMIT: u64 = 0x7ff;

/// Difference of the exponents from which on the shorter side hardly counts.
const FAR_APART: u64 = 64;

/// Biased exponent above which the squares may overflow.
const LARGE: u64 = 1023 + 510;

/// Biased exponent below which the squares may lose digits.
const SMALL: u64 = 1023 - 450;

/// Scale 2^700 of small sides.
const SCALE_UP: f64 = 5.260_135_901_548_374e210;

/// Scale 2^-700 of large sides.
const SCALE_DOWN: f64 = 1.901_091_566_295_16e-211;

/// Factor 2^27 + 1, which parts a number into two halves.
const SPLITTER: f64 = 134_217_729.0;

/// Square of a number as a sum of two.
struct Square {
    rounded: f64,
    error: f64,
}

/// Returns the exact square of x.
#[inline]
fn square(x: f64) -> Square {
    let magnified = x * SPLITTER;
    let upper = x - magnified + magnified;
    let lower = x - upper;
    let rounded = x * x;
    let error = upper * upper - rounded + 2.0 * upper * lower + lower * lower;
    Square { rounded, error }
}

/// Returns the square root of x² + y² without overflow on the way; infinity if a side is infinite, even next to NaN.
#[must_use]
pub fn hypot(x: f64, y: f64) -> f64 {
    let x_bits = x.abs().to_bits();
    let y_bits = y.abs().to_bits();
    let long_bits = if x_bits < y_bits { y_bits } else { x_bits };
    let short_bits = if x_bits < y_bits { x_bits } else { y_bits };
    let long_exponent = long_bits >> 52;
    let short_exponent = short_bits >> 52;
    let long = f64::from_bits(long_bits);
    let short = f64::from_bits(short_bits);
    // The bits of NaN are above those of infinity.
    if short_exponent == EXPONENT_LIMIT {
        return short;
    }
    if long_exponent == EXPONENT_LIMIT || short_bits == 0 {
        return long;
    }
    if long_exponent - short_exponent > FAR_APART {
        return long + short;
    }
    if long_exponent > LARGE {
        return SCALE_UP * root_of_squares(long * SCALE_DOWN, short * SCALE_DOWN);
    }
    if short_exponent < SMALL {
        return SCALE_DOWN * root_of_squares(long * SCALE_UP, short * SCALE_UP);
    }
    root_of_squares(long, short)
}

/// Returns the square root of the sum of squares that neither overflow nor lose digits.
#[inline]
fn root_of_squares(long: f64, short: f64) -> f64 {
    let long_square = square(long);
    let short_square = square(short);
    sqrt(short_square.error + long_square.error + short_square.rounded + long_square.rounded)
}
