//! Estimator of the attitude from a gyro and delayed observations: the filter's recent past, and the propagation to an instant.

use crate::attitude_filter::{AttitudeBiasFilter, GyroNoise};
use crate::attitude_history::{AttitudeHistory, AttitudeHistoryEntry, DelayedObservation};
use crate::attitude_observation::AttitudeObservation;
use crate::quaternion::Quaternion;
use crate::ticks::Ticks;
use crate::vector3::Vector3;

/// Time of the start.
const START: Ticks = Ticks { whole: 0, part: 0 };

/// Returns the end of the interval that a gyro reading covers, which arrives with a latency; before the first latency has elapsed,
/// the start.
#[inline]
pub fn gyro_exposure(now: Ticks, latency: Ticks) -> Ticks {
    if now.is_before(latency) { START } else { now.since(latency) }
}

/// Returns the time of exposure of an observation that arrives with a latency; at the start it has none.
#[inline]
pub fn observation_exposure(now: Ticks, latency: Ticks) -> Ticks {
    if now.whole == 0 && now.part == 0 { START } else { now.since(latency) }
}

/// Estimator of the attitude. The caller gives the storage of its recent past, the same at every call.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct AttitudeEstimator {
    /// Recent past of the filter.
    pub history: AttitudeHistory,
    /// Last gyro reading (rad/s).
    pub reading: Vector3,
    /// Time at which the interval of that reading ended.
    pub since: Ticks,
}

impl AttitudeEstimator {
    /// Starts the estimator with a filter at the start of time.
    pub fn start(
        filter: AttitudeBiasFilter,
        noise: GyroNoise,
        reach: Ticks,
        entries: &mut [AttitudeHistoryEntry],
    ) -> Self {
        let history: AttitudeHistory = AttitudeHistory::start(START, filter, noise, reach, entries);
        Self { history, reading: Vector3::ZERO, since: START }
    }

    /// Takes a gyro reading (rad/s) at `now`. It comes before the observations of the same time.
    pub fn take_gyro(
        &mut self,
        now: Ticks,
        latency: Ticks,
        reading: Vector3,
        entries: &mut [AttitudeHistoryEntry],
        observations: &mut [DelayedObservation],
    ) {
        self.reading = reading;
        self.since = gyro_exposure(now, latency);
        self.history.add_gyro(self.since, reading, entries, observations);
    }

    /// Takes an observation at `now`.
    pub fn take_observation(
        &mut self,
        now: Ticks,
        latency: Ticks,
        observation: &AttitudeObservation,
        entries: &mut [AttitudeHistoryEntry],
        observations: &mut [DelayedObservation],
    ) {
        let delayed: DelayedObservation =
            DelayedObservation { exposed: observation_exposure(now, latency), observation: *observation };
        self.history.add_observation(delayed, entries, observations);
    }

    /// Returns the attitude at `now`, propagated with the last gyro reading.
    pub fn attitude(&self, now: Ticks, entries: &[AttitudeHistoryEntry]) -> Quaternion {
        let seconds: f64 = now.since(self.since).seconds();
        entries[self.history.latest()].filter.attitude_after(&self.reading, seconds)
    }

    /// Returns the rate of the body (rad/s): the last gyro reading without the estimated bias.
    pub fn rate(&self, entries: &[AttitudeHistoryEntry]) -> Vector3 {
        self.reading.minus(&entries[self.history.latest()].filter.bias)
    }
}
