//! Inverse.
#![allow(missing_docs)]
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}
