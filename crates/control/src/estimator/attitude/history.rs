//! Attitude filter and its recent past: that of flight code, or one with elastic modes.

use flexsc_flight::attitude_filter::GyroNoise;
use flexsc_flight::attitude_gate::AttitudeGate;
use flexsc_flight::attitude_history::{AttitudeHistory, AttitudeHistoryEntry};
use flexsc_flight::attitude_observation::Correction;
use flexsc_flight::delayed_observation::DelayedObservation;
use flexsc_flight::reading_status::ReadingStatus;
use flexsc_flight_precision::Precision;
use flexsc_numerics::attitude::{Vector, rotation};
use flexsc_numerics::flight_types::{from_quaternion, from_vector3, to_vector3};
use flexsc_numerics::time::{Instant, Span};
use nalgebra::Quaternion;

use super::AttitudeFilterState;
use super::elastic_filter::ElasticFilter;
use super::elastic_history::ElasticHistory;
use super::elastic_states::ElasticFilterStates;
use super::measurement::DelayedMeasurement;

/// Filter and its recent past.
#[derive(Clone, Debug)]
pub enum FilterHistory {
    /// Filter of attitude and gyro bias.
    Rigid(RigidHistory),
    /// Filter of elastic modes too.
    Elastic(ElasticHistory),
}

/// History of the rigid attitude filter (flight code), with the buffers that it borrows.
#[derive(Clone, Debug)]
pub struct RigidHistory {
    counts: AttitudeHistory,
    entries: Vec<AttitudeHistoryEntry>,
    observations: Vec<DelayedObservation>,
    precision: Precision,
}

impl RigidHistory {
    fn latest(&self) -> &AttitudeHistoryEntry {
        &self.entries[self.counts.latest()]
    }

    /// Adds a gyro reading (rad/s), as [`AttitudeHistory::add_gyro`] does, and returns the results of the measurements that waited for
    /// it.
    fn add_gyro(&mut self, now: Instant, reading: Vector) -> Vec<(usize, Correction)> {
        self.grow();
        let Self { counts, entries, observations, precision } = self;
        let (now, mut results, mut early) = (now.ticks(), Vec::new(), 0);
        if precision.add_interval(counts, now, to_vector3(&reading), entries, observations) {
            while early < counts.waiting {
                let sensor = observations[counts.applied + early].sensor;
                match with_result(precision.apply_waiting(counts, early, now, entries, observations)) {
                    Some(result) => results.push((sensor, result)),
                    None => early += 1,
                }
            }
            counts.forget(now, entries);
        }
        results
    }

    /// Lets the storage grow before a call, which then never finds it full, and rarely moves entries within it.
    fn grow(&mut self) {
        let Self { counts, entries, observations, .. } = self;
        let least = 2 * (counts.entries + counts.waiting + 2);
        if entries.len() < least {
            entries.resize(2 * least, AttitudeHistoryEntry::NONE);
        }
        if counts.applied + counts.waiting == observations.len() {
            counts.discard_old(entries, observations);
            let least = 2 * (counts.applied + counts.waiting + 1);
            if observations.len() < least {
                observations.resize(2 * least, DelayedObservation::NONE);
            }
        }
    }
}

/// Returns the result of a reading, if it has one now.
fn with_result(correction: Correction) -> Option<Correction> {
    (correction.status != ReadingStatus::None && correction.status != ReadingStatus::Waiting)
        .then_some(correction)
}

impl FilterHistory {
    /// Creates the history of a filter at its first instant, with its modes if it estimates any; `reach` is the largest
    /// delay of a measurement, and `gate` limits the readings.
    pub fn new(
        time: Instant,
        state: AttitudeFilterState,
        modes: Option<ElasticFilterStates>,
        noise: GyroNoise,
        reach: Span,
        gate: AttitudeGate,
        precision: Precision,
    ) -> Self {
        if let Some(modes) = modes {
            return Self::Elastic(ElasticHistory::new(
                time,
                ElasticFilter { state, modes },
                noise,
                reach,
                gate,
            ));
        }
        let mut entries = vec![AttitudeHistoryEntry::NONE; 4];
        let reach = (Instant::START + reach).ticks();
        let counts =
            AttitudeHistory::start(time.ticks(), state.to_flight(), noise, reach, gate, &mut entries);
        Self::Rigid(RigidHistory { counts, entries, observations: Vec::new(), precision })
    }

