//! Data of one integration step: inputs, stage values and working memory.

use flexsc_numerics::attitude::Vector;
use nalgebra::Matrix3;

use super::appendages::{ArticulatedMotion, StageScratch};
use super::bearing::{BearingLoads, RotorStage};
use super::gimbal::GimbalMomentum;
use super::model::{BodyConstants, Surroundings};
use super::response::ModeResponse;
use super::state::IntegratorState;
use super::vectors::length;

/// Limit on the fixed-point iterations; beyond it the stages are accepted as they are.
pub(super) const PASSES: u32 = 60;

/// Fraction of the rotors' momenta that counts in the momentum scale for convergence (see [`IntegrationStep::size`]).
const ROTORS: f64 = 1e-2;

/// One integration step: the body, the step length and the loads.
pub(super) struct IntegrationStep<'a> {
    pub model: &'a BodyConstants,
    /// Exact responses of the modes over the step.
    pub responses: &'a [ModeResponse],
    /// Step length (s).
    pub h: f64,
    /// Torque on the hub in its axes (N m).
    pub torque: Vector,
    /// Acceleration of the centre of mass in the hub's axes (m/s²); `None` without an external force.
    pub push: Option<Vector>,
    /// Modal forces other than those of `torque` (N/sqrt(kg)).
    pub forces: &'a [f64],
    /// Torque on the hub per unit of each mode, from forces whose points of application move (N/sqrt(kg)).
    pub levers: &'a [Vector],
    /// Momentum of ideal rotors at the start of the step (N m s), and its rate (N m).
    pub rotors: (Vector, Vector),
    /// Rotors with bearing friction or imbalance, not included in `rotors`; their momenta are part of the state.
    pub borne: Option<BearingLoads<'a>>,
    /// Momentum of the rotors in gimbals over the step.
    pub swung: Option<GimbalMomentum>,
    /// Environment, and the time of the start of the step since the start of the run (s).
    pub around: Option<(&'a dyn Surroundings, f64)>,
    /// Appendages with drives or hinges, and the time of the start of the step since the start of the segment (s).
    pub driven: Option<(&'a ArticulatedMotion, f64)>,
}

/// Working memory of a step for rotors in bearings and driven appendages.
#[derive(Clone, Debug, Default)]
pub(super) struct OptionalStages {
    pub spun: RotorStage,
    pub driven: StageScratch,
}

/// Working memory of a step for one mode, aligned so that no register of four straddles two cache lines.
#[derive(Clone, Debug, Default)]
#[repr(align(32))]
pub(super) struct ModeMemory {
    /// Values of g and s at the start of the step.
    pub start: [f64; 2],
    /// Contributions to q and P/W at the nodes and the end that do not depend on g and s at the nodes.
    pub known: [[f64; 4]; 2],
    /// Rate g = phi' Gt and varying force s at the nodes; the fourth entries are unused.
    pub g: [f64; 4],
    pub s: [f64; 4],
    /// P at the nodes; q' once g has been added.
    pub rate: [f64; 4],
}

/// Values at one Gauss-Legendre stage.
#[derive(Copy, Clone, Debug)]
pub(super) struct StageValues {
    /// Rate H_m' of the total momentum in mean axes (N m).
    pub push: Vector,
    /// Rate w_m of the mean axes (rad/s).
    pub mean: Vector,
    /// Rigid rate J^-1 Gt (rad/s), and rigid momentum Gt (N m s).
    pub rigid: Vector,
    pub turning: Vector,
    /// Acceleration of the centre of mass in mean axes (m/s²).
    pub pushed: Vector,
}

/// Quantities that force the modes at a stage: Gt, the hub's rate and the tidal tensor of the environment.
pub(super) struct ModalForcing {
    pub turning: Vector,
    pub rate: Vector,
    pub tide: Option<Matrix3<f64>>,
    /// Time since the start of the step (s).
    pub t: f64,
    /// Index of the stage: 0 for the start of the step, then 1 to 3 for the nodes.
    pub stage: usize,
}

impl IntegrationStep<'_> {
    /// Returns the momentum scale (N m s) against which changes of the momentum are compared. A hundredth of the
    /// rotors' momenta is included, because their sums are exact only to rounding of these.
    pub(super) fn momentum_scale(&self, state: &IntegratorState) -> f64 {
        let swung = self.swung.as_ref().map_or(0.0, |swung| length(&swung.start.0));
        let rotors = length(&self.rotors.0) + swung;
        length(&state.momentum) + self.h * length(&self.torque) + ROTORS * rotors
    }

    /// Stores q and P of a mode for the appendage terms of bodies with drives.
    #[inline]
    pub(super) fn store_mode(&self, index: usize, q: f64, p: f64, beside: &mut OptionalStages) {
        if self.driven.is_some() {
            (beside.driven.q[index], beside.driven.p[index]) = (q, p);
        }
    }
}

/// Returns the rates of the mean axes at the stages.
pub(super) fn means(stages: &[StageValues; 3]) -> [Vector; 3] {
    [stages[0].mean, stages[1].mean, stages[2].mean]
}

/// Scales Gauss-Legendre weights by the step length `h` (s).
#[inline]
pub(super) fn weights(of: &[f64; 3], h: f64) -> [f64; 3] {
    [of[0] * h, of[1] * h, of[2] * h]
}

/// Returns the contributions to q and P/W at a node (or the end, 3) from values `by` at the three nodes.
#[inline]
pub(super) fn mode_at_node(of: &[[[f64; 4]; 3]; 2], by: &[f64; 4], node: usize) -> [f64; 2] {
    of.map(|of| of[0][node] * by[0] + of[1][node] * by[1] + of[2][node] * by[2])
}
