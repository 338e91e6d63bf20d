//! Largest value of a quantity over time, with its instant.

/// Largest value of a quantity, such as the index of a requirement.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct LargestSample {
    /// Value, in the unit of the quantity.
    pub value: f64,
    /// Time (s).
    pub at: f64,
    /// Index of the mode of operation; 0 without modes.
    pub mode: usize,
}
