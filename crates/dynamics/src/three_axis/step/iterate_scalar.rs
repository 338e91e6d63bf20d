//! Stages of a step one after the other: for its start, and for bodies with rotors in bearings or articulated appendages.

use flexsc_numerics::attitude::{Vector, rotation};
use flexsc_numerics::gauss_legendre::{MATRIX, NODES};
use nalgebra::{Matrix3, Quaternion};

use super::attitude_nodes::NodeAttitudes;
use super::convergence::IterationChange;
use super::stage_values::{ModalForcing, StageValues, mean_rates};
use super::{IntegrationStep, MAX_ITERATIONS, ModeMemory, OptionalStages, mode_at_node, weights};
use crate::three_axis::constants::{ModeConstants, tensor};
use crate::three_axis::rotors::RotorStage;
use crate::three_axis::small_rotation::SmallRotation;
use crate::three_axis::state::IntegratorState;

/// Sums over the modes at an instant.
pub struct Deformation {
    /// Elastic rotation th = sum phi q (rad).
    pub elastic_rotation: Vector,
    /// Sum phi P of the canonical rates (rad/s); the elastic rate of the hub is sum phi q'.
    pub canonical_elastic_rate: Vector,
    /// Change J1 of the inertia (kg m²).
    pub inertia_change: Matrix3<f64>,
    /// Torque on the hub by forces whose points of application the modes move (N m).
    pub arm_torque: Vector,
}

/// Accumulator of modal sums.
#[derive(Default)]
pub struct DeformationSum {
    elastic_rotation: Vector,
    canonical_elastic_rate: Vector,
    inertia_change: [f64; 6],
    arm_torque: Vector,
}

impl DeformationSum {
    #[inline]
    /// Adds a mode with the displacement q (m sqrt(kg)) and the canonical rate P (m sqrt(kg)/s).
    pub fn add(&mut self, of: &ModeConstants, q: f64, canonical_rate: f64, changes_inertia: bool) {
        self.elastic_rotation += of.rotation * q;
        self.canonical_elastic_rate += of.rotation * canonical_rate;
        if changes_inertia {
            self.inertia_change.iter_mut().zip(&of.moments).for_each(|(sum, moment)| *sum += moment * q);
        }
    }

    /// Adds the torque of a mode's displacement by moving points of application.
    pub fn add_torque_arm(&mut self, step: &IntegrationStep<'_>, index: usize, q: f64) {
        if let Some(arm) = step.force_arms.get(index) {
            self.arm_torque += arm * q;
        }
    }

    pub fn deformation(&self) -> Deformation {
        Deformation {
            elastic_rotation: self.elastic_rotation,
            canonical_elastic_rate: self.canonical_elastic_rate,
            inertia_change: tensor(self.inertia_change),
            arm_torque: self.arm_torque,
        }
    }
}

