//! Stages of a step at all three nodes at once: each iteration computes them from those of the last one, a node per
//! SIMD lane.
//!
//! The fourth lane holds the end of the step; it only fills the register and is never read.

use flexsc_numerics::attitude::{Vector, rotation};
use flexsc_numerics::gauss_legendre::{MATRIX, NODES, WEIGHTS};
use flexsc_numerics::lanes::{LaneFloat, SimdTask};
use nalgebra::{Matrix3, Quaternion};

use super::facing::NodeAttitudes;
use super::node_stages::NodeValues;
use super::settled::IterationChange;
use super::state::IntegratorState;
use super::step::{IntegrationStep, ModeMemory, PASSES, StageValues};
use super::vectors::{StoredVectors, Vectors, vector};
use crate::three_axis::model::{centrifugal_terms, tensor};
use crate::three_axis::rotation::SmallRotationLanes;

/// Inner iterations between momentum and rates in each iteration.
const AMONG: usize = 2;

/// Columns of the Gauss-Legendre matrix: the weights of each stage at all nodes, and at the end.
static COLUMNS: [[f64; 4]; 3] = [column(0), column(1), column(2)];

const fn column(stage: usize) -> [f64; 4] {
    [MATRIX[0][stage], MATRIX[1][stage], MATRIX[2][stage], WEIGHTS[stage]]
}

/// SIMD task that predicts the stages of a step: free response of the modes, and stages extrapolated from the start
/// by the growth rate of Gt.
pub(super) struct Predictor<'a> {
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
        let mut grows = if step.driven.is_some() { Vector::zeros() } else { start.push - step.rotors.1 };
        if let Some(swung) = step.swung.as_ref().filter(|_| step.driven.is_none()) {
            grows -= swung.start.1;
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
            (times * step.model.modes[index].rotation.dot(&grows) + g).store(&mut memory.g);
            memory.s = [s; 4];
        }
        let slope = step.model.inverse * grows;
        let none = Vectors::splat(kind, &Vector::zeros());
        let more = none.add_scaled(&slope, times);
        let momentum = Vectors::splat(kind, &state.momentum);
        (Vectors::splat(kind, &start.rigid) + more).store(&mut nodes.rigid);
        (Vectors::splat(kind, &start.mean) + more).store(&mut nodes.mean);
        Vectors::splat(kind, &start.turning).add_scaled(&grows, times).store(&mut nodes.turning);
        (Vectors::splat(kind, &start.push) - more.cross(momentum)).store(&mut nodes.push);
        Vectors::splat(kind, &start.pushed).store(&mut nodes.pushed);
    }
}

/// Returns the times of the nodes and of the end (s) for a step of `h` (s).
#[inline(always)]
fn times<R: LaneFloat>(kind: R, h: f64) -> R {
    kind.load(&[NODES[0], NODES[1], NODES[2], 1.0]) * h
}

/// Returns the momentum at the nodes, integrated from its rates `push` at the nodes.
#[inline(always)]
fn momentum<R: LaneFloat>(kind: R, from: &Vector, push: &StoredVectors, h: f64) -> Vectors<R> {
    let mut momentum = Vectors::splat(kind, from);
    for node in 0..3 {
        momentum = momentum.add_scaled(&vector(push, node), kind.load(&COLUMNS[node]) * h);
    }
    momentum
}

/// SIMD task that iterates the stages of a step without rotors in bearings and driven appendages; returns the number
/// of iterations.
pub(super) struct NodeIteration<'a> {
    pub step: &'a IntegrationStep<'a>,
    pub state: &'a IntegratorState,
    pub modes: &'a mut [ModeMemory],
    pub nodes: &'a mut NodeValues,
    pub facing: &'a mut NodeAttitudes,
    /// Scale of the modes' rates, against which changes of modal forces are compared (m sqrt(kg)/s).
    pub speed: f64,
}

