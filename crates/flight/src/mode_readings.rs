//! Readings that conditions of modes compare, from what the control system knows.

use crate::square_root::sqrt;

/// Returns the norm of numbers.
pub fn norm(values: &[f64]) -> f64 {
    let mut sum: f64 = 0.0;
    for index in 0..values.len() {
        sum += values[index] * values[index];
    }
    sqrt(sum)
}

/// Returns the norm of the differences of numbers from others, which are as many.
pub fn distance(values: &[f64], others: &[f64]) -> f64 {
    let mut sum: f64 = 0.0;
    for index in 0..values.len() {
        let difference: f64 = values[index] - others[index];
        sum += difference * difference;
    }
    sqrt(sum)
}

/// Returns the largest size of numbers; NaN if one is not known.
pub fn largest_size(values: &[f64]) -> f64 {
    let mut largest: f64 = 0.0;
    for index in 0..values.len() {
        let size: f64 = values[index].abs();
        if size > largest || size.is_nan() {
            largest = size;
        }
        if largest.is_nan() {
            return largest;
        }
    }
    largest
}
