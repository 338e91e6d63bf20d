//! Stages of a step at all three nodes at once: each iteration computes them from those of the last one, a node per
//! SIMD lane.
//!
//! The fourth lane holds the end of the step; it only fills the register and is never read.

use flexsc_numerics::attitude::{Vector, rotation};
use flexsc_numerics::gauss_legendre::{MATRIX, NODES, WEIGHTS};
use flexsc_numerics::lanes::{LaneFloat, SimdTask};
use nalgebra::{Matrix3, Quaternion};

use super::attitude_nodes::NodeAttitudes;
use super::convergence::IterationChange;
use super::predictor::times;
use super::stage_values::NodeValues;
use super::{IntegrationStep, MAX_ITERATIONS, ModeMemory};
use crate::three_axis::constants::{centrifugal_terms, tensor};
use crate::three_axis::rotors::RotorStage;
use crate::three_axis::small_rotation::SmallRotationLanes;
use crate::three_axis::state::IntegratorState;
use crate::three_axis::surroundings::SkyAt;
use crate::three_axis::vectors::{StoredVectors, Vectors, vector};

/// Inner iterations between momentum and rates in each iteration.
const INNER_ITERATIONS: usize = 2;

/// Columns of the Gauss-Legendre matrix: the weights of each stage at all nodes, and at the end.
static COLUMNS: [[f64; 4]; 3] = [column(0), column(1), column(2)];

const fn column(stage: usize) -> [f64; 4] {
    [MATRIX[0][stage], MATRIX[1][stage], MATRIX[2][stage], WEIGHTS[stage]]
}

/// Returns the momentum at the nodes, integrated from its rates `momentum_rate` at the nodes.
#[inline(always)]
fn momentum<R: LaneFloat>(kind: R, from: &Vector, momentum_rate: &StoredVectors, h: f64) -> Vectors<R> {
    let mut momentum = Vectors::splat(kind, from);
    for node in 0..3 {
        momentum = momentum.add_scaled(&vector(momentum_rate, node), kind.load(&COLUMNS[node]) * h);
    }
    momentum
}

/// SIMD task that iterates the stages of a step without rotors in bearings and without articulated appendages; returns the
/// number of iterations.
pub struct NodeIteration<'a> {
    pub step: &'a IntegrationStep<'a>,
    pub state: &'a IntegratorState,
    /// Surroundings at the nodes.
    pub skies: &'a [SkyAt; 3],
    pub modes: &'a mut [ModeMemory],
    pub nodes: &'a mut NodeValues,
    pub attitudes: &'a mut NodeAttitudes,
    /// Scale of the modes' rates, against which changes of modal forces are compared (m sqrt(kg)/s).
    pub modal_rate_scale: f64,
}

/// Modal sums at the nodes: sum phi q, sum phi P, change of the inertia, and torque of moving points of application.
struct NodeDeformations<R> {
    elastic_rotation: Vectors<R>,
    canonical_elastic_rate: Vectors<R>,
    inertia_change: [R; 6],
    arm_torque: Vectors<R>,
}

/// Gt, the hub's rate and the environment's tidal tensor at the nodes.
struct NodeForcing<R> {
    rigid_momentum: Vectors<R>,
    rate: Vectors<R>,
    tides: [Option<Matrix3<f64>>; 3],
}

impl SimdTask for NodeIteration<'_> {
    /// Number of iterations.
    type Output = u32;

    #[inline(always)]
    fn run<R: LaneFloat>(self, kind: R) -> u32 {
        let Self { step, state, skies, modes, nodes, attitudes, modal_rate_scale } = self;
        let momentum_scale = step.momentum_scale(state);
        let (uses_attitude, varying) = (step.surroundings.is_some(), step.has_varying_forces());
        let (mut previous, mut iterations) = (0.0, 0);
        while iterations < MAX_ITERATIONS {
            iterations += 1;
            let deformations = deformations(kind, step, varying, modes);
            let (forcing, mut change) =
                evaluate(kind, step, (state, &*attitudes, skies), &deformations, nodes);
            change.modal_force = update_modal_forcing(kind, step, (&forcing, varying), modes);
            change.inertia_change = largest_norm_squared(&deformations.inertia_change);
            change.rate = largest_of_nodes(forcing.rate.dot(forcing.rate));
            if uses_attitude {
                attitudes.compute(&state.mean_attitude, &nodes.mean_rates(), step.h);
            }
            if step.has_converged(&change, momentum_scale, modal_rate_scale, previous) {
                break;
            }
            previous = change.largest(step.h, momentum_scale, modal_rate_scale);
        }
        if !uses_attitude {
            attitudes.compute(&state.mean_attitude, &nodes.mean_rates(), step.h);
        }
        iterations
    }
}

