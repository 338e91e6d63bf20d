//! Readings of an attitude filter with its recent past, in the precision of the flight computer.

use std::ops::Range;

use flexsc_flight::attitude_estimator::AttitudeEstimator;
use flexsc_flight::attitude_history::{AttitudeHistory, AttitudeHistoryEntry};
use flexsc_flight::attitude_observation::{AttitudeObservation, Correction};
use flexsc_flight::delayed_observation::DelayedObservation;
use flexsc_flight::reading_status::ReadingStatus;
use flexsc_flight::ticks::Ticks;
use flexsc_flight::vector3::Vector3;

use crate::attitude_history::AttitudeHistoryEntry as SingleEntry;
use crate::delayed_observation::DelayedObservation as SingleObservation;
use crate::precision::Precision;
use crate::twin::{Twin, changed};

impl Precision {
    /// Judges a gyro reading (rad/s) before it is added to a history.
    pub fn judge_gyro(
        self,
        history: &mut AttitudeHistory,
        now: Ticks,
        reading: &Vector3,
        entries: &mut [AttitudeHistoryEntry],
    ) -> ReadingStatus {
        match self {
            Self::Double => history.judge_gyro(now, reading, entries),
            Self::Single => {
                let status = changed_past(
                    history,
                    |own| own,
                    entries,
                    &mut [],
                    |history, entries, _| history.judge_gyro(now.single(), &reading.single(), entries),
                );
                ReadingStatus::double(&status)
            }
        }
    }

    /// Adds a gyro reading (rad/s) to a history, without the measurements that waited for it; returns false if it is not later than
    /// the last one.
    pub fn add_interval(
        self,
        history: &mut AttitudeHistory,
        now: Ticks,
        reading: Vector3,
        entries: &mut [AttitudeHistoryEntry],
        observations: &mut [DelayedObservation],
    ) -> bool {
        match self {
            Self::Double => history.add_interval(now, reading, entries, observations),
            Self::Single => changed_past(
                history,
                |own| own,
                entries,
                observations,
                |history, entries, observations| {
                    history.add_interval(now.single(), reading.single(), entries, observations)
                },
            ),
        }
    }

    /// Corrects by the waiting measurement of a history with this index, if a gyro reading until `now` covers it.
    pub fn apply_waiting(
        self,
        history: &mut AttitudeHistory,
        index: usize,
        now: Ticks,
        entries: &mut [AttitudeHistoryEntry],
        observations: &mut [DelayedObservation],
    ) -> Correction {
        match self {
            Self::Double => history.apply_waiting(index, now, entries, observations),
            Self::Single => {
                let correction = changed_past(
                    history,
                    |own| own,
                    entries,
                    observations,
                    |history, entries, observations| {
                        history.apply_waiting(index, now.single(), entries, observations)
                    },
                );
                Correction::double(&correction)
            }
        }
    }

    /// Adds an observation to a history.
    pub fn add_observation(
        self,
        history: &mut AttitudeHistory,
        observation: DelayedObservation,
        entries: &mut [AttitudeHistoryEntry],
        observations: &mut [DelayedObservation],
    ) -> Correction {
        match self {
            Self::Double => history.add_observation(observation, entries, observations),
            Self::Single => {
                let correction = changed_past(
                    history,
                    |own| own,
                    entries,
                    observations,
                    |history, entries, observations| {
                        history.add_observation(observation.single(), entries, observations)
                    },
                );
                Correction::double(&correction)
            }
        }
    }

    /// Lets an estimator take a gyro reading (rad/s).
    pub fn take_gyro(
        self,
        estimator: &mut AttitudeEstimator,
        [now, latency]: [Ticks; 2],
        reading: Vector3,
        entries: &mut [AttitudeHistoryEntry],
        observations: &mut [DelayedObservation],
    ) -> ReadingStatus {
        match self {
            Self::Double => estimator.take_gyro(now, latency, reading, entries, observations),
            Self::Single => {
                let status = changed_past(
                    estimator,
                    |own| &own.history,
                    entries,
                    observations,
                    |estimator, entries, observations| {
                        let (now, latency) = (now.single(), latency.single());
                        estimator.take_gyro(now, latency, reading.single(), entries, observations)
                    },
                );
                ReadingStatus::double(&status)
            }
        }
    }

    /// Lets an estimator take an observation of the sensor with this counter of refused readings.
    pub fn take_observation(
        self,
        estimator: &mut AttitudeEstimator,
        sensor: usize,
        [now, latency]: [Ticks; 2],
        observation: &AttitudeObservation,
        entries: &mut [AttitudeHistoryEntry],
        observations: &mut [DelayedObservation],
    ) -> ReadingStatus {
        match self {
            Self::Double => {
                estimator.take_observation(sensor, now, latency, observation, entries, observations)
            }
            Self::Single => {
                let status = changed_past(
                    estimator,
                    |own| &own.history,
                    entries,
                    observations,
                    |estimator, entries, observations| {
                        let (now, latency, observation) =
                            (now.single(), latency.single(), observation.single());
                        estimator.take_observation(sensor, now, latency, &observation, entries, observations)
                    },
                );
                ReadingStatus::double(&status)
            }
        }
    }
}

/// Calls a function with the twins of what holds a history, and of its storage, all of which it may change. Only the entries and
/// measurements that the history has are converted.
fn changed_past<T: Twin, R>(
    holder: &mut T,
    history: impl Fn(&T) -> &AttitudeHistory,
    entries: &mut [AttitudeHistoryEntry],
    observations: &mut [DelayedObservation],
    call: impl FnOnce(&mut T::Single, &mut [SingleEntry], &mut [SingleObservation]) -> R,
) -> R {
    let [held, applied] = used(history(holder));
    let mut single_entries = padded(entries, held, SingleEntry::NONE);
    let mut single_observations = padded(observations, applied, SingleObservation::NONE);
    let result = changed(holder, |twin| call(twin, &mut single_entries, &mut single_observations));
    let [held, applied] = used(history(holder));
    take_back(entries, held, &single_entries);
    take_back(observations, applied, &single_observations);
    result
}

/// Returns the places of the entries and of the measurements of a history in their storage.
fn used(history: &AttitudeHistory) -> [Range<usize>; 2] {
    [history.first..history.first + history.entries, 0..history.applied + history.waiting]
}

/// Returns the twins of the values in these places, with `none` in all others.
fn padded<T: Twin>(values: &[T], places: Range<usize>, none: T::Single) -> Vec<T::Single>
where
    T::Single: Copy,
{
    let mut twins = vec![none; values.len()];
    let used = twins.iter_mut().zip(values).take(places.end).skip(places.start);
    used.for_each(|(twin, value)| *twin = value.single());
    twins
}

/// Takes the values of twins in these places.
fn take_back<T: Twin>(values: &mut [T], places: Range<usize>, twins: &[T::Single]) {
    let used = values.iter_mut().zip(twins).take(places.end).skip(places.start);
    used.for_each(|(value, twin)| *value = T::double(twin));
}
