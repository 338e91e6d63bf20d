//! Square root.

use crate::integer_square_root::root_by_digits;

/// Returns the square root of x, correctly rounded; NaN below zero.
#[inline]
#[must_use]
pub fn sqrt(x: f64) -> f64 {
    root_by_digits(x)
}
