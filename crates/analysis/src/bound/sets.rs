//! Sets of initial states and inputs over which an output is bounded.

use flexsc_numerics::enclosure::Enclosure;

/// Sets of initial states and of inputs.
#[derive(Clone, Debug)]
pub struct InputSets {
    /// Range of each state at the start.
    pub start: Vec<Enclosure>,
    /// Range of each input that is constant in time.
    pub constant: Vec<Enclosure>,
    /// Range within which each input varies in time.
    pub varying: Vec<Enclosure>,
}

/// Returns the least and the largest product of a number within `value` and one within `range`.
pub fn products(value: Enclosure, range: Enclosure) -> [f64; 2] {
    let corners =
        [value.low * range.low, value.low * range.high, value.high * range.low, value.high * range.high];
    corners.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], product| {
        [least.min(*product), most.max(*product)]
    })
}

/// Returns the middle of a range, and half its width, rounded upwards.
pub fn middle(range: Enclosure) -> [f64; 2] {
    let half = 0.5 * (range.high - range.low);
    let rounding = if half > 0.0 { f64::EPSILON * range.magnitude() } else { 0.0 };
    [0.5 * (range.low + range.high), half + rounding]
}