/// Modal sums at the nodes: sum phi q, sum phi P, change of the inertia, and torque of moving points of application.
struct NodeDeformations<R> {
    bent: Vectors<R>,
    elastic: Vectors<R>,
    changed: [R; 6],
    levered: Vectors<R>,
}

/// Gt, the hub's rate and the environment's tidal tensor at the nodes.
struct NodeForcing<R> {
    turning: Vectors<R>,
    rate: Vectors<R>,
    tides: [Option<Matrix3<f64>>; 3],
}

impl SimdTask for NodeIteration<'_> {
    /// Number of iterations.
    type Output = u32;

    #[inline(always)]
    fn run<R: LaneFloat>(self, kind: R) -> u32 {
        let Self { step, state, modes, nodes, facing, speed } = self;
        let size = step.momentum_scale(state);
        let (seeks, loud) = (step.around.is_some(), step.has_varying_forces());
        let (mut before, mut passes) = (0.0, 0);
        while passes < PASSES {
            passes += 1;
            let shapes = if step.levers.is_empty() {
                shapes::<R, false>(kind, step, loud, modes)
            } else {
                shapes::<R, true>(kind, step, loud, modes)
            };
            let (felt, mut change) = turn(kind, step, (state, &*facing), &shapes, nodes);
            change.forced = update_modal_forcing(kind, step, (&felt, loud), modes);
            change.stretched = largest_norm_squared(&shapes.changed);
            change.rate = most(felt.rate.dot(felt.rate));
            if seeks {
                facing.compute(&state.attitude, &nodes.means(), step.h);
            }
            if step.has_converged(&change, size, speed, before) {
                break;
            }
            before = change.largest(step.h, size, speed);
        }
        if !seeks {
            facing.compute(&state.attitude, &nodes.means(), step.h);
        }
        passes
    }
}

/// Returns the largest of the values at the three nodes.
#[inline(always)]
fn most<R: LaneFloat>(of: R) -> f64 {
    let mut all = [0.0; 4];
    of.store(&mut all);
    all[0].max(all[1]).max(all[2])
}

/// Returns the largest squared norm of the symmetric tensors at the three nodes.
#[inline(always)]
fn largest_norm_squared<R: LaneFloat>(of: &[R; 6]) -> f64 {
    let [xx, yy, zz, yz, zx, xy] = *of;
    most(xx * xx + yy * yy + zz * zz + (yz * yz + zx * zx + xy * xy) * 2.0)
}

/// Computes q and P of all modes at the nodes and returns their sums; with `LEVERED`, also the torque by moving
/// points of application.
#[inline(always)]
fn shapes<R: LaneFloat, const LEVERED: bool>(
    kind: R,
    step: &IntegrationStep<'_>,
    loud: bool,
    modes: &mut [ModeMemory],
) -> NodeDeformations<R> {
    let zero = kind.splat(0.0);
    let none = Vectors { x: zero, y: zero, z: zero };
    let (mut bent, mut elastic, mut changed, mut levered) = (none, none, [zero; 6], none);
    let stretches = step.model.stretches;
    let count = modes.len();
    let (responses, constants) = (&step.responses[..count], &step.model.modes[..count]);
    for index in 0..count {
        let (memory, response, of) = (&mut modes[index], &responses[index], &constants[index]);
        let (mut q, mut p) = (kind.load(&memory.known[0]), kind.load(&memory.known[1]));
        for node in 0..3 {
            q = q + kind.load(&response.of_rate[0][node]) * memory.g[node];
            p = p + kind.load(&response.of_rate[1][node]) * memory.g[node];
        }
        if loud {
            for node in 0..3 {
                q = q + kind.load(&response.of_force[0][node]) * memory.s[node];
                p = p + kind.load(&response.of_force[1][node]) * memory.s[node];
            }
        }
        let rate = p * of.frequency;
        rate.store(&mut memory.rate);
        bent = bent.add_scaled(&of.rotation, q);
        elastic = elastic.add_scaled(&of.rotation, rate);
        if stretches {
            for entry in 0..6 {
                changed[entry] = changed[entry] + q * of.moments[entry];
            }
        }
        if LEVERED && index < step.levers.len() {
            levered = levered.add_scaled(&step.levers[index], q);
        }
    }
    NodeDeformations { bent, elastic, changed, levered }
}

