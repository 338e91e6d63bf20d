//! Sums over the modes at an instant.

use flexsc_numerics::attitude::Vector;
use nalgebra::Matrix3;

use super::model::{ModeConstants, tensor};
use super::step::IntegrationStep;

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
pub(super) struct ModalSums {
    bent: Vector,
    elastic: Vector,
    changed: [f64; 6],
    levered: Vector,
}

impl ModalSums {
    #[inline]
    pub fn add(&mut self, of: &ModeConstants, q: f64, p: f64, stretches: bool) {
        self.bent += of.rotation * q;
        self.elastic += of.rotation * p;
        if stretches {
            self.changed.iter_mut().zip(&of.moments).for_each(|(sum, moment)| *sum += moment * q);
        }
    }

    /// Adds the torque of a mode's displacement by moving points of application.
    pub fn add_torque_arm(&mut self, step: &IntegrationStep<'_>, index: usize, q: f64) {
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
