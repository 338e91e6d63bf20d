//! Estimate of the motion about one axis by a Kalman filter: a step for each sample, and what the law reads.

use crate::filter_lock::FilterLock;
use crate::kalman::{KalmanInnovation, KalmanSample, predict, total, update};

/// Angle and rate that a law reads.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum KalmanFeed {
    /// Angle and rate as measured.
    Measured,
    /// Angle and rate of the hub, elastic part included.
    Hub,
    /// Rigid angle and rate.
    Rigid,
}

/// Estimate about an axis.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct KalmanAxis {
    /// Angle and rate that the law reads.
    pub feed: KalmanFeed,
    /// Number of states of the motion.
    pub motion: usize,
    /// Index of the dominant mode.
    pub mode: usize,
    /// Lock of the filter.
    pub lock: FilterLock,
    /// True if the distribution could not be propagated.
    pub is_broken: bool,
    /// True from the first sample on.
    pub has_sample: bool,
    /// Estimated angle (rad).
    pub angle: f64,
    /// Estimated rate (rad/s).
    pub rate: f64,
    /// Displacement of the dominant mode (rad); 0 without lock.
    pub displacement: f64,
    /// Rate of that displacement (rad/s); 0 without lock.
    pub displacement_rate: f64,
}

impl KalmanAxis {
    /// Returns the estimate before the first sample, for a number of measurements per sample.
    pub fn new(feed: KalmanFeed, motion: usize, mode: usize, measurements: u32) -> Self {
        Self {
            feed,
            motion,
            mode,
            lock: FilterLock::new(measurements),
            is_broken: false,
            has_sample: false,
            angle: 0.0,
            rate: 0.0,
            displacement: 0.0,
            displacement_rate: 0.0,
        }
    }

    /// Returns true if the filter has lost lock.
    #[inline]
    pub fn has_lost_lock(&self) -> bool {
        self.is_broken || self.lock.is_lost
    }

    /// Takes a sample, after a period with this mean reduced moment (rad/s²).
    pub fn take(
        &mut self,
        model: &[f64],
        moment: f64,
        sample: &KalmanSample,
        mean: &mut [f64],
        covariance: &mut [f64],
        buffer: &mut [f64],
    ) {
        if self.has_sample {
            let is_propagated: bool = predict(model, moment, mean, covariance, buffer);
            self.is_broken = self.is_broken || !is_propagated;
        }
        self.has_sample = true;
        let innovation: KalmanInnovation = update(sample, mean, covariance, buffer);
        self.lock.update(innovation.is_accepted, innovation.square, innovation.angle);
        let is_lost: bool = self.has_lost_lock();
        self.displacement = if is_lost { 0.0 } else { mean[2 + 2 * self.mode] };
        self.displacement_rate = if is_lost { 0.0 } else { mean[3 + 2 * self.mode] };
        if sample.is_measured {
            self.angle = sample.angle;
            self.rate = sample.rate;
        }
        if self.feed == KalmanFeed::Hub {
            self.angle = total(mean, 0, self.motion);
            self.rate = total(mean, 1, self.motion);
        }
        if self.feed == KalmanFeed::Rigid {
            self.angle = mean[0];
            self.rate = mean[1];
        }
    }

    /// Shifts the estimated angle by a change of the target (rad); one that is not finite changes nothing.
    pub fn shift(&mut self, by: f64, mean: &mut [f64]) {
        if by.is_finite() {
            mean[0] += by;
            self.angle += by;
        }
    }
}

/// Sets the mean and the covariance of a filter: the mean to the numbers of `given` from `first` on, the covariance to independent
/// states with these variances.
pub fn reset(given: &[f64], first: usize, variances: &[f64], mean: &mut [f64], covariance: &mut [f64]) {
    let order: usize = variances.len();
    for entry in 0..covariance.len() {
        covariance[entry] = 0.0;
    }
    for index in 0..order {
        mean[index] = given[first + index];
        covariance[index * (order + 1)] = variances[index];
    }
}