/// Computes the motion of the body at the nodes and writes it to `nodes`; returns the modal forcing and the changes.
#[inline(always)]
fn turn<R: LaneFloat>(
    kind: R,
    step: &IntegrationStep<'_>,
    (state, facing): (&IntegratorState, &NodeAttitudes),
    shapes: &NodeDeformations<R>,
    nodes: &mut NodeValues,
) -> (NodeForcing<R>, IterationChange) {
    let (model, h) = (step.model, step.h);
    let momentum = momentum(kind, &state.momentum, &nodes.push, h);
    let bend = SmallRotationLanes::new(kind, shapes.bent);
    let times = times(kind, h);
    let (rotors, change) = &step.rotors;
    let mut free = bend.to_hub_axes(momentum) - Vectors::splat(kind, rotors).add_scaled(change, times);
    if let Some(swung) = &step.swung {
        free = free - Vectors::load(kind, &swung.nodes);
    }
    let (turning, rigid, rate) = if model.stretches {
        let (turning, rate) = model.momentum_and_rate_lanes(kind, free, shapes.elastic, &shapes.changed);
        (turning, turning.transform(&model.inverse), rate)
    } else {
        let rigid = free.transform(&model.inverse);
        (free, rigid, rigid + shapes.elastic + free.transform(&model.bending))
    };
    let (mut torque, mut tides) = (Vectors::splat(kind, &step.torque), [None; 3]);
    if !step.levers.is_empty() {
        torque = torque + shapes.levered;
    }
    if step.around.is_some() {
        torque = torque + surround(kind, step, (state, facing), shapes, &mut tides);
    }
    let mut mean = bend.to_mean_axes(rigid + bend.rate_correction(rate - rigid));
    let pull = bend.to_mean_axes(torque);
    let mut push = pull - mean.cross(momentum);
    // The momentum follows from these rates, and the rates from the momentum nearly as for a rigid body: cheap inner
    // iterations between the two save whole iterations.
    let (at, mut more) = (mean, Vectors::splat(kind, &Vector::zeros()));
    for _ in 0..AMONG {
        let mut kept = [[0.0; 4]; 3];
        push.store(&mut kept);
        let next = self::momentum(kind, &state.momentum, &kept, h);
        more = next - momentum;
        mean = at + more.transform(&model.inverse);
        push = pull - mean.cross(next);
    }
    let (turning, rigid, rate) = (turning + more, rigid + (mean - at), rate + (mean - at));
    if let Some(pushed) = &step.push {
        bend.to_mean_axes(Vectors::splat(kind, pushed)).store(&mut nodes.pushed);
    }
    let (by_push, by_mean, by_turning) = (
        push - Vectors::load(kind, &nodes.push),
        mean - Vectors::load(kind, &nodes.mean),
        turning - Vectors::load(kind, &nodes.turning),
    );
    let found = IterationChange {
        push: most(by_push.dot(by_push)),
        mean: most(by_mean.dot(by_mean)),
        turning: most(by_turning.dot(by_turning)),
        ..IterationChange::default()
    };
    push.store(&mut nodes.push);
    mean.store(&mut nodes.mean);
    rigid.store(&mut nodes.rigid);
    turning.store(&mut nodes.turning);
    (NodeForcing { turning, rate, tides }, found)
}