/// Returns the largest of the values at the three nodes.
#[inline(always)]
fn largest_of_nodes<R: LaneFloat>(of: R) -> f64 {
    let mut all = [0.0; 4];
    of.store(&mut all);
    all[0].max(all[1]).max(all[2])
}

/// Returns the largest squared norm of the symmetric tensors at the three nodes.
#[inline(always)]
fn largest_norm_squared<R: LaneFloat>(of: &[R; 6]) -> f64 {
    let [xx, yy, zz, yz, zx, xy] = *of;
    largest_of_nodes(xx * xx + yy * yy + zz * zz + (yz * yz + zx * zx + xy * xy) * 2.0)
}

/// Computes q and P of all modes at the nodes and returns their sums.
#[inline(always)]
fn deformations<R: LaneFloat>(
    kind: R,
    step: &IntegrationStep<'_>,
    varying: bool,
    modes: &mut [ModeMemory],
) -> NodeDeformations<R> {
    let zero = kind.splat(0.0);
    let none = Vectors { x: zero, y: zero, z: zero };
    let (mut elastic_rotation, mut canonical_elastic_rate, mut inertia_change, mut arm_torque) =
        (none, none, [zero; 6], none);
    let changes_inertia = step.model.changes_inertia;
    let count = modes.len();
    let (responses, constants) = (&step.responses[..count], &step.model.modes[..count]);
    for index in 0..count {
        let (memory, response, of) = (&mut modes[index], &responses[index], &constants[index]);
        let (mut q, mut p) = (kind.load(&memory.known[0]), kind.load(&memory.known[1]));
        for node in 0..3 {
            q = q + kind.load(&response.of_rate[0][node]) * memory.g[node];
            p = p + kind.load(&response.of_rate[1][node]) * memory.g[node];
        }
        if varying {
            for node in 0..3 {
                q = q + kind.load(&response.of_force[0][node]) * memory.s[node];
                p = p + kind.load(&response.of_force[1][node]) * memory.s[node];
            }
        }
        let rate = p * of.frequency;
        rate.store(&mut memory.rate);
        q.store(&mut memory.q);
        elastic_rotation = elastic_rotation.add_scaled(&of.rotation, q);
        canonical_elastic_rate = canonical_elastic_rate.add_scaled(&of.rotation, rate);
    }
    // Sums of their own loops: all at once need more registers than there are.
    if changes_inertia {
        for index in 0..count {
            let q = kind.load(&modes[index].q);
            for entry in 0..6 {
                inertia_change[entry] = inertia_change[entry] + q * constants[index].moments[entry];
            }
        }
    }
    for (arm, memory) in step.force_arms.iter().zip(&*modes) {
        arm_torque = arm_torque.add_scaled(arm, kind.load(&memory.q));
    }
    NodeDeformations { elastic_rotation, canonical_elastic_rate, inertia_change, arm_torque }
}

