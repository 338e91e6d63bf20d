//! One step: Gauss-Legendre of order 6 for momentum and attitude in mean axes, exact solutions for the modes.
//!
//! With th = sum phi q, Q = Q_m o exp(th) and H = exp(-\[th\]) H_m, the rate of the mean axes is w_m = exp(\[th\])
//! (J^-1 Gt + (1 - Gr) phi q'), which contains the elastic rate only in products with th. The stages are found by
//! fixed-point iteration; the modes need only Gt (three numbers) and, if present, s of a stage. The attitude follows
//! from the rates of the mean axes afterwards; it takes part in the iteration only if the environment depends on it.
//!
//! The nodes of a step are its three Gauss-Legendre instants, 0 to 2. A stage is the evaluation of the motion at the start
//! of the step, stage 0, or at a node, stage node + 1.

mod attitude_nodes;
mod convergence;
mod iterate;
mod iterate_scalar;
mod modal_forces;
mod mode_response;
mod predictor;
mod stage_values;

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::gauss_legendre::{NODES, WEIGHTS, exact_sum};
use nalgebra::Vector2;

use crate::three_axis::appendages::{ArticulatedMotion, StageScratch};
use crate::three_axis::constants::{BodyConstants, centrifugal_terms, tensor};
use crate::three_axis::rotors::{BearingLoads, GimbalMomentum, RotorStage};
use crate::three_axis::state::{IntegratorState, ModalSums, SumModes};
use crate::three_axis::surroundings::{SkyAt, TimedSurroundings};
use crate::three_axis::vectors::{length, vector};

use attitude_nodes::{NodeAttitudes, inertial};
use iterate::NodeIteration;
use iterate_scalar::Deformation;
use modal_forces::ModalForcesSimd;
use predictor::Predictor;
use stage_values::{NodeValues, StageValues};

pub use mode_response::ModeResponse;

/// Limit on the fixed-point iterations; beyond it the stages are accepted as they are.
pub const MAX_ITERATIONS: u32 = 60;

/// Fraction of the rotors' momenta that counts in the momentum scale for convergence (see [`IntegrationStep::momentum_scale`]).
const ROTORS: f64 = 1e-2;

/// One integration step: the body, the step length and the loads.
pub struct IntegrationStep<'a> {
    pub model: &'a BodyConstants,
    /// Exact responses of the modes over the step.
    pub responses: &'a [ModeResponse],
    /// Step length (s).
    pub h: f64,
    /// Torque on the hub in its axes (N m).
    pub torque: Vector,
    /// Acceleration of the centre of mass in the hub's axes (m/s²); `None` without an external force.
    pub com_acceleration: Option<Vector>,
    /// Modal forces other than those of `torque` (N/sqrt(kg)).
    pub forces: &'a [f64],
    /// Torque on the hub per unit of each mode, from forces whose points of application move (N/sqrt(kg)).
    pub force_arms: &'a [Vector],
    /// Momentum of ideal rotors at the start of the step (N m s), and its rate (N m).
    pub rotors: (Vector, Vector),
    /// Rotors with bearing friction or imbalance, not included in `rotors`; their momenta are part of the state.
    pub bearings: Option<BearingLoads<'a>>,
    /// Momentum of the rotors in gimbals over the step.
    pub gimbal_momentum: Option<GimbalMomentum>,
    /// Environment, and the time of the start of the step since the start of the run (s).
    pub surroundings: TimedSurroundings<'a>,
    /// Appendages with drives or hinges, and the time of the start of the step since the start of the segment (s).
    pub appendages: Option<(&'a ArticulatedMotion, f64)>,
}

/// Working memory of a step for surroundings, rotors in bearings and articulated appendages.
#[derive(Clone, Debug, Default)]
pub struct OptionalStages {
    /// Surroundings at the nodes.
    pub skies: [SkyAt; 3],
    pub rotors: RotorStage,
    pub appendages: StageScratch,
}

/// Working memory of a step for one mode, aligned so that no register of four straddles two cache lines.
#[derive(Clone, Debug, Default)]
#[repr(align(32))]
pub struct ModeMemory {
    /// Values of g and s at the start of the step.
    pub start: [f64; 2],
    /// Contributions to q and P/W at the nodes and the end that do not depend on g and s at the nodes.
    pub known: [[f64; 4]; 2],
    /// Rate g = phi' Gt and varying force s at the nodes; the fourth entries are unused.
    pub g: [f64; 4],
    pub s: [f64; 4],
    /// Coordinates q at the nodes and the end (m sqrt(kg)).
    pub q: [f64; 4],
    /// Canonical rates P at the nodes (m sqrt(kg)/s); the update of the modal forces adds g where forces depend on q'.
    pub rate: [f64; 4],
}

