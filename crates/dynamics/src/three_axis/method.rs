//! One step: Gauss-Legendre of order 6 for momentum and attitude in mean axes, exact solutions for the modes.
//!
//! With th = sum phi q, Q = Q_m o exp(th) and H = exp(-\[th\]) H_m, the rate of the mean axes is w_m = exp(\[th\])
//! (J^-1 Gt + (1 - Gr) phi q'), which contains the elastic rate only in products with th. The stages are found by
//! fixed-point iteration; the modes need only Gt (three numbers) and, if present, s of a stage. The attitude follows
//! from the rates of the mean axes afterwards; it takes part in the iteration only if the environment depends on it.

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::gauss_legendre::{NODES, WEIGHTS, exact_sum};
use nalgebra::Vector2;

use super::bearing::RotorStage;
use super::facing::{NodeAttitudes, inertial};
use super::modal_forcing_lanes::ModalForcesSimd;
use super::model::{centrifugal_terms, tensor};
use super::node_stages::NodeValues;
use super::nodes::{NodeIteration, Predictor};
use super::shape::Deformation;
use super::state::IntegratorState;
use super::step::{IntegrationStep, ModeMemory, OptionalStages, StageValues, weights};
use super::summed::{ModalSumsResult, SumModes};
use super::vectors::vector;

/// Working memory of steps: values of the modes, of the nodes, and of rotors and appendages.
#[derive(Clone, Debug)]
pub(super) struct StepMemory {
    modes: Vec<ModeMemory>,
    nodes: NodeValues,
    beside: OptionalStages,
    /// Stage at the start of the last step, reused while steps begin at the same state; with the largest rate of a
    /// mode and the largest force on one.
    start: Option<(StageValues, [f64; 2])>,
}

impl StepMemory {
    /// Creates the memory for `modes` modes.
    pub fn new(modes: usize) -> Self {
        Self {
            modes: vec![ModeMemory::default(); modes],
            nodes: NodeValues::default(),
            beside: OptionalStages::default(),
            start: None,
        }
    }

    /// Invalidates the stage at the start: the next step begins at another state, or under other loads.
    pub fn invalidate(&mut self) {
        self.start = None;
    }
}

