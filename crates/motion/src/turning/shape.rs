//! How the modes of a body are at an instant, summed.

use nalgebra::Matrix3;

use super::model::{Constants, tensor};
use super::step::TurningStep;
use crate::attitude::Vector;

/// How the modes are at an instant: sum phi q, sum phi P, and the change of the inertia.
pub(super) struct Deformation {
    pub bent: Vector,
    pub elastic: Vector,
    pub changed: Matrix3<f64>,
    /// What the modes add to the torque on the hub (N m).
    pub levered: Vector,
}

/// Sums over the modes.
#[derive(Default)]
pub(super) struct Sums {
    bent: Vector,
    elastic: Vector,
    changed: [f64; 6],
    levered: Vector,
}

impl Sums {
    #[inline]
    pub fn add(&mut self, of: &Constants, q: f64, p: f64, stretches: bool) {
        self.bent += of.rotation * q;
        self.elastic += of.rotation * p;
        if stretches {
            self.changed.iter_mut().zip(&of.moments).for_each(|(sum, moment)| *sum += moment * q);
        }
    }

    /// What the mode adds to the torque.
    pub fn lever(&mut self, step: &TurningStep<'_>, index: usize, q: f64) {
        if let Some(lever) = step.levers.get(index) {
            self.levered += lever * q;
        }
    }

    pub fn shape(&self) -> Deformation {
        Deformation {
            bent: self.bent,
            elastic: self.elastic,
            changed: tensor(self.changed),
            levered: self.levered,
        }
    }
}
