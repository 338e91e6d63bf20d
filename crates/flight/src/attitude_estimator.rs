//! Estimator of the attitude from a gyro and delayed observations: the filter's recent past, and the propagation to an instant.

use crate::attitude_filter::{AttitudeBiasFilter, GyroNoise};
use crate::attitude_gate::AttitudeGate;
use crate::attitude_history::{AttitudeHistory, AttitudeHistoryEntry};
use crate::attitude_observation::{AttitudeObservation, Correction};
use crate::delayed_observation::DelayedObservation;
use crate::quaternion::Quaternion;
use crate::reading_status::ReadingStatus;
use crate::square_root::sqrt;
use crate::ticks::Ticks;
use crate::vector3::Vector3;

/// Number of components of a measurement, by which the normalised innovation squared is divided.
const COMPONENTS: f64 = 3.0;

/// Returns the end of the interval that a gyro reading covers, which arrives with a latency; until the first latency after the start
/// has elapsed, the start.
#[inline]
pub fn gyro_exposure(now: Ticks, latency: Ticks, start: Ticks) -> Ticks {
    if now.since(start).is_before(latency) && !now.is_before(start) { start } else { now.since(latency) }
}

/// Returns the time of exposure of an observation that arrives with a latency; at the start it has none.
#[inline]
pub fn observation_exposure(now: Ticks, latency: Ticks, start: Ticks) -> Ticks {
    if now.whole == start.whole && now.part == start.part { now } else { now.since(latency) }
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
    /// Time of the start.
    pub started: Ticks,
    /// Last measurement that corrected the filter.
    pub correction: Correction,
}

/// Estimate with its uncertainty, and counts of refused readings.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct EstimatorOutput {
    /// Estimated attitude.
    pub attitude: Quaternion,
    /// Estimated rate (rad/s).
    pub rate: Vector3,
    /// Number of readings of all sensors refused since the start.
    pub refused: u64,
    /// Time since the last correction, or since the start (s).
    pub age: f64,
    /// Innovation of the last correction, body axes (rad).
    pub innovation: Vector3,
    /// Normalised innovation squared of the last correction, over the number of its components.
    pub nis: f64,
    /// Standard deviation of the attitude about each axis (rad).
    pub deviation: Vector3,
}

impl AttitudeEstimator {
    /// Starts the estimator with a filter at `now`. An attitude that is not of unit length is replaced by the identity, and a bias
    /// that is not finite by 0.
    pub fn start(
        now: Ticks,
        filter: AttitudeBiasFilter,
        noise: GyroNoise,
        reach: Ticks,
        gate: AttitudeGate,
        entries: &mut [AttitudeHistoryEntry],
    ) -> Self {
        let mut sound: AttitudeBiasFilter = filter;
        if !filter.attitude.is_unit() {
            sound.attitude = Quaternion::IDENTITY;
        }
        if !filter.bias.norm_squared().is_finite() {
            sound.bias = Vector3::ZERO;
        }
        let history: AttitudeHistory = AttitudeHistory::start(now, sound, noise, reach, gate, entries);
        Self { history, reading: Vector3::ZERO, since: now, started: now, correction: Correction::NONE }
    }

    /// Takes a gyro reading (rad/s) at `now`. It comes before the observations of the same time.
    pub fn take_gyro(
        &mut self,
        now: Ticks,
        latency: Ticks,
        reading: Vector3,
        entries: &mut [AttitudeHistoryEntry],
        observations: &mut [DelayedObservation],
    ) -> ReadingStatus {
        let exposed: Ticks = gyro_exposure(now, latency, self.started);
        let status: ReadingStatus = self.history.judge_gyro(exposed, &reading, entries);
        if status == ReadingStatus::Accepted {
            self.reading = reading;
            self.since = exposed;
            let waited: Correction = self.history.add_gyro(exposed, reading, entries, observations);
            self.keep(&waited);
        }
        status
    }

    /// Takes an observation at `now`; `sensor` is the number of its counter of refused readings.
    pub fn take_observation(
        &mut self,
        sensor: usize,
        now: Ticks,
        latency: Ticks,
        observation: &AttitudeObservation,
        entries: &mut [AttitudeHistoryEntry],
        observations: &mut [DelayedObservation],
    ) -> ReadingStatus {
        let delayed: DelayedObservation = DelayedObservation {
            sensor,
            exposed: observation_exposure(now, latency, self.started),
            observation: *observation,
            angle_inflation: 0.0,
            bias_inflation: 0.0,
        };
        let correction: Correction = self.history.add_observation(delayed, entries, observations);
        self.keep(&correction);
        correction.status
    }

    /// Keeps a correction as the last one.
    fn keep(&mut self, correction: &Correction) {
        if correction.status.has_corrected() {
            self.correction = *correction;
        }
    }

    /// Returns the attitude at `now`, propagated with the last gyro reading.
    pub fn attitude(&self, now: Ticks, entries: &[AttitudeHistoryEntry]) -> Quaternion {
        let seconds: f64 = if now.is_before(self.since) { 0.0 } else { now.since(self.since).seconds() };
        entries[self.history.latest()].filter.attitude_after(&self.reading, seconds)
    }

    /// Returns the rate of the body (rad/s): the last gyro reading without the estimated bias.
    pub fn rate(&self, entries: &[AttitudeHistoryEntry]) -> Vector3 {
        self.reading.minus(&entries[self.history.latest()].filter.bias)
    }

    /// Returns the time (s) since the exposure of the last measurement that corrected the filter, or since the start.
    pub fn age(&self, now: Ticks) -> f64 {
        now.since(self.history.corrected).seconds()
    }

    /// Returns the size of the innovation of the last correction (rad).
    pub fn innovation_size(&self) -> f64 {
        self.correction.innovation.norm()
    }

    /// Returns the standard deviation of the attitude about all axes together (rad), by the covariance of the filter.
    pub fn deviation_size(&self, entries: &[AttitudeHistoryEntry]) -> f64 {
        let deviation: Vector3 = self.deviation(entries);
        deviation.norm()
    }

    /// Returns the standard deviation of the attitude about each axis (rad), by the covariance of the filter.
    pub fn deviation(&self, entries: &[AttitudeHistoryEntry]) -> Vector3 {
        let filter: AttitudeBiasFilter = entries[self.history.latest()].filter;
        Vector3 {
            x: sqrt(filter.covariance.rows[0][0]),
            y: sqrt(filter.covariance.rows[1][1]),
            z: sqrt(filter.covariance.rows[2][2]),
        }
    }

    /// Returns the estimate at `now` with its uncertainty.
    pub fn output(&self, now: Ticks, entries: &[AttitudeHistoryEntry]) -> EstimatorOutput {
        EstimatorOutput {
            attitude: self.attitude(now, entries),
            rate: self.rate(entries),
            refused: self.history.refusals(),
            age: self.age(now),
            innovation: self.correction.innovation,
            nis: self.correction.nis / COMPONENTS,
            deviation: self.deviation(entries),
        }
    }
}