/// Returns the environment torque at the nodes (N m) and stores the tidal tensors there in `tides`.
#[inline(always)]
fn surround<R: LaneFloat>(
    kind: R,
    step: &IntegrationStep<'_>,
    (state, facing): (&IntegratorState, &NodeAttitudes),
    shapes: &NodeDeformations<R>,
    tides: &mut [Option<Matrix3<f64>>; 3],
) -> Vectors<R> {
    let (mut bent, mut changed, mut torque) = ([[0.0; 4]; 3], [[0.0; 4]; 6], [[0.0; 4]; 3]);
    shapes.bent.store(&mut bent);
    for entry in 0..6 {
        shapes.changed[entry].store(&mut changed[entry]);
    }
    for node in 0..3 {
        let at = facing.at(&state.attitude, node, step.h);
        let changed = tensor(changed.map(|of| of[node]));
        let (found, tide) = step.environment_at(NODES[node] * step.h, &at, &vector(&bent, node), &changed);
        for axis in 0..3 {
            torque[axis][node] = found[axis];
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
    (felt, loud): (&NodeForcing<R>, bool),
    modes: &mut [ModeMemory],
) -> f64 {
    let Vectors { x, y, z } = felt.rate;
    let spun = [x * x * 0.5, y * y * 0.5, z * z * 0.5, y * z, z * x, x * y];
    let stretches = step.model.stretches;
    let more = loud && (step.around.is_some() || step.model.beside.is_some());
    let mut change = kind.splat(0.0);
    let count = modes.len();
    let constants = &step.model.modes[..count];
    for index in 0..count {
        let (memory, of) = (&mut modes[index], &constants[index]);
        let g = felt.turning.dot_shared(&of.rotation);
        g.store(&mut memory.g);
        if more {
            (kind.load(&memory.rate) + g).store(&mut memory.rate);
        } else if stretches {
            let [xx, yy, zz, yz, zx, xy] = of.moments;
            let [a, b, c, d, e, f] = spun;
            let force = (a * xx + b * yy + c * zz) + (d * yz + e * zx + f * xy);
            let by = (force - kind.load(&memory.s)).abs();
            change = by.max(change);
            force.store(&mut memory.s);
        }
    }
    if !more {
        return most(change);
    }
    let mut rate = [[0.0; 4]; 3];
    felt.rate.store(&mut rate);
    step.force(&rate, &felt.tides, modes)
}

impl IntegrationStep<'_> {
    /// Updates modal forces that include tides, damping coupling or heating; returns the largest change (N/sqrt(kg)).
    fn force(
        &self,
        rate: &StoredVectors,
        tides: &[Option<Matrix3<f64>>; 3],
        modes: &mut [ModeMemory],
    ) -> f64 {
        let mut change = 0.0_f64;
        for node in 0..3 {
            let spun = centrifugal_terms(&vector(rate, node));
            for index in 0..modes.len() {
                let mut force = self.model.modes[index].centrifugal_force(&spun);
                force += self.additional_force(
                    (index, node),
                    NODES[node] * self.h,
                    tides[node].as_ref(),
                    modes,
                    &[],
                );
                let memory = &mut modes[index];
                change = change.max((force - memory.s[node]).abs());
                memory.s[node] = force;
            }
        }
        change
    }

    /// Returns the environment torque (N m) and the tidal tensor `t` (s) after the start of the step, given the
    /// attitude of the mean axes, the elastic rotation of the hub `bent` and the change of the inertia.
    pub(super) fn environment_at(
        &self,
        t: f64,
        facing: &Quaternion<f64>,
        bent: &Vector,
        changed: &Matrix3<f64>,
    ) -> (Vector, Option<Matrix3<f64>>) {
        let Some((around, since)) = self.around else { return (Vector::zeros(), None) };
        let hub = facing * rotation(bent);
        let torque = around.torque(since + t, &hub, &(self.model.inertia + changed));
        let tide = if self.model.stretches { around.tidal_tensor(since + t, &hub) } else { None };
        (torque, tide)
    }
}