/// Computes the motion of the body at the nodes and writes it to `nodes`; returns the modal forcing and the changes.
#[inline(always)]
fn evaluate<R: LaneFloat>(
    kind: R,
    step: &IntegrationStep<'_>,
    (state, attitudes, skies): (&IntegratorState, &NodeAttitudes, &[SkyAt; 3]),
    deformations: &NodeDeformations<R>,
    nodes: &mut NodeValues,
) -> (NodeForcing<R>, IterationChange) {
    let (model, h) = (step.model, step.h);
    let momentum = momentum(kind, &state.mean_momentum, &nodes.momentum_rate, h);
    let hub_to_mean = SmallRotationLanes::new(kind, deformations.elastic_rotation);
    let times = times(kind, h);
    let (rotors, change) = &step.rotors;
    let mut body_momentum =
        hub_to_mean.to_hub_axes(momentum) - Vectors::splat(kind, rotors).add_scaled(change, times);
    if let Some(gimbal_momentum) = &step.gimbal_momentum {
        body_momentum = body_momentum - Vectors::load(kind, &gimbal_momentum.nodes);
    }
    let (rigid_momentum, rigid_rate, rate) = if model.changes_inertia {
        let (rigid_momentum, rate) = model.momentum_and_rate_lanes(
            kind,
            body_momentum,
            deformations.canonical_elastic_rate,
            &deformations.inertia_change,
        );
        (rigid_momentum, rigid_momentum.transform(&model.inverse), rate)
    } else {
        let rigid_rate = body_momentum.transform(&model.inverse);
        (
            body_momentum,
            rigid_rate,
            rigid_rate + deformations.canonical_elastic_rate + body_momentum.transform(&model.bending),
        )
    };
    let (mut torque, mut tides) = (Vectors::splat(kind, &step.torque), [None; 3]);
    if !step.force_arms.is_empty() {
        torque = torque + deformations.arm_torque;
    }
    if step.surroundings.is_some() {
        torque = torque + environment_torque(kind, step, (state, attitudes, skies), deformations, &mut tides);
    }
    let mut mean_rate = hub_to_mean.to_mean_axes(rigid_rate + hub_to_mean.rate_correction(rate - rigid_rate));
    let torque_mean = hub_to_mean.to_mean_axes(torque);
    let mut momentum_rate = torque_mean - mean_rate.cross(momentum);
    // The momentum follows from these rates, and the rates from the momentum nearly as for a rigid body: cheap inner
    // iterations between the two save whole iterations.
    let (at, mut more) = (mean_rate, Vectors::splat(kind, &Vector::zeros()));
    for _ in 0..INNER_ITERATIONS {
        let mut kept = StoredVectors::default();
        momentum_rate.store(&mut kept);
        let next = self::momentum(kind, &state.mean_momentum, &kept, h);
        more = next - momentum;
        mean_rate = at + more.transform(&model.inverse);
        momentum_rate = torque_mean - mean_rate.cross(next);
    }
    let (rigid_momentum, rigid_rate, rate) =
        (rigid_momentum + more, rigid_rate + (mean_rate - at), rate + (mean_rate - at));
    if let Some(force) = &step.com_acceleration {
        hub_to_mean.to_mean_axes(Vectors::splat(kind, force)).store(&mut nodes.com_acceleration);
    }
    let (by_momentum_rate, by_mean, by_turning) = (
        momentum_rate - Vectors::load(kind, &nodes.momentum_rate),
        mean_rate - Vectors::load(kind, &nodes.mean_rate),
        rigid_momentum - Vectors::load(kind, &nodes.rigid_momentum),
    );
    let change = IterationChange {
        momentum_rate: largest_of_nodes(by_momentum_rate.dot(by_momentum_rate)),
        mean_rate: largest_of_nodes(by_mean.dot(by_mean)),
        rigid_momentum: largest_of_nodes(by_turning.dot(by_turning)),
        ..IterationChange::default()
    };
    momentum_rate.store(&mut nodes.momentum_rate);
    mean_rate.store(&mut nodes.mean_rate);
    rigid_rate.store(&mut nodes.rigid_rate);
    rigid_momentum.store(&mut nodes.rigid_momentum);
    (NodeForcing { rigid_momentum, rate, tides }, change)
}

