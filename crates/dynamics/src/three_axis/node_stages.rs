//! Stage values at the three nodes of a step, stored as structure of arrays for SIMD.

use flexsc_numerics::attitude::Vector;

use super::step::StageValues;
use super::vectors::{StoredVectors, vector};

/// Stage values at the nodes of a step: each component has a lane per node; the fourth lane is unused.
#[derive(Clone, Debug, Default)]
#[repr(align(32))]
pub(super) struct NodeValues {
    pub push: StoredVectors,
    pub mean: StoredVectors,
    pub rigid: StoredVectors,
    pub turning: StoredVectors,
    pub pushed: StoredVectors,
}

impl NodeValues {
    /// Returns the stage at a node.
    pub fn stage(&self, node: usize) -> StageValues {
        StageValues {
            push: vector(&self.push, node),
            mean: vector(&self.mean, node),
            rigid: vector(&self.rigid, node),
            turning: vector(&self.turning, node),
            pushed: vector(&self.pushed, node),
        }
    }

    /// Returns the stages at all three nodes.
    pub fn stages(&self) -> [StageValues; 3] {
        [self.stage(0), self.stage(1), self.stage(2)]
    }

    /// Overwrites the values with stages that were computed node by node.
    pub fn set_stages(&mut self, stages: &[StageValues; 3]) {
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

    /// Returns the weighted sums of H_m' and J^-1 Gt over the nodes.
    pub fn sums(&self, [a, b, c]: [f64; 3]) -> [Vector; 2] {
        [&self.push, &self.rigid].map(|of| vector(of, 0) * a + vector(of, 1) * b + vector(of, 2) * c)
    }

    /// Returns the rates of the mean axes at the nodes (rad/s).
    pub fn means(&self) -> [Vector; 3] {
        [vector(&self.mean, 0), vector(&self.mean, 1), vector(&self.mean, 2)]
    }
}