impl IntegrationStep<'_> {
    /// Iterates the stages node by node (Gauss-Seidel) until they converge; returns the number of iterations.
    pub(super) fn iterate_scalar(
        &self,
        state: &IntegratorState,
        (stages, attitudes): (&mut [StageValues; 3], &mut NodeAttitudes),
        (modes, optional): (&mut [ModeMemory], &mut OptionalStages),
        modal_rate_scale: f64,
    ) -> u32 {
        let (momentum_scale, uses_attitude) = (self.momentum_scale(state), self.surroundings.is_some());
        let (mut previous, mut iterations) = (0.0, 0);
        while iterations < MAX_ITERATIONS {
            iterations += 1;
            let mut change = IterationChange::default();
            for node in 0..3 {
                let at = if uses_attitude {
                    attitudes.at(&state.mean_attitude, node, self.h)
                } else {
                    state.mean_attitude
                };
                let found = self.stage(node, state, (stages, &at), (modes, optional), &mut change);
                change.rotor_momentum = change.rotor_momentum.max(optional.rotors.set_rates(node, self.h));
                change.add(&stages[node], &found);
                stages[node] = found;
            }
            if uses_attitude {
                attitudes.compute(&state.mean_attitude, &mean_rates(stages), self.h);
            }
            if self.has_converged(&change, momentum_scale, modal_rate_scale, previous) {
                break;
            }
            previous = change.largest(self.h, momentum_scale, modal_rate_scale);
        }
        if !uses_attitude {
            attitudes.compute(&state.mean_attitude, &mean_rates(stages), self.h);
        }
        iterations
    }

    /// Evaluates the stage at a node, given the attitude of the mean axes there.
    fn stage(
        &self,
        node: usize,
        state: &IntegratorState,
        (stages, attitude): (&[StageValues; 3], &Quaternion<f64>),
        (modes, optional): (&mut [ModeMemory], &mut OptionalStages),
        change: &mut IterationChange,
    ) -> StageValues {
        let deformation = self.deformation(node, modes, optional);
        self.store_canonical_rates(modes, node, optional);
        let [a, b, c] = weights(&MATRIX[node], self.h);
        let momentum = state.mean_momentum
            + stages[0].momentum_rate * a
            + stages[1].momentum_rate * b
            + stages[2].momentum_rate * c;
        if self.bearings.is_some() {
            let RotorStage { at, node_rates, .. } = &mut optional.rotors;
            for ((at, rates), rotor) in at.iter_mut().zip(&*node_rates).zip(&state.rotor_states) {
                *at = rotor.values + rates[0] * a + rates[1] * b + rates[2] * c;
            }
        }
        let (stage, forcing) =
            self.stage_motion((node + 1, NODES[node] * self.h), &deformation, &momentum, attitude, optional);
        change.modal_force =
            change.modal_force.max(self.update_modal_forces(&forcing, modes, optional, node));
        change.inertia_change = change.inertia_change.max(deformation.inertia_change.norm_squared());
        change.rate = change.rate.max(forcing.rate.norm_squared());
        stage
    }

    /// Computes q and P of all modes at a node and returns their sums.
    fn deformation(
        &self,
        node: usize,
        modes: &mut [ModeMemory],
        optional: &mut OptionalStages,
    ) -> Deformation {
        let mut sums = DeformationSum::default();
        let varying = self.has_varying_forces();
        let all = modes.iter_mut().zip(self.responses).zip(&self.model.modes);
        for (index, ((memory, response), of)) in all.enumerate() {
            let [more_q, more_p] = mode_at_node(&response.of_rate, &memory.g, node);
            let (mut q, mut p) = (memory.known[0][node] + more_q, memory.known[1][node] + more_p);
            if varying {
                let [more_q, more_p] = mode_at_node(&response.of_force, &memory.s, node);
                q += more_q;
                p += more_p;
            }
            let rate = of.frequency * p;
            memory.rate[node] = rate;
            sums.add(of, q, rate, self.model.changes_inertia);
            self.store_mode(index, q, rate, optional);
            sums.add_torque_arm(self, index, q);
        }
        sums.deformation()
    }

    /// Evaluates the motion of the body `t` (s) after the start of the step, given the modal sums, momentum and
    /// attitude.
    pub(super) fn stage_motion(
        &self,
        (stage, t): (usize, f64),
        deformation: &Deformation,
        momentum: &Vector,
        attitude: &Quaternion<f64>,
        optional: &mut OptionalStages,
    ) -> (StageValues, ModalForcing) {
        let model = self.model;
        let hub_to_mean = SmallRotation::new(deformation.elastic_rotation);
        let (rotors, change) = &self.rotors;
        let mut body_momentum = hub_to_mean.to_hub_axes(momentum) - (rotors + change * t);
        if let Some(gimbal_momentum) = &self.gimbal_momentum {
            body_momentum -= gimbal_momentum.stage(stage);
        }
        let mut stuck_inertia = None;
        if let Some(bearings) = &self.bearings {
            body_momentum -= bearings.stored(optional.rotors.at.iter().map(|at| at.x));
            stuck_inertia = bearings.sticks().then(|| bearings.stuck_inertia());
        }
        let (mut arm_torque, mut inertia) =
            (deformation.arm_torque, model.inertia + deformation.inertia_change);
        let (rigid_momentum, rigid_rate, rate) = if let Some((appendages, _)) = self.appendages {
            let motion = appendages.stage_rates(
                stage,
                &body_momentum,
                self.com_acceleration,
                &mut optional.appendages,
            );
            (arm_torque, inertia) = (motion.arm_torque, motion.inertia);
            (body_momentum, motion.rate - motion.elastic_rate, motion.rate)
        } else if model.changes_inertia || stuck_inertia.is_some() {
            let inertia_change = stuck_inertia.map_or(deformation.inertia_change, |stuck_inertia| {
                deformation.inertia_change + stuck_inertia
            });
            let (rigid_momentum, rate) =
                model.momentum_and_rate(&body_momentum, &deformation.canonical_elastic_rate, &inertia_change);
            (rigid_momentum, model.inverse * rigid_momentum, rate)
        } else {
            let rigid_rate = model.inverse * body_momentum;
            (
                body_momentum,
                rigid_rate,
                rigid_rate + deformation.canonical_elastic_rate + model.bending * body_momentum,
            )
        };
        let (mut torque, mut tide) = (self.torque, None);
        if !self.force_arms.is_empty() || self.appendages.is_some() {
            torque += arm_torque;
        }
        if let Some((surroundings, since)) = self.surroundings {
            let hub = attitude * rotation(&deformation.elastic_rotation);
            let started = (stage == 0).then(|| surroundings.sky_at(since + t));
            let sky = started.as_ref().unwrap_or_else(|| &optional.skies[stage - 1]);
            torque += surroundings.torque(sky, &hub, &inertia);
            if self.appendages.is_some() {
                torque += surroundings.panel_torque(sky, &hub, &optional.appendages.panel_places(stage));
            }
            tide = if model.changes_inertia || self.appendages.is_some() {
                surroundings.tidal_tensor(sky, &hub)
            } else {
                None
            };
        }
        if let Some(bearings) = &self.bearings {
            if bearings.has_tilts() {
                // Rates q' = P + phi' Gt.
                for (modal_rate, of) in optional.rotors.modal_rates.iter_mut().zip(&model.modes) {
                    *modal_rate += of.rotation.dot(&rigid_momentum);
                }
            }
            torque += bearings.update_rates(&rate, &mut optional.rotors);
        }
        let mean_rate =
            hub_to_mean.to_mean_axes(&(rigid_rate + hub_to_mean.rate_correction(&(rate - rigid_rate))));
        let made = StageValues {
            momentum_rate: hub_to_mean.to_mean_axes(&torque) - mean_rate.cross(momentum),
            mean_rate,
            rigid_rate,
            rigid_momentum,
            com_acceleration: self
                .com_acceleration
                .map_or_else(Vector::zeros, |force| hub_to_mean.to_mean_axes(&force)),
        };
        (made, ModalForcing { rigid_momentum, rate, tide, t, stage })
    }
}
