//! Where the mean axes face at the nodes of a step, from their rates there.
//!
//! Q' = 1/2 Q o (0, w) is linear: with the rates known, the stages of the attitude need no evaluation of anything else.

use nalgebra::Quaternion;

use super::settled::SETTLED;
use super::step::weights;
use crate::attitude::Vector;
use crate::numerics::gauss_legendre::MATRIX;

/// Passes after which the stages are taken as they are.
const PASSES: u32 = 60;

/// The largest sum of the weights' sizes at a node, and half of it: a pass leaves this part of |w| h of an error.
const LEAVES: f64 = 0.45;

/// Q_m' at the nodes.
#[derive(Copy, Clone, Default)]
pub(super) struct Facing {
    pub turns: [Quaternion<f64>; 3],
}

impl Facing {
    /// Finds the turns of a step of `h` seconds from this attitude at the rates of the mean axes at the nodes.
    #[inline(always)]
    pub fn find(&mut self, from: &Quaternion<f64>, means: &[Vector; 3], h: f64) {
        let rates = means.map(|mean| mean * 0.5);
        let fastest = means.iter().map(Vector::norm_squared).fold(0.0, f64::max);
        let contraction = LEAVES * h * f64::sqrt(fastest);
        self.turns = rates.map(|rate| spin(from, &rate));
        for _ in 0..PASSES {
            let mut change = 0.0_f64;
            for (node, rate) in rates.iter().enumerate() {
                let found = spin(&self.at(from, node, h), rate);
                change = change.max((found - self.turns[node]).norm_squared());
                self.turns[node] = found;
            }
            if f64::sqrt(change) * h * contraction <= SETTLED {
                break;
            }
        }
    }

    /// Where the axes face at a node.
    #[inline(always)]
    pub fn at(&self, from: &Quaternion<f64>, node: usize, h: f64) -> Quaternion<f64> {
        let [a, b, c] = weights(&MATRIX[node], h);
        from + self.turns[0] * a + self.turns[1] * b + self.turns[2] * c
    }
}

/// A vector of the mean axes in inertial ones, by a quaternion that is of length 1 but for the error of a stage.
pub(super) fn inertial(attitude: &Quaternion<f64>, v: &Vector) -> Vector {
    (*attitude * Quaternion::from_imag(*v) * attitude.conjugate()).vector() / attitude.norm_squared()
}

/// Q o (0, w), of half a rate.
#[inline(always)]
fn spin(attitude: &Quaternion<f64>, half: &Vector) -> Quaternion<f64> {
    let (q, v) = (attitude, half);
    Quaternion::new(
        -(q.i * v.x + q.j * v.y + q.k * v.z),
        q.w * v.x + q.j * v.z - q.k * v.y,
        q.w * v.y + q.k * v.x - q.i * v.z,
        q.w * v.z + q.i * v.y - q.j * v.x,
    )
}