    /// Returns the state of the filter after everything it has received.
    pub fn latest(&self) -> AttitudeFilterState {
        match self {
            Self::Rigid(history) => AttitudeFilterState::from_flight(&history.latest().filter),
            Self::Elastic(history) => history.latest().state,
        }
    }

    /// Returns the estimated gyro bias (rad/s).
    pub fn bias(&self) -> Vector {
        match self {
            Self::Rigid(history) => from_vector3(&history.latest().filter.bias),
            Self::Elastic(history) => history.latest().state.bias,
        }
    }

    /// Returns the modes, if the filter estimates any.
    pub fn modes(&self) -> Option<&ElasticFilterStates> {
        match self {
            Self::Rigid(_) => None,
            Self::Elastic(history) => Some(&history.latest().modes),
        }
    }

    /// Returns the attitude a span after the last gyro reading, with the gyro's rate `reading` (rad/s).
    pub fn attitude_after(&self, reading: &Vector, span: Span) -> Quaternion<f64> {
        match self {
            Self::Rigid(history) => {
                let (filter, reading) = (&history.latest().filter, to_vector3(reading));
                from_quaternion(&history.precision.attitude_after(filter, &reading, span.ticks()))
            }
            Self::Elastic(history) => {
                let ElasticFilter { state, modes } = history.latest();
                let seconds = span.seconds();
                let turn = (reading - state.bias) * seconds - modes.rates()[1] * seconds;
                state.attitude * rotation(&turn)
            }
        }
    }

    /// Sets the torque on the modes (N m) from `now` on.
    pub fn set_torque(&mut self, now: Instant, torque: Vector) {
        if let Self::Elastic(history) = self {
            history.set_torque(now, torque);
        }
    }

    /// Returns the outcome of a gyro reading (rad/s) of an interval that ends at `now`, before it is added.
    pub fn judge_gyro(&mut self, now: Instant, reading: Vector) -> ReadingStatus {
        match self {
            Self::Rigid(RigidHistory { counts, entries, precision, .. }) => {
                precision.judge_gyro(counts, now.ticks(), &to_vector3(&reading), entries)
            }
            Self::Elastic(history) if history.gate.is_sound_rate(&to_vector3(&reading)) => {
                ReadingStatus::Accepted
            }
            Self::Elastic(_) => ReadingStatus::Unsound,
        }
    }

    /// Returns the time at which the last measurement that corrected the filter was exposed, or that of the start.
    pub fn corrected(&self) -> Instant {
        match self {
            Self::Rigid(history) => Instant::from_ticks(history.counts.corrected),
            Self::Elastic(history) => history.corrected,
        }
    }

    /// Adds the gyro reading (rad/s) of the interval that ends at `now`. Returns the results of the measurements that waited for it,
    /// with the indices of their sensors.
    pub fn add_gyro(&mut self, now: Instant, reading: Vector) -> Vec<(usize, Correction)> {
        match self {
            Self::Rigid(history) => history.add_gyro(now, reading),
            Self::Elastic(history) => history.add_gyro(now, reading),
        }
    }

    /// Adds a measurement, delayed or not. Returns its result; `None` while it waits for a gyro reading, and with elastic modes also
    /// if it is older than the history.
    pub fn add_measurement(&mut self, measurement: &DelayedMeasurement) -> Option<Correction> {
        match self {
            Self::Rigid(history) => {
                history.grow();
                let RigidHistory { counts, entries, observations, precision } = history;
                let measurement = measurement.to_flight();
                with_result(precision.add_observation(counts, measurement, entries, observations))
            }
            Self::Elastic(history) if measurement.to_flight().observation.is_sound() => {
                history.add_measurement(measurement)
            }
            Self::Elastic(_) => Some(Correction::unused(ReadingStatus::Unsound)),
        }
    }
}
