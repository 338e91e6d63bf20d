//! Judgement of the readings of an attitude filter: which are refused, how they are counted, and when improbable ones are accepted
//! all the same.

use crate::attitude_history::{AttitudeHistory, AttitudeHistoryEntry, REFUSAL_COUNTERS};
use crate::attitude_observation::AttitudeObservation;
use crate::delayed_observation::DelayedObservation;
use crate::reading_status::ReadingStatus;
use crate::ticks::Ticks;
use crate::vector3::Vector3;

/// Largest ratio of the variance of an accepted measurement to that of the refused ones before it, at which it shows that they were
/// false: twice the standard deviation.
const MOST_VARIANCE_RATIO: f64 = 4.0;

impl AttitudeHistory {
    /// Returns the number of readings of all sensors refused since the start.
    pub fn refusals(&self) -> u64 {
        let mut sum: u64 = 0;
        for sensor in 0..REFUSAL_COUNTERS {
            sum += self.refused[sensor];
        }
        sum
    }

    /// Counts a refused reading of a sensor.
    pub fn count_refusal(&mut self, sensor: usize) {
        let counter: usize = if sensor < REFUSAL_COUNTERS { sensor } else { REFUSAL_COUNTERS - 1 };
        self.refused[counter] += 1;
    }

    /// Judges a gyro reading (rad/s) of an interval that ends at `now`, before it is added. After several readings in a row that are
    /// older than the last one, the clock was set back: the history begins again at `now`, with the latest filter.
    pub fn judge_gyro(
        &mut self,
        now: Ticks,
        reading: &Vector3,
        entries: &mut [AttitudeHistoryEntry],
    ) -> ReadingStatus {
        if self.entries == 0 || self.first + self.entries > entries.len() {
            return ReadingStatus::Untimely;
        }
        if !self.gate.is_sound_rate(reading) {
            self.count_refusal(0);
            return ReadingStatus::Unsound;
        }
        if !now.is_before(entries[self.latest()].time) {
            self.setbacks = 0;
            return ReadingStatus::Accepted;
        }
        self.setbacks += 1;
        if self.setbacks <= self.gate.most_refusals {
            self.count_refusal(0);
            return ReadingStatus::Untimely;
        }
        entries[0] = entries[self.latest()];
        entries[0].time = now;
        self.first = 0;
        self.entries = 1;
        self.applied = 0;
        self.waiting = 0;
        self.setbacks = 0;
        // The rotation since the last reading is not known.
        self.is_unsure = true;
        self.corrected = now;
        self.confirmed = now;
        ReadingStatus::Accepted
    }

    /// Returns true if an improbable measurement is accepted all the same: after several in a row, after a gap, or after the clock was
    /// set back.
    pub fn is_reaccepted(&self, observation: &DelayedObservation) -> bool {
        self.is_unsure
            || self.improbable >= self.gate.most_refusals
            || self.gate.gap.is_before(observation.exposed.since(self.confirmed))
    }

    /// Counts an improbable measurement with a variance (rad²).
    pub fn count_improbable(&mut self, variance: f64) {
        if self.improbable == 0 || variance < self.least_variance {
            self.least_variance = variance;
        }
        self.improbable += 1;
    }

    /// Returns true if a measurement that corrects the filter ends the row of improbable ones: it is about as accurate.
    pub fn ends_row(&self, observation: &AttitudeObservation) -> bool {
        self.improbable == 0 || observation.angle_variance() <= MOST_VARIANCE_RATIO * self.least_variance
    }
}