/// Returns the environment torque at the nodes (N m) and stores the tidal tensors there in `tides`.
#[inline(always)]
fn environment_torque<R: LaneFloat>(
    kind: R,
    step: &IntegrationStep<'_>,
    (state, attitudes, skies): (&IntegratorState, &NodeAttitudes, &[SkyAt; 3]),
    deformations: &NodeDeformations<R>,
    tides: &mut [Option<Matrix3<f64>>; 3],
) -> Vectors<R> {
    let (mut elastic_rotation, mut inertia_change, mut torque) =
        (StoredVectors::default(), [[0.0; 4]; 6], StoredVectors::default());
    deformations.elastic_rotation.store(&mut elastic_rotation);
    for entry in 0..6 {
        deformations.inertia_change[entry].store(&mut inertia_change[entry]);
    }
    for node in 0..3 {
        let at = attitudes.at(&state.mean_attitude, node, step.h);
        let inertia_change = tensor(inertia_change.map(|of| of[node]));
        let (change, tide) =
            step.environment_at(&skies[node], &at, &vector(&elastic_rotation, node), &inertia_change);
        for axis in 0..3 {
            torque.0[axis][node] = change[axis];
        }
        tides[node] = tide;
    }
    Vectors::load(kind, &torque)
}

/// Updates the forcing g and s of the modes at the nodes; returns the largest change of a modal force (N/sqrt(kg)).
#[inline(always)]
fn update_modal_forcing<R: LaneFloat>(
    kind: R,
    step: &IntegrationStep<'_>,
    (forcing, varying): (&NodeForcing<R>, bool),
    modes: &mut [ModeMemory],
) -> f64 {
    let Vectors { x, y, z } = forcing.rate;
    let centrifugal = [x * x * 0.5, y * y * 0.5, z * z * 0.5, y * z, z * x, x * y];
    let changes_inertia = step.model.changes_inertia;
    let others = varying && (step.surroundings.is_some() || step.model.coupled_damping.is_some());
    let mut change = kind.splat(0.0);
    let count = modes.len();
    let constants = &step.model.modes[..count];
    for index in 0..count {
        let (memory, of) = (&mut modes[index], &constants[index]);
        let g = forcing.rigid_momentum.dot_shared(&of.rotation);
        g.store(&mut memory.g);
        if others {
            (kind.load(&memory.rate) + g).store(&mut memory.rate);
        } else if changes_inertia {
            let [xx, yy, zz, yz, zx, xy] = of.moments;
            let [a, b, c, d, e, f] = centrifugal;
            let force = (a * xx + b * yy + c * zz) + (d * yz + e * zx + f * xy);
            let by = (force - kind.load(&memory.s)).abs();
            change = by.max(change);
            force.store(&mut memory.s);
        }
    }
    if !others {
        return largest_of_nodes(change);
    }
    let mut rate = StoredVectors::default();
    forcing.rate.store(&mut rate);
    step.update_other_forces(&rate, &forcing.tides, modes)
}

impl IntegrationStep<'_> {
    /// Updates modal forces that include tides, damping coupling or heating; returns the largest change (N/sqrt(kg)).
    fn update_other_forces(
        &self,
        rate: &StoredVectors,
        tides: &[Option<Matrix3<f64>>; 3],
        modes: &mut [ModeMemory],
    ) -> f64 {
        let mut change = 0.0_f64;
        for node in 0..3 {
            let centrifugal = centrifugal_terms(&vector(rate, node));
            for index in 0..modes.len() {
                let mut force = self.model.modes[index].centrifugal_force(&centrifugal);
                force += self.additional_force(
                    (index, node),
                    NODES[node] * self.h,
                    tides[node].as_ref(),
                    modes,
                    &RotorStage::default(),
                );
                let memory = &mut modes[index];
                change = change.max((force - memory.s[node]).abs());
                memory.s[node] = force;
            }
        }
        change
    }

    /// Returns the environment torque (N m) and the tidal tensor under a sky, given the attitude of the mean axes, the elastic
    /// rotation of the hub `elastic_rotation` and the change of the inertia.
    pub(super) fn environment_at(
        &self,
        sky: &SkyAt,
        attitude: &Quaternion<f64>,
        elastic_rotation: &Vector,
        inertia_change: &Matrix3<f64>,
    ) -> (Vector, Option<Matrix3<f64>>) {
        let Some((surroundings, _)) = self.surroundings else { return (Vector::zeros(), None) };
        let hub = attitude * rotation(elastic_rotation);
        let torque = surroundings.torque(sky, &hub, &(self.model.inertia + inertia_change));
        let tide = if self.model.changes_inertia { surroundings.tidal_tensor(sky, &hub) } else { None };
        (torque, tide)
    }
}
