//! A sampled compensator given by its matrices: u = C x + D e, then x = A x + B e.
//!
//! The matrices A, B, C and D are one list: the rows of [A B], then the rows of [C D], each row after the other.

use crate::maths::clamp;
use crate::quaternion::Quaternion;
use crate::vector3::Vector3;

/// Quantity that a compensator about three axes reads.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum CompensatorQuantity {
    /// Error of the angle about an axis (rad).
    Angle,
    /// Component of the vector part of the quaternion of the error.
    VectorPart,
    /// Error of the rate about an axis (rad/s).
    Rate,
    /// Speed of a reaction wheel (rad/s).
    WheelSpeed,
}

/// Input of a compensator about three axes.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct CompensatorSource {
    /// Quantity.
    pub quantity: CompensatorQuantity,
    /// Index of the axis or of the wheel.
    pub index: usize,
}

/// Range of the commands of a compensator.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct CompensatorRange {
    /// Factor on the outputs.
    pub gain: f64,
    /// Largest command, in its unit.
    pub limit: f64,
}

/// Writes the inputs of a compensator about three axes, for errors of the angle (rad) and of the rate (rad/s), setpoint minus
/// estimate, and the speeds of the wheels (rad/s). The speed of a wheel that is not there is 0.
pub fn read_sources(
    sources: &[CompensatorSource],
    angle: &Vector3,
    rate: &Vector3,
    speeds: &[f64],
    inputs: &mut [f64],
) {
    let turn: Quaternion = Quaternion::rotation(angle);
    let part: Vector3 = turn.vector();
    for index in 0..sources.len() {
        let source: CompensatorSource = sources[index];
        inputs[index] = match source.quantity {
            CompensatorQuantity::Angle => angle.component(source.index),
            CompensatorQuantity::VectorPart => part.component(source.index),
            CompensatorQuantity::Rate => rate.component(source.index),
            CompensatorQuantity::WheelSpeed => {
                if source.index < speeds.len() {
                    speeds[source.index]
                } else {
                    0.0
                }
            }
        };
    }
}

/// Returns the product of a row, which begins at `start` in a list of matrices, and a vector; 0 for an empty vector.
#[inline]
fn row_product(matrices: &[f64], start: usize, vector: &[f64]) -> f64 {
    let mut sum: f64 = 0.0;
    for column in 0..vector.len() {
        let product: f64 = matrices[start + column] * vector[column];
        // A sum that begins with its first product keeps the sign of a zero.
        sum = if column == 0 { product } else { sum + product };
    }
    sum
}

/// Writes the outputs of a sample, each within the range, and advances the state, which stays as it was if it would not be finite.
/// `next` is a buffer as long as the state.
pub fn advance(
    matrices: &[f64],
    inputs: &[f64],
    state: &mut [f64],
    next: &mut [f64],
    range: &CompensatorRange,
    outputs: &mut [f64],
) {
    let order: usize = state.len();
    let width: usize = order + inputs.len();
    for row in 0..outputs.len() {
        let start: usize = (order + row) * width;
        let mut output: f64 = row_product(matrices, start + order, inputs);
        if order > 0 {
            output += row_product(matrices, start, state);
        }
        outputs[row] = clamp(range.gain * output, -range.limit, range.limit);
    }
    let mut is_finite: bool = true;
    for row in 0..order {
        let start: usize = row * width;
        next[row] = row_product(matrices, start, state) + row_product(matrices, start + order, inputs);
        is_finite = is_finite && next[row].is_finite();
    }
    if is_finite {
        for row in 0..order {
            state[row] = next[row];
        }
    }
}