impl IntegrationStep<'_> {
    /// Advances the state over the step; returns the number of iterations.
    pub fn run(&self, state: &mut IntegratorState, work: &mut StepMemory) -> u32 {
        let StepMemory { modes, nodes, beside, start } = work;
        if let Some((driving, t)) = self.driven {
            driving.prepare(t, self.h, &mut beside.driven);
        }
        let special = self.borne.is_some() || self.driven.is_some();
        if special {
            *start = None;
        }
        let (stage, [fastest, forced]) = start.get_or_insert_with(|| self.start(state, modes, beside));
        let lanes = self.model.lanes;
        lanes.run(Predictor { step: self, state, start: stage, modes, nodes });
        let speed = fastest.max(self.h * *forced);
        let mut facing = NodeAttitudes::default();
        if self.around.is_some() {
            facing.compute(&state.attitude, &nodes.means(), self.h);
        }
        let passes = if special {
            let mut stages = nodes.stages();
            let passes = self.iterate_scalar(state, (&mut stages, &mut facing), (modes, beside), speed);
            nodes.set_stages(&stages);
            passes
        } else {
            lanes.run(NodeIteration { step: self, state, modes, nodes, facing: &mut facing, speed })
        };
        self.end(state, (nodes, &facing), modes, &beside.spun);
        passes
    }

    /// Computes the stage at the start, and the largest rate of a mode and the largest force on one.
    fn start(
        &self,
        state: &IntegratorState,
        modes: &mut [ModeMemory],
        beside: &mut OptionalStages,
    ) -> (StageValues, [f64; 2]) {
        let lanes = self.model.lanes;
        let ModalSumsResult { bent, elastic, changed } =
            lanes.run(SumModes { model: self.model, states: &state.modes });
        let levers = self.levers.iter().zip(&state.modes);
        let levered = levers.fold(Vector::zeros(), |sum, (lever, [q, ..])| sum + lever * *q);
        let shape = Deformation { bent, elastic, changed: tensor(changed), levered };
        if self.only_rigid_forcing() {
            let (stage, felt) = self.stage_motion((0, 0.0), &shape, &state.momentum, &state.attitude, beside);
            let spun = self.model.stretches.then(|| centrifugal_terms(&felt.rate));
            let (abreast, states) = (&self.model.abreast[..], &state.modes[..]);
            return (
                stage,
                lanes.run(ModalForcesSimd { abreast, states, turning: felt.turning, spun, modes }),
            );
        }
        for (index, memory) in modes.iter_mut().enumerate() {
            let [q, p, ..] = state.modes[index];
            memory.rate[0] = self.model.modes[index].frequency * p;
            self.store_mode(index, q, memory.rate[0], beside);
        }
        if self.borne.is_some() {
            let RotorStage { at, now, .. } = &mut beside.spun;
            at.clear();
            at.extend(state.spins.iter().map(|spin| spin.sums));
            now.resize(at.len(), Vector::zeros());
        }
        let (stage, felt) = self.stage_motion((0, 0.0), &shape, &state.momentum, &state.attitude, beside);
        if self.borne.is_some() {
            let RotorStage { rates, now, .. } = &mut beside.spun;
            rates.clear();
            rates.extend(now.iter().map(|now| [*now; 3]));
        }
        self.update_modal_forces(&felt, modes, beside, 0);
        let mut most = [0.0_f64; 2];
        for memory in modes {
            memory.start = [memory.g[0], memory.s[0]];
            most = [most[0].max(memory.rate[0].abs()), most[1].max(memory.s[0].abs())];
        }
        (stage, most)
    }

    /// Advances position and velocity of the centre of mass to the end of the step by Gauss-Legendre quadrature.
    fn invalidate(&self, state: &mut IntegratorState, nodes: &NodeValues, facing: &NodeAttitudes) {
        let [position, velocity] = &mut state.moved;
        *position += *velocity * self.h;
        if self.push.is_some() {
            for (index, (weight, node)) in WEIGHTS.into_iter().zip(NODES).enumerate() {
                let pushed =
                    inertial(&facing.at(&state.attitude, index, self.h), &vector(&nodes.pushed, index));
                *velocity += pushed * (weight * self.h);
                *position += pushed * (weight * (1.0 - node) * self.h * self.h);
            }
        }
    }

    /// Advances the state to the end of the step from the converged stages.
    fn end(
        &self,
        state: &mut IntegratorState,
        (nodes, facing): (&NodeValues, &NodeAttitudes),
        modes: &[ModeMemory],
        spun: &RotorStage,
    ) {
        self.invalidate(state, nodes, facing);
        let [a, b, c] = weights(&WEIGHTS, self.h);
        let [push, rigid] = nodes.sums([a, b, c]);
        let turn = facing.turns[0] * a + facing.turns[1] * b + facing.turns[2] * c;
        let IntegratorState { attitude, momentum, turned, lost, modes: states, spins, .. } = state;
        if self.borne.is_some() {
            for (spin, rates) in spins.iter_mut().zip(&spun.rates) {
                let change = rates[0] * a + rates[1] * b + rates[2] * c;
                (spin.sums, spin.lost) = exact_sum(spin.sums, change + spin.lost);
            }
        }
        (attitude.coords, lost.0.coords) = exact_sum(attitude.coords, turn.coords + lost.0.coords);
        (*momentum, lost.1) = exact_sum(*momentum, push + lost.1);
        (*turned, lost.2) = exact_sum(*turned, rigid + lost.2);
        // The method preserves the norm up to rounding; the accumulated rounding is removed here.
        let excess = attitude.norm_squared() - 1.0;
        if excess.abs() > 4.0 * f64::EPSILON {
            *attitude *= 1.0 - 0.5 * excess;
        }
        let loud = self.has_varying_forces();
        let sum = |of: &[Vector2<f64>; 3], by: &[f64; 4]| of[0] * by[0] + of[1] * by[1] + of[2] * by[2];
        for ((memory, response), mode) in modes.iter().zip(self.responses).zip(states) {
            let by = &response.end;
            let mut end = Vector2::new(memory.known[0][3], memory.known[1][3]);
            end += sum(&by.of_rate, &memory.g);
            if loud {
                end += sum(&by.of_force, &memory.s);
            }
            // The rounding errors propagate with the mode, corrected for the norm error of the rounded transition
            // matrix.
            let left = by.free[0] * mode[2] + by.free[1] * mode[3];
            let (end, left) = exact_sum(end, left - end * response.excess);
            *mode = [end.x, end.y, left.x, left.y];
        }
    }
}
