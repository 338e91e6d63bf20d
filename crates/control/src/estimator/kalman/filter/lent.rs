//! What a filter does on its own while its mean and covariance are carried on beside those of other runs.

use super::beside::dot;
use super::{FARTHEST, Filters, Innovation, KalmanFilter};
use crate::lanes::Real;

/// What a filter has of a step that was made beside others.
#[derive(Copy, Clone, Debug, Default)]
pub struct LentStep {
    /// What the sample told; none if it was not taken so.
    told: Option<Innovation>,
    /// The normalised error of the estimate, if it is assessed.
    nees: f64,
    /// Whether this filter goes on side by side.
    pub lent: bool,
}

impl<R: Real> Filters<R> {
    /// How many components each has.
    pub fn count(&self) -> usize {
        self.order
    }

    /// Lets a filter draw its conclusions from what its sample told.
    pub fn settle(&mut self, lane: usize, filter: &mut KalmanFilter, gated: bool, innovation: f64, nis: f64) {
        filter.before.0.copy_from(&filter.mean);
        let (told, rests) = filter.settle(gated, innovation, Some(nis));
        filter.beside.told = Some(told);
        if rests {
            for rate in (self.motion + 1..self.order).step_by(2) {
                let (at, mean) = (rate * self.order + rate, filter.before.0[rate]);
                let more = self.covariance[at].lane(lane) + mean * mean;
                self.covariance[at] = self.covariance[at].with_lane(lane, more);
            }
        }
    }

    /// The normalised squared errors of the estimates against true states, component by component; NaN where a covariance
    /// has no root.
    #[inline(always)]
    pub fn nees(&mut self, truth: &[R]) -> R {
        let order = self.order;
        let zero = self.angle_noise.of(0.0);
        let root = &mut self.room;
        root.copy_from_slice(&self.covariance);
        for j in 0..order {
            for k in 0..j {
                let factor = -root[k * order + j];
                for row in j..order {
                    root[j * order + row] = factor * root[k * order + row] + root[j * order + row];
                }
            }
            let pivot = root[j * order + j].sqrt();
            root[j * order + j] = pivot;
            for row in j + 1..order {
                root[j * order + row] = root[j * order + row] / pivot;
            }
        }
        let (error, b) = self.tangent[..2 * order].split_at_mut(order);
        for at in 0..order {
            error[at] = truth[at] - self.mean[at];
            b[at] = error[at];
        }
        for i in 0..order {
            let coefficient = b[i] / root[i * order + i];
            b[i] = coefficient;
            for row in i + 1..order {
                b[row] = -coefficient * root[i * order + row] + b[row];
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
    /// The largest normalised square of an innovation.
    pub const FARTHEST: f64 = FARTHEST * FARTHEST;

    /// Whether the dominant mode moves too little, by the means as they are.
    pub fn moves_too_little(&self) -> bool {
        self.is_still()
    }

    /// Whether its samples are taken beside others.
    pub fn is_lent(&self) -> bool {
        self.beside.lent
    }

    /// What the sample told that was taken beside others.
    pub fn told_beside(&mut self) -> Option<Innovation> {
        self.beside.told.take()
    }

    /// The error of an estimate that is assessed beside others.
    pub fn assess_beside(&mut self, nees: f64) {
        self.beside.nees = if nees <= Self::FARTHEST { nees } else { Self::FARTHEST };
    }

    /// See `assess_beside`.
    pub fn nees_beside(&self) -> f64 {
        self.beside.nees
    }
}
