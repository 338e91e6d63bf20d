//! Attitude of the mean axes at the nodes of a step, from their rates there.
//!
//! Q' = 1/2 Q o (0, w) is linear in Q: with known rates, the stages of the attitude need no other evaluation.

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::gauss_legendre::MATRIX;
use nalgebra::Quaternion;

use super::convergence::TOLERANCE;
use super::weights;

/// Limit on the fixed-point iterations; beyond it the stages are accepted as they are.
const MAX_ITERATIONS: u32 = 60;

/// Largest absolute row sum of the Gauss-Legendre matrix, times 1/2: an iteration reduces an error by this factor
/// times |w| h.
const CONTRACTION: f64 = 0.45;

/// Derivatives Q_m' of the mean attitude at the nodes.
#[derive(Copy, Clone, Default)]
pub struct NodeAttitudes {
    pub derivatives: [Quaternion<f64>; 3],
}

impl NodeAttitudes {
    /// Computes the derivatives over a step of `h` (s) from the attitude at its start and the rates of the mean axes
    /// at the nodes.
    #[inline(always)]
    pub fn compute(&mut self, from: &Quaternion<f64>, mean_rates: &[Vector; 3], h: f64) {
        let rates = mean_rates.map(|rate| rate * 0.5);
        let fastest = mean_rates.iter().map(Vector::norm_squared).fold(0.0, f64::max);
        let contraction = CONTRACTION * h * f64::sqrt(fastest);
        self.derivatives = rates.map(|rate| quaternion_rate(from, &rate));
        for _ in 0..MAX_ITERATIONS {
            let mut change = 0.0_f64;
            for (node, rate) in rates.iter().enumerate() {
                let found = quaternion_rate(&self.at(from, node, h), rate);
                change = change.max((found - self.derivatives[node]).norm_squared());
                self.derivatives[node] = found;
            }
            if f64::sqrt(change) * h * contraction <= TOLERANCE {
                break;
            }
        }
    }

    /// Returns the attitude of the mean axes at a node.
    #[inline(always)]
    pub fn at(&self, from: &Quaternion<f64>, node: usize, h: f64) -> Quaternion<f64> {
        let [a, b, c] = weights(&MATRIX[node], h);
        from + self.derivatives[0] * a + self.derivatives[1] * b + self.derivatives[2] * c
    }
}

/// Transforms a vector from the mean axes into inertial axes; the quaternion has unit length up to the error of a
/// stage.
pub fn inertial(attitude: &Quaternion<f64>, v: &Vector) -> Vector {
    (*attitude * Quaternion::from_imag(*v) * attitude.conjugate()).vector() / attitude.norm_squared()
}

/// Returns the quaternion product Q o (0, v), where `half` is v, half of an angular rate.
#[inline(always)]
fn quaternion_rate(attitude: &Quaternion<f64>, half: &Vector) -> Quaternion<f64> {
    let (q, v) = (attitude, half);
    Quaternion::new(
        -(q.i * v.x + q.j * v.y + q.k * v.z),
        q.w * v.x + q.j * v.z - q.k * v.y,
        q.w * v.y + q.k * v.x - q.i * v.z,
        q.w * v.z + q.i * v.y - q.j * v.x,
    )
}
