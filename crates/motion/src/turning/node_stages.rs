//! The stages of a step at its nodes, side by side.

use super::step::StepStage;
use super::vectors::{StoredVectors, vector};
use crate::attitude::Vector;

/// The stages of a step at its nodes.
#[derive(Clone, Debug, Default)]
#[repr(align(32))]
pub(super) struct Nodes {
    pub push: StoredVectors,
    pub mean: StoredVectors,
    pub rigid: StoredVectors,
    pub turning: StoredVectors,
    pub pushed: StoredVectors,
}

impl Nodes {
    /// The stage at a node.
    pub fn stage(&self, node: usize) -> StepStage {
        StepStage {
            push: vector(&self.push, node),
            mean: vector(&self.mean, node),
            rigid: vector(&self.rigid, node),
            turning: vector(&self.turning, node),
            pushed: vector(&self.pushed, node),
        }
    }

    /// All of them.
    pub fn stages(&self) -> [StepStage; 3] {
        [self.stage(0), self.stage(1), self.stage(2)]
    }

    /// Takes over stages that were found one by one.
    pub fn keep(&mut self, stages: &[StepStage; 3]) {
        for (node, stage) in stages.iter().enumerate() {
            for axis in 0..3 {
                self.push[axis][node] = stage.push[axis];
                self.mean[axis][node] = stage.mean[axis];
                self.rigid[axis][node] = stage.rigid[axis];
                self.turning[axis][node] = stage.turning[axis];
                self.pushed[axis][node] = stage.pushed[axis];
            }
        }
    }

    /// The sums of H_m' and J^-1 Gt by these weights.
    pub fn sums(&self, [a, b, c]: [f64; 3]) -> [Vector; 2] {
        [&self.push, &self.rigid].map(|of| vector(of, 0) * a + vector(of, 1) * b + vector(of, 2) * c)
    }

    /// The rates of the mean axes.
    pub fn means(&self) -> [Vector; 3] {
        [vector(&self.mean, 0), vector(&self.mean, 1), vector(&self.mean, 2)]
    }
}