/// Working memory of steps: values of the modes, of the nodes, and of rotors and appendages.
#[derive(Clone, Debug)]
pub struct StepMemory {
    modes: Vec<ModeMemory>,
    nodes: NodeValues,
    optional: OptionalStages,
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
            optional: OptionalStages::default(),
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
    pub fn run(&self, state: &mut IntegratorState, memory: &mut StepMemory) -> u32 {
        let StepMemory { modes, nodes, optional, start } = memory;
        if let Some((appendages, t)) = self.appendages {
            appendages.prepare(t, self.h, &mut optional.appendages);
        }
        let scalar = self.bearings.is_some() || self.appendages.is_some();
        if scalar {
            *start = None;
        }
        let (stage, [largest_rate, largest_force]) =
            start.get_or_insert_with(|| self.start(state, modes, optional));
        let lanes = self.model.lanes;
        lanes.run(Predictor { step: self, state, start: stage, modes, nodes });
        let modal_rate_scale = largest_rate.max(self.h * *largest_force);
        let mut attitudes = NodeAttitudes::default();
        if let Some((surroundings, since)) = self.surroundings {
            for (sky, node) in optional.skies.iter_mut().zip(NODES) {
                *sky = surroundings.sky_at(since + node * self.h);
            }
            attitudes.compute(&state.mean_attitude, &nodes.mean_rates(), self.h);
        }
        let iterations = if scalar {
            let mut stages = nodes.stages();
            let iterations = self.iterate_scalar(
                state,
                (&mut stages, &mut attitudes),
                (modes, optional),
                modal_rate_scale,
            );
            nodes.set_stages(&stages);
            iterations
        } else {
            lanes.run(NodeIteration {
                step: self,
                state,
                skies: &optional.skies,
                modes,
                nodes,
                attitudes: &mut attitudes,
                modal_rate_scale,
            })
        };
        self.end(state, (nodes, &attitudes), modes, &optional.rotors);
        iterations
    }

    /// Computes the stage at the start, and the largest rate of a mode and the largest force on one.
    fn start(
        &self,
        state: &IntegratorState,
        modes: &mut [ModeMemory],
        optional: &mut OptionalStages,
    ) -> (StageValues, [f64; 2]) {
        let lanes = self.model.lanes;
        let ModalSums { elastic_rotation, canonical_elastic_rate, inertia_change } =
            lanes.run(SumModes { model: self.model, states: &state.modes });
        let force_arms = self.force_arms.iter().zip(&state.modes);
        let arm_torque = force_arms.fold(Vector::zeros(), |sum, (arm, [q, ..])| sum + arm * *q);
        let deformation = Deformation {
            elastic_rotation,
            canonical_elastic_rate,
            inertia_change: tensor(inertia_change),
            arm_torque,
        };
        if self.only_rigid_forcing() {
            let (stage, forcing) = self.stage_motion(
                (0, 0.0),
                &deformation,
                &state.mean_momentum,
                &state.mean_attitude,
                optional,
            );
            let centrifugal = self.model.changes_inertia.then(|| centrifugal_terms(&forcing.rate));
            let (groups_of_four, states) = (&self.model.groups_of_four[..], &state.modes[..]);
            return (
                stage,
                lanes.run(ModalForcesSimd {
                    groups_of_four,
                    states,
                    rigid_momentum: forcing.rigid_momentum,
                    centrifugal,
                    modes,
                }),
            );
        }
        for (index, memory) in modes.iter_mut().enumerate() {
            let [q, p, ..] = state.modes[index];
            memory.rate[0] = self.model.modes[index].frequency * p;
            self.store_mode(index, q, memory.rate[0], optional);
        }
        if self.bearings.is_some() {
            let RotorStage { at, rates, .. } = &mut optional.rotors;
            at.clear();
            at.extend(state.rotor_states.iter().map(|rotor| rotor.values));
            rates.resize(at.len(), Vector::zeros());
        }
        self.store_canonical_rates(modes, 0, optional);
        let (stage, forcing) =
            self.stage_motion((0, 0.0), &deformation, &state.mean_momentum, &state.mean_attitude, optional);
        if self.bearings.is_some() {
            let RotorStage { node_rates, rates, .. } = &mut optional.rotors;
            node_rates.clear();
            node_rates.extend(rates.iter().map(|rate| [*rate; 3]));
        }
        self.update_modal_forces(&forcing, modes, optional, 0);
        let mut largest = [0.0_f64; 2];
        for memory in modes {
            memory.start = [memory.g[0], memory.s[0]];
            largest = [largest[0].max(memory.rate[0].abs()), largest[1].max(memory.s[0].abs())];
        }
        (stage, largest)
    }

