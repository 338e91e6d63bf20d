//! A step: what it is given, and what it keeps.

use nalgebra::Matrix3;

use super::bearing::{Borne, Spun};
use super::driven::{Driving, Scratch};
use super::gimbal::Swung;
use super::model::{Model, Surroundings};
use super::response::NodeResponse;
use super::state::TurningState;
use super::vectors::length;
use crate::attitude::Vector;

/// Passes after which the stages are taken as they are.
pub(super) const PASSES: u32 = 60;

/// The part of the rotors' momenta below which none of the whole counts.
const ROTORS: f64 = 1e-2;

/// A step: what moves, for how long, and what acts.
pub(super) struct TurningStep<'a> {
    pub model: &'a Model,
    /// The modes' responses over the step.
    pub responses: &'a [NodeResponse],
    /// Length (s).
    pub h: f64,
    /// Torque on the hub in its axes (N m).
    pub torque: Vector,
    /// The acceleration of the centre of mass in the hub's axes (m/s²), if anything pushes it.
    pub push: Option<Vector>,
    /// Modal forces, without what the torque gives (N/sqrt(kg)).
    pub forces: &'a [f64],
    /// What a unit of each mode adds to the torque (N/sqrt(kg)).
    pub levers: &'a [Vector],
    /// Momentum of the rotors at the start of the step (N m s), and its rate (N m).
    pub rotors: (Vector, Vector),
    /// Rotors in bearings, which are not among them; their momenta are parts of the state.
    pub borne: Option<Borne<'a>>,
    /// Rotors in gimbals.
    pub swung: Option<Swung>,
    /// The surroundings, and the time since the start of the run (s).
    pub around: Option<(&'a dyn Surroundings, f64)>,
    /// Drives that turn appendages, and the time since the departure (s).
    pub driven: Option<(&'a Driving, f64)>,
}

/// What steps keep of rotors in bearings and of drives.
#[derive(Clone, Debug, Default)]
pub(super) struct Beside {
    pub spun: Spun,
    pub driven: Scratch,
}

/// What a step keeps of a mode, so that no register of four straddles two lines of the cache.
#[derive(Clone, Debug, Default)]
#[repr(align(32))]
pub(super) struct Memory {
    /// g and s at the start of the step.
    pub start: [f64; 2],
    /// q and P/W at the nodes and the end, but for g and s.
    pub known: [[f64; 4]; 2],
    /// phi' Gt, and the varying force s, at the nodes; the fourth is none.
    pub g: [f64; 4],
    pub s: [f64; 4],
    /// P at the nodes, then q'.
    pub rate: [f64; 4],
}

/// What a stage comes to.
#[derive(Copy, Clone, Debug)]
pub(super) struct StepStage {
    /// H_m'.
    pub push: Vector,
    /// w_m.
    pub mean: Vector,
    /// J^-1 Gt, and Gt.
    pub rigid: Vector,
    pub turning: Vector,
    /// The acceleration of the centre of mass in mean axes (m/s²).
    pub pushed: Vector,
}

/// Gt, the hub's rate and the surroundings' tide, which modes feel.
pub(super) struct FeltByModes {
    pub turning: Vector,
    pub rate: Vector,
    pub tide: Option<Matrix3<f64>>,
    /// Since the start of the step (s).
    pub t: f64,
    /// The start of the step, and its nodes, from 0.
    pub stage: usize,
}

impl TurningStep<'_> {
    /// What the momentum is measured by (N m s): sums of rotors' momenta are no more exact than a part of these.
    pub(super) fn size(&self, state: &TurningState) -> f64 {
        let swung = self.swung.as_ref().map_or(0.0, |swung| length(&swung.start.0));
        let rotors = length(&self.rotors.0) + swung;
        length(&state.momentum) + self.h * length(&self.torque) + ROTORS * rotors
    }

    /// Keeps q and P of a mode, where drives turn what the others make of them.
    #[inline]
    pub(super) fn keep(&self, index: usize, q: f64, p: f64, beside: &mut Beside) {
        if self.driven.is_some() {
            (beside.driven.q[index], beside.driven.p[index]) = (q, p);
        }
    }
}

/// The rates of the mean axes.
pub(super) fn means(stages: &[StepStage; 3]) -> [Vector; 3] {
    [stages[0].mean, stages[1].mean, stages[2].mean]
}

/// The weights of the stages in a step of `h` seconds.
#[inline]
pub(super) fn weights(of: &[f64; 3], h: f64) -> [f64; 3] {
    [of[0] * h, of[1] * h, of[2] * h]
}

/// What q and P/W make at a node, or the end, of numbers at all nodes.
#[inline]
pub(super) fn answer(of: &[[[f64; 4]; 3]; 2], by: &[f64; 4], node: usize) -> [f64; 2] {
    of.map(|of| of[0][node] * by[0] + of[1][node] * by[1] + of[2][node] * by[2])
}
