//! Values at the stages of a step: at one stage, at all three nodes in SIMD lanes, and for the forcing of the modes.

use flexsc_numerics::attitude::Vector;
use nalgebra::Matrix3;

use crate::three_axis::vectors::{StoredVectors, vector};

/// Motion of the body at one stage of a step.
#[derive(Copy, Clone, Debug)]
pub struct StageValues {
    /// Rate H_m' of the total momentum in mean axes (N m).
    pub momentum_rate: Vector,
    /// Rate w_m of the mean axes (rad/s).
    pub mean_rate: Vector,
    /// Rigid rate J^-1 Gt (rad/s), and rigid momentum Gt (N m s).
    pub rigid_rate: Vector,
    pub rigid_momentum: Vector,
    /// Acceleration of the centre of mass in mean axes (m/s²).
    pub com_acceleration: Vector,
}

/// Quantities that force the modes at a stage: Gt, the hub's rate and the tidal tensor of the environment.
pub struct ModalForcing {
    pub rigid_momentum: Vector,
    pub rate: Vector,
    pub tide: Option<Matrix3<f64>>,
    /// Time since the start of the step (s).
    pub t: f64,
    /// Index of the stage: 0 for the start of the step, then 1 to 3 for the nodes.
    pub stage: usize,
}

/// Returns the rates of the mean axes at the stages.
pub fn mean_rates(stages: &[StageValues; 3]) -> [Vector; 3] {
    [stages[0].mean_rate, stages[1].mean_rate, stages[2].mean_rate]
}

/// Stage values at the nodes of a step: each component has a lane per node; the fourth lane is unused.
#[derive(Clone, Debug, Default)]
pub struct NodeValues {
    pub momentum_rate: StoredVectors,
    pub mean_rate: StoredVectors,
    pub rigid_rate: StoredVectors,
    pub rigid_momentum: StoredVectors,
    pub com_acceleration: StoredVectors,
}

impl NodeValues {
    /// Returns the values at a node (0 to 2).
    pub fn at_node(&self, node: usize) -> StageValues {
        StageValues {
            momentum_rate: vector(&self.momentum_rate, node),
            mean_rate: vector(&self.mean_rate, node),
            rigid_rate: vector(&self.rigid_rate, node),
            rigid_momentum: vector(&self.rigid_momentum, node),
            com_acceleration: vector(&self.com_acceleration, node),
        }
    }

    /// Returns the stages at all three nodes.
    pub fn stages(&self) -> [StageValues; 3] {
        [self.at_node(0), self.at_node(1), self.at_node(2)]
    }

    /// Overwrites the values with stages that were computed node by node.
    pub fn set_stages(&mut self, stages: &[StageValues; 3]) {
        for (node, stage) in stages.iter().enumerate() {
            for axis in 0..3 {
                self.momentum_rate.0[axis][node] = stage.momentum_rate[axis];
                self.mean_rate.0[axis][node] = stage.mean_rate[axis];
                self.rigid_rate.0[axis][node] = stage.rigid_rate[axis];
                self.rigid_momentum.0[axis][node] = stage.rigid_momentum[axis];
                self.com_acceleration.0[axis][node] = stage.com_acceleration[axis];
            }
        }
    }

    /// Returns the weighted sums of H_m' and J^-1 Gt over the nodes.
    pub fn sums(&self, [a, b, c]: [f64; 3]) -> [Vector; 2] {
        [&self.momentum_rate, &self.rigid_rate]
            .map(|of| vector(of, 0) * a + vector(of, 1) * b + vector(of, 2) * c)
    }

    /// Returns the rates of the mean axes at the nodes (rad/s).
    pub fn mean_rates(&self) -> [Vector; 3] {
        [vector(&self.mean_rate, 0), vector(&self.mean_rate, 1), vector(&self.mean_rate, 2)]
    }
}
