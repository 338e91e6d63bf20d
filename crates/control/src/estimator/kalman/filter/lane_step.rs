//! Steps of a filter whose mean and covariance are computed in a batch with those of other runs.

use flexsc_numerics::lanes::LaneFloat;

use super::lanes::dot;
use super::{FARTHEST, FilterLanes, Innovation, KalmanFilter};

/// Results of a filter's step in a batch.
#[derive(Copy, Clone, Debug, Default)]
pub struct LaneStep {
    /// Innovation of the sample; `None` if the batch did not process it.
    innovation: Option<Innovation>,
    /// Normalised squared error of the estimate, if it is assessed.
    nees: f64,
    /// True if the filter runs in a batch.
    pub in_lanes: bool,
}

impl<R: LaneFloat> FilterLanes<R> {
    /// Returns the number of state components of each filter.
    pub fn count(&self) -> usize {
        self.order
    }

    /// Completes the update of the filter in `lane` with its innovation and its NIS.
    pub fn apply(&mut self, lane: usize, filter: &mut KalmanFilter, gated: bool, innovation: f64, nis: f64) {
        filter.before.0.copy_from(&filter.mean);
        let (innovation, rests) = filter.settle(gated, innovation, Some(nis));
        filter.lane_step.innovation = Some(innovation);
        if rests {
            for rate in (self.motion + 1..self.order).step_by(2) {
                let (index, mean) = (rate * self.order + rate, filter.before.0[rate]);
                let more = self.covariance[index].lane(lane) + mean * mean;
                self.covariance[index] = self.covariance[index].with_lane(lane, more);
            }
        }
    }

    /// Returns the normalised squared errors against true states given by component; NaN where a covariance has no
    /// Cholesky factor.
    #[inline(always)]
    pub fn nees(&mut self, truth: &[R]) -> R {
        let order = self.order;
        let zero = self.angle_noise.splat(0.0);
        let root = &mut self.room;
        root.copy_from_slice(&self.covariance);
        for j in 0..order {
            let (left, right) = root.split_at_mut(j * order);
            for column in left.chunks_exact(order) {
                let factor = -column[j];
                for (entry, other) in right[j..order].iter_mut().zip(&column[j..]) {
                    *entry = factor * *other + *entry;
                }
            }
            let pivot = root[j * order + j].sqrt();
            root[j * order + j] = pivot;
            for entry in &mut root[j * order + j + 1..(j + 1) * order] {
                *entry = *entry / pivot;
            }
        }
        let (error, b) = self.tangent[..2 * order].split_at_mut(order);
        for index in 0..order {
            error[index] = truth[index] - self.mean[index];
            b[index] = error[index];
        }
        for i in 0..order {
            let coefficient = b[i] / root[i * order + i];
            b[i] = coefficient;
            for (entry, other) in b[i + 1..].iter_mut().zip(&root[i * order + i + 1..(i + 1) * order]) {
                *entry = -coefficient * *other + *entry;
            }
        }
        for i in (0..order).rev() {
            let sum = dot(zero, &root[i * order + i + 1..(i + 1) * order], &b[i + 1..]);
            b[i] = (b[i] - sum) / root[i * order + i];
        }
        dot(zero, error, b)
    }
}

impl KalmanFilter {
    /// Largest normalised square of an innovation that is accepted.
    pub const FARTHEST: f64 = FARTHEST * FARTHEST;

    /// Returns true if the dominant mode's amplitude, by the current mean, is below the gate.
    pub fn is_below_gate(&self) -> bool {
        self.is_still()
    }

    /// Returns true if the filter runs in a batch.
    pub fn is_in_lanes(&self) -> bool {
        self.lane_step.in_lanes
    }

    /// Moves out the innovation of the sample that the batch processed for this filter.
    pub fn lane_innovation(&mut self) -> Option<Innovation> {
        self.lane_step.innovation.take()
    }

    /// Sets the normalised squared error that the batch computed, limited to `FARTHEST`.
    pub fn set_lane_error(&mut self, nees: f64) {
        self.lane_step.nees = if nees <= Self::FARTHEST { nees } else { Self::FARTHEST };
    }

    /// Returns the normalised squared error set by `set_lane_error`.
    pub fn lane_nees(&self) -> f64 {
        self.lane_step.nees
    }
}