    /// Advances position and velocity of the centre of mass to the end of the step by Gauss-Legendre quadrature.
    fn advance_centre_of_mass(
        &self,
        state: &mut IntegratorState,
        nodes: &NodeValues,
        attitudes: &NodeAttitudes,
    ) {
        let [position, velocity] = &mut state.com;
        *position += *velocity * self.h;
        if self.com_acceleration.is_some() {
            for (index, (weight, node)) in WEIGHTS.into_iter().zip(NODES).enumerate() {
                let com_acceleration = inertial(
                    &attitudes.at(&state.mean_attitude, index, self.h),
                    &vector(&nodes.com_acceleration, index),
                );
                *velocity += com_acceleration * (weight * self.h);
                *position += com_acceleration * (weight * (1.0 - node) * self.h * self.h);
            }
        }
    }

    /// Advances the state to the end of the step from the converged stages.
    fn end(
        &self,
        state: &mut IntegratorState,
        (nodes, attitudes): (&NodeValues, &NodeAttitudes),
        modes: &[ModeMemory],
        rotors: &RotorStage,
    ) {
        self.advance_centre_of_mass(state, nodes, attitudes);
        let [a, b, c] = weights(&WEIGHTS, self.h);
        let [momentum_rate, rigid_rate] = nodes.sums([a, b, c]);
        let attitude_change =
            attitudes.derivatives[0] * a + attitudes.derivatives[1] * b + attitudes.derivatives[2] * c;
        let IntegratorState {
            mean_attitude: attitude,
            mean_momentum: momentum,
            rigid_angle,
            rounding,
            modes: states,
            rotor_states,
            ..
        } = state;
        if self.bearings.is_some() {
            for (rotor, rates) in rotor_states.iter_mut().zip(&rotors.node_rates) {
                let change = rates[0] * a + rates[1] * b + rates[2] * c;
                (rotor.values, rotor.rounding) = exact_sum(rotor.values, change + rotor.rounding);
            }
        }
        (attitude.coords, rounding.0.coords) =
            exact_sum(attitude.coords, attitude_change.coords + rounding.0.coords);
        (*momentum, rounding.1) = exact_sum(*momentum, momentum_rate + rounding.1);
        (*rigid_angle, rounding.2) = exact_sum(*rigid_angle, rigid_rate + rounding.2);
        // The method preserves the norm up to rounding; the accumulated rounding is removed here.
        let excess = attitude.norm_squared() - 1.0;
        if excess.abs() > 4.0 * f64::EPSILON {
            *attitude *= 1.0 - 0.5 * excess;
        }
        let varying = self.has_varying_forces();
        let sum = |of: &[Vector2<f64>; 3], by: &[f64; 4]| of[0] * by[0] + of[1] * by[1] + of[2] * by[2];
        for ((memory, response), mode) in modes.iter().zip(self.responses).zip(states) {
            let by = &response.end;
            let mut end = Vector2::new(memory.known[0][3], memory.known[1][3]);
            end += sum(&by.of_rate, &memory.g);
            if varying {
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

impl IntegrationStep<'_> {
    /// Returns the momentum scale (N m s) against which changes of the momentum are compared. A hundredth of the
    /// rotors' momenta is included, because their sums are exact only to rounding of these.
    pub(super) fn momentum_scale(&self, state: &IntegratorState) -> f64 {
        let gimbal_momentum =
            self.gimbal_momentum.as_ref().map_or(0.0, |gimbal_momentum| length(&gimbal_momentum.start.0));
        let rotors = length(&self.rotors.0) + gimbal_momentum;
        length(&state.mean_momentum) + self.h * length(&self.torque) + ROTORS * rotors
    }

    /// Stores the canonical rates P of all modes at a node, if they turn rotors against the hub.
    pub(super) fn store_canonical_rates(
        &self,
        modes: &[ModeMemory],
        node: usize,
        optional: &mut OptionalStages,
    ) {
        if self.bearings.is_some_and(|bearings| bearings.has_tilts()) {
            optional.rotors.modal_rates.clear();
            optional.rotors.modal_rates.extend(modes.iter().map(|memory| memory.rate[node]));
        }
    }

    /// Stores q and P of a mode for the terms of articulated appendages.
    #[inline]
    pub(super) fn store_mode(
        &self,
        index: usize,
        q: f64,
        canonical_rate: f64,
        optional: &mut OptionalStages,
    ) {
        if self.appendages.is_some() {
            (optional.appendages.q[index], optional.appendages.p[index]) = (q, canonical_rate);
        }
    }
}

/// Scales Gauss-Legendre weights by the step length `h` (s).
#[inline]
pub fn weights(of: &[f64; 3], h: f64) -> [f64; 3] {
    [of[0] * h, of[1] * h, of[2] * h]
}

/// Returns the contributions to q and P/W at a node (or the end, 3) from values `by` at the three nodes.
#[inline]
pub fn mode_at_node(of: &[[[f64; 4]; 3]; 2], by: &[f64; 4], node: usize) -> [f64; 2] {
    of.map(|of| of[0][node] * by[0] + of[1][node] * by[1] + of[2][node] * by[2])
}
