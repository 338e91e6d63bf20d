//! Square root by the processor's instruction: what replaces the portable one with the feature `std`.

/// Returns the square root of x, correctly rounded; NaN below zero.
#[inline]
#[must_use]
pub fn sqrt(x: f64) -> f64 {
    x.sqrt()
}
