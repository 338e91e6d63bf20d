//! Gauss-Legendre method of three stages and order 6, which preserves quadratic invariants, and compensated sums
//! (\[HairerLubichWanner06\]).

use nalgebra::SVector;

/// Square root of 15.
const R: f64 = 3.872_983_346_207_417;
/// Nodes, as fractions of a step.
pub const NODES: [f64; 3] = [0.5 - R / 10.0, 0.5, 0.5 + R / 10.0];
/// Weights of the stages for a whole step.
pub const WEIGHTS: [f64; 3] = [5.0 / 18.0, 4.0 / 9.0, 5.0 / 18.0];
/// Weights of the stages for each node.
pub const MATRIX: [[f64; 3]; 3] = [
    [5.0 / 36.0, 2.0 / 9.0 - R / 15.0, 5.0 / 36.0 - R / 30.0],
    [5.0 / 36.0 + R / 24.0, 2.0 / 9.0, 5.0 / 36.0 - R / 24.0],
    [5.0 / 36.0 + R / 30.0, 2.0 / 9.0 + R / 15.0, 5.0 / 36.0],
];
/// Coefficients of 1, x and x² in the parabola over a step that is 1 at a node and 0 at the other two.
pub const PARABOLAS: [[f64; 3]; 3] = [
    [5.0 / 6.0 + R / 6.0, -10.0 / 3.0 - R / 3.0, 10.0 / 3.0],
    [-2.0 / 3.0, 20.0 / 3.0, -20.0 / 3.0],
    [5.0 / 6.0 - R / 6.0, -10.0 / 3.0 + R / 3.0, 10.0 / 3.0],
];

/// Returns a sum and its rounding error (Knuth).
pub fn exact_sum<const N: usize>(
    a: SVector<f64, N>,
    b: SVector<f64, N>,
) -> (SVector<f64, N>, SVector<f64, N>) {
    let sum = a + b;
    let rest_of_sum = sum - a;
    (sum, (a - (sum - rest_of_sum)) + (b - rest_of_sum))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parabolas_are_one_at_their_node_and_integrate_to_the_weights() {
        for (index, parabola) in PARABOLAS.iter().enumerate() {
            let integral =
                |x: f64| parabola[0] * x + parabola[1] * x * x / 2.0 + parabola[2] * x * x * x / 3.0;
            for (node, x) in NODES.into_iter().enumerate() {
                let value = parabola[0] + parabola[1] * x + parabola[2] * x * x;
                assert!((value - f64::from(u8::from(node == index))).abs() < 1e-15);
                assert!((integral(x) - MATRIX[node][index]).abs() < 1e-15);
            }
            assert!((integral(1.0) - WEIGHTS[index]).abs() < 1e-15);
        }
    }
}
