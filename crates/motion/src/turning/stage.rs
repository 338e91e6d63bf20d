//! Stages of a step one after the other: for its start, and for bodies with rotors in bearings or driven appendages.

use nalgebra::Quaternion;

use super::bearing::Spun;
use super::facing::Facing;
use super::rotation::Bend;
use super::settled::Change;
use super::shape::{Deformation, Sums};
use super::state::TurningState;
use super::step::{Beside, FeltByModes, Memory, PASSES, StepStage, TurningStep, answer, means, weights};
use crate::attitude::{Vector, rotation};
use crate::numerics::gauss_legendre::{MATRIX, NODES};

impl TurningStep<'_> {
    /// Iterates the stages node by node (Gauss-Seidel) until they converge; returns the number of iterations.
    pub(super) fn one_by_one(
        &self,
        state: &TurningState,
        (stages, facing): (&mut [StepStage; 3], &mut Facing),
        (modes, beside): (&mut [Memory], &mut Beside),
        speed: f64,
    ) -> u32 {
        let (size, seeks) = (self.size(state), self.around.is_some());
        let (mut before, mut passes) = (0.0, 0);
        while passes < PASSES {
            passes += 1;
            let mut change = Change::default();
            for node in 0..3 {
                let at = if seeks { facing.at(&state.attitude, node, self.h) } else { state.attitude };
                let found = self.stage(node, state, (stages, &at), (modes, beside), &mut change);
                change.spun = change.spun.max(beside.spun.take_over(node, self.h));
                change.see(&stages[node], &found);
                stages[node] = found;
            }
            if seeks {
                facing.find(&state.attitude, &means(stages), self.h);
            }
            if self.settles(&change, size, speed, before) {
                break;
            }
            before = change.most(self.h, size, speed);
        }
        if !seeks {
            facing.find(&state.attitude, &means(stages), self.h);
        }
        passes
    }

    /// Evaluates the stage at a node, given the attitude of the mean axes there.
    fn stage(
        &self,
        node: usize,
        state: &TurningState,
        (stages, facing): (&[StepStage; 3], &Quaternion<f64>),
        (modes, beside): (&mut [Memory], &mut Beside),
        change: &mut Change,
    ) -> StepStage {
        let shape = self.shape(node, modes, beside);
        let [a, b, c] = weights(&MATRIX[node], self.h);
        let momentum = state.momentum + stages[0].push * a + stages[1].push * b + stages[2].push * c;
        if self.borne.is_some() {
            let Spun { at, rates, .. } = &mut beside.spun;
            for ((at, rates), spin) in at.iter_mut().zip(&*rates).zip(&state.spins) {
                *at = spin.sums + rates[0] * a + rates[1] * b + rates[2] * c;
            }
        }
        let (stage, felt) = self.turning((node + 1, NODES[node] * self.h), &shape, &momentum, facing, beside);
        change.forced = change.forced.max(self.feel(&felt, modes, beside, node));
        change.stretched = change.stretched.max(shape.changed.norm_squared());
        change.rate = change.rate.max(felt.rate.norm_squared());
        stage
    }

    /// Computes q and P of all modes at a node and returns their sums.
    fn shape(&self, node: usize, modes: &mut [Memory], beside: &mut Beside) -> Deformation {
        let mut sums = Sums::default();
        let loud = self.is_loud();
        let all = modes.iter_mut().zip(self.responses).zip(&self.model.modes);
        for (index, ((memory, response), of)) in all.enumerate() {
            let [more_q, more_p] = answer(&response.of_rate, &memory.g, node);
            let (mut q, mut p) = (memory.known[0][node] + more_q, memory.known[1][node] + more_p);
            if loud {
                let [more_q, more_p] = answer(&response.of_force, &memory.s, node);
                q += more_q;
                p += more_p;
            }
            let rate = of.frequency * p;
            memory.rate[node] = rate;
            sums.add(of, q, rate, self.model.stretches);
            self.keep(index, q, rate, beside);
            sums.lever(self, index, q);
        }
        sums.shape()
    }

    /// Evaluates the motion of the body `t` (s) after the start of the step, given the modal sums, momentum and
    /// attitude.
    pub(super) fn turning(
        &self,
        (stage, t): (usize, f64),
        shape: &Deformation,
        momentum: &Vector,
        facing: &Quaternion<f64>,
        beside: &mut Beside,
    ) -> (StepStage, FeltByModes) {
        let model = self.model;
        let bend = Bend::new(shape.bent);
        let (rotors, change) = &self.rotors;
        let mut free = bend.back(momentum) - (rotors + change * t);
        if let Some(swung) = &self.swung {
            free -= swung.stage(stage);
        }
        let mut locked = None;
        if let Some(borne) = &self.borne {
            free -= borne.stored(beside.spun.at.iter().map(|at| at.x));
            locked = borne.sticks().then(|| borne.locked());
        }
        let (mut levered, mut inertia) = (shape.levered, model.inertia + shape.changed);
        let (turning, rigid, rate) = if let Some((driving, _)) = self.driven {
            let turns = driving.turns(stage, &free, self.push, &mut beside.driven);
            (levered, inertia) = (turns.levered, turns.inertia);
            (free, turns.rate - turns.elastic, turns.rate)
        } else if model.stretches || locked.is_some() {
            let changed = locked.map_or(shape.changed, |locked| shape.changed + locked);
            let (turning, rate) = model.rates(&free, &shape.elastic, &changed);
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
            tide = if model.stretches || self.driven.is_some() { around.tide(since + t, &hub) } else { None };
        }
        if let Some(borne) = &self.borne {
            torque += borne.feel(&rate, &mut beside.spun);
        }
        let mean = bend.forward(&(rigid + bend.excess(&(rate - rigid))));
        let made = StepStage {
            push: bend.forward(&torque) - mean.cross(momentum),
            mean,
            rigid,
            turning,
            pushed: self.push.map_or_else(Vector::zeros, |push| bend.forward(&push)),
        };
        (made, FeltByModes { turning, rate, tide, t, stage })
    }
}
