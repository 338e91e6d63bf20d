//! First iterate of the stages of a step: free response of the modes, and stages extrapolated from the start.

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::gauss_legendre::NODES;
use flexsc_numerics::lanes::{LaneFloat, SimdTask};

use super::stage_values::{NodeValues, StageValues};
use super::{IntegrationStep, ModeMemory};
use crate::three_axis::state::IntegratorState;
use crate::three_axis::vectors::Vectors;

/// SIMD task that predicts the stages of a step: free response of the modes, and stages extrapolated from the start
/// by the growth rate of Gt.
pub struct Predictor<'a> {
    pub step: &'a IntegrationStep<'a>,
    pub state: &'a IntegratorState,
    pub start: &'a StageValues,
    pub modes: &'a mut [ModeMemory],
    pub nodes: &'a mut NodeValues,
}

impl SimdTask for Predictor<'_> {
    type Output = ();

    #[inline(always)]
    fn run<R: LaneFloat>(self, kind: R) {
        let Self { step, state, start, modes, nodes } = self;
        // Gt grows by the torque and the rotors' reaction; this captures most of the first iteration.
        let mut rigid_momentum_rate =
            if step.appendages.is_some() { Vector::zeros() } else { start.momentum_rate - step.rotors.1 };
        if let Some(gimbal_momentum) = step.gimbal_momentum.as_ref().filter(|_| step.appendages.is_none()) {
            rigid_momentum_rate -= gimbal_momentum.start.1;
        }
        let times = times(kind, step.h);
        for index in 0..modes.len() {
            let (memory, response) = (&mut modes[index], &step.responses[index]);
            let [q, p, ..] = state.modes[index];
            let ([a, b, c, d], [by_q, by_p]) = (&response.free, &response.of_constant);
            let mut known = [kind.load(a) * q + kind.load(b) * p, kind.load(c) * q + kind.load(d) * p];
            if index < step.forces.len() {
                known[0] = known[0] + kind.load(by_q) * step.forces[index];
                known[1] = known[1] + kind.load(by_p) * step.forces[index];
            }
            known[0].store(&mut memory.known[0]);
            known[1].store(&mut memory.known[1]);
            let [g, s] = memory.start;
            (times * step.model.modes[index].rotation.dot(&rigid_momentum_rate) + g).store(&mut memory.g);
            memory.s = [s; 4];
        }
        let rigid_acceleration = step.model.inverse * rigid_momentum_rate;
        let none = Vectors::splat(kind, &Vector::zeros());
        let more = none.add_scaled(&rigid_acceleration, times);
        let momentum = Vectors::splat(kind, &state.mean_momentum);
        (Vectors::splat(kind, &start.rigid_rate) + more).store(&mut nodes.rigid_rate);
        (Vectors::splat(kind, &start.mean_rate) + more).store(&mut nodes.mean_rate);
        Vectors::splat(kind, &start.rigid_momentum)
            .add_scaled(&rigid_momentum_rate, times)
            .store(&mut nodes.rigid_momentum);
        (Vectors::splat(kind, &start.momentum_rate) - more.cross(momentum)).store(&mut nodes.momentum_rate);
        Vectors::splat(kind, &start.com_acceleration).store(&mut nodes.com_acceleration);
    }
}

/// Returns the times of the nodes and of the end (s) for a step of `h` (s).
#[inline(always)]
pub fn times<R: LaneFloat>(kind: R, h: f64) -> R {
    kind.load(&[NODES[0], NODES[1], NODES[2], 1.0]) * h
}
