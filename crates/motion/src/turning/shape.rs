//! Sums over the modes at an instant.

use nalgebra::Matrix3;

use super::model::{Constants, tensor};
use super::step::TurningStep;
use crate::attitude::Vector;

/// Modal sums at an instant: sum phi q (rad), sum phi P (rad/s), and the change of the inertia (kg m²).
pub(super) struct Deformation {
    pub bent: Vector,
    pub elastic: Vector,
    pub changed: Matrix3<f64>,
    /// Torque on the hub by forces whose points of application the modes move (N m).
    pub levered: Vector,
}

/// Accumulator of modal sums.
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

    /// Adds the torque of a mode's displacement by moving points of application.
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
