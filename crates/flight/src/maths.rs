//! Small functions of doubles.
#![allow(missing_docs)]
pub fn min(a: f64, b: f64) -> f64 {
    a.min(b)
}
pub fn max(a: f64, b: f64) -> f64 {
    a.max(b)
}
pub fn clamp(x: f64, low: f64, high: f64) -> f64 {
    if x < low {
        low
    } else if x > high {
        high
    } else {
        x
    }
}
pub fn round(x: f64) -> f64 {
    libm::round(x)
}
pub fn trunc(x: f64) -> f64 {
    libm::trunc(x)
}
pub fn sqrt(x: f64) -> f64 {
    libm::sqrt(x)
}
