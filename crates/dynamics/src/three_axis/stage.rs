//! Stages of a step one after the other: for its start, and for bodies with rotors in bearings or driven appendages.

use flexsc_numerics::attitude::{Vector, rotation};
use flexsc_numerics::gauss_legendre::{MATRIX, NODES};
use nalgebra::Quaternion;

use super::bearing::RotorStage;
use super::facing::NodeAttitudes;
use super::rotation::SmallRotation;
use super::settled::IterationChange;
use super::shape::{Deformation, ModalSums};
use super::state::IntegratorState;
use super::step::{
    IntegrationStep, ModalForcing, ModeMemory, OptionalStages, PASSES, StageValues, means, mode_at_node,
    weights,
};

impl IntegrationStep<'_> {
    /// Iterates the stages node by node (Gauss-Seidel) until they converge; returns the number of iterations.
    pub(super) fn iterate_scalar(
        &self,
        state: &IntegratorState,
        (stages, facing): (&mut [StageValues; 3], &mut NodeAttitudes),
        (modes, beside): (&mut [ModeMemory], &mut OptionalStages),
        speed: f64,
    ) -> u32 {
        let (size, seeks) = (self.momentum_scale(state), self.around.is_some());
        let (mut before, mut passes) = (0.0, 0);
        while passes < PASSES {
            passes += 1;
            let mut change = IterationChange::default();
            for node in 0..3 {
                let at = if seeks { facing.at(&state.attitude, node, self.h) } else { state.attitude };
                let found = self.stage(node, state, (stages, &at), (modes, beside), &mut change);
                change.spun = change.spun.max(beside.spun.set_rates(node, self.h));
                change.add(&stages[node], &found);
                stages[node] = found;
            }
            if seeks {
                facing.compute(&state.attitude, &means(stages), self.h);
            }
            if self.has_converged(&change, size, speed, before) {
                break;
            }
            before = change.largest(self.h, size, speed);
        }
        if !seeks {
            facing.compute(&state.attitude, &means(stages), self.h);
        }
        passes
    }

    /// Evaluates the stage at a node, given the attitude of the mean axes there.
    fn stage(
        &self,
        node: usize,
        state: &IntegratorState,
        (stages, facing): (&[StageValues; 3], &Quaternion<f64>),
        (modes, beside): (&mut [ModeMemory], &mut OptionalStages),
        change: &mut IterationChange,
    ) -> StageValues {
        let shape = self.shape(node, modes, beside);
        let [a, b, c] = weights(&MATRIX[node], self.h);
        let momentum = state.momentum + stages[0].push * a + stages[1].push * b + stages[2].push * c;
        if self.borne.is_some() {
            let RotorStage { at, rates, .. } = &mut beside.spun;
            for ((at, rates), spin) in at.iter_mut().zip(&*rates).zip(&state.spins) {
                *at = spin.sums + rates[0] * a + rates[1] * b + rates[2] * c;
            }
        }
        let (stage, felt) =
            self.stage_motion((node + 1, NODES[node] * self.h), &shape, &momentum, facing, beside);
        change.forced = change.forced.max(self.update_modal_forces(&felt, modes, beside, node));
        change.stretched = change.stretched.max(shape.changed.norm_squared());
        change.rate = change.rate.max(felt.rate.norm_squared());
        stage
    }

    /// Computes q and P of all modes at a node and returns their sums.
    fn shape(&self, node: usize, modes: &mut [ModeMemory], beside: &mut OptionalStages) -> Deformation {
        let mut sums = ModalSums::default();
        let loud = self.has_varying_forces();
        let all = modes.iter_mut().zip(self.responses).zip(&self.model.modes);
        for (index, ((memory, response), of)) in all.enumerate() {
            let [more_q, more_p] = mode_at_node(&response.of_rate, &memory.g, node);
            let (mut q, mut p) = (memory.known[0][node] + more_q, memory.known[1][node] + more_p);
            if loud {
                let [more_q, more_p] = mode_at_node(&response.of_force, &memory.s, node);
                q += more_q;
                p += more_p;
            }
            let rate = of.frequency * p;
            memory.rate[node] = rate;
            sums.add(of, q, rate, self.model.stretches);
            self.store_mode(index, q, rate, beside);
            sums.add_torque_arm(self, index, q);
        }
        sums.shape()
    }

    /// Evaluates the motion of the body `t` (s) after the start of the step, given the modal sums, momentum and
    /// attitude.
    pub(super) fn stage_motion(
        &self,
        (stage, t): (usize, f64),
        shape: &Deformation,
        momentum: &Vector,
        facing: &Quaternion<f64>,
        beside: &mut OptionalStages,
    ) -> (StageValues, ModalForcing) {
        let model = self.model;
        let bend = SmallRotation::new(shape.bent);
        let (rotors, change) = &self.rotors;
        let mut free = bend.to_hub_axes(momentum) - (rotors + change * t);
        if let Some(swung) = &self.swung {
            free -= swung.stage(stage);
        }
        let mut locked = None;
        if let Some(borne) = &self.borne {
            free -= borne.stored(beside.spun.at.iter().map(|at| at.x));
            locked = borne.sticks().then(|| borne.stuck_inertia());
        }
        let (mut levered, mut inertia) = (shape.levered, model.inertia + shape.changed);
        let (turning, rigid, rate) = if let Some((driving, _)) = self.driven {
            let turns = driving.turns(stage, &free, self.push, &mut beside.driven);
            (levered, inertia) = (turns.levered, turns.inertia);
            (free, turns.rate - turns.elastic, turns.rate)
        } else if model.stretches || locked.is_some() {
            let changed = locked.map_or(shape.changed, |locked| shape.changed + locked);
            let (turning, rate) = model.momentum_and_rate(&free, &shape.elastic, &changed);
            (turning, model.inverse * turning, rate)
        } else {
            let rigid = model.inverse * free;
            (free, rigid, rigid + shape.elastic + model.bending * free)
        };
        let (mut torque, mut tide) = (self.torque, None);
        if !self.levers.is_empty() || self.driven.is_some() {
            torque += levered;
        }
        if let Some((around, since)) = self.around {
            let hub = facing * rotation(&shape.bent);
            torque += around.torque(since + t, &hub, &inertia);
            tide = if model.stretches || self.driven.is_some() {
                around.tidal_tensor(since + t, &hub)
            } else {
                None
            };
        }
        if let Some(borne) = &self.borne {
            torque += borne.update_rates(&rate, &mut beside.spun);
        }
        let mean = bend.to_mean_axes(&(rigid + bend.rate_correction(&(rate - rigid))));
        let made = StageValues {
            push: bend.to_mean_axes(&torque) - mean.cross(momentum),
            mean,
            rigid,
            turning,
            pushed: self.push.map_or_else(Vector::zeros, |push| bend.to_mean_axes(&push)),
        };
        (made, ModalForcing { turning, rate, tide, t, stage })
    }
}
