//! Recent past of an attitude filter: a delayed measurement corrects the state at its exposure.
//!
//! Each entry holds the filter after the events at its instant, with the gyro reading of the interval that ends there.
//! A delayed measurement is inserted at its exposure, and all later steps are repeated: the result is that of a filter
//! without delays. The caller gives the storage of entries and measurements, the same at every call. Measurements are judged once
//! (`reading_judgement.rs`), when they first correct: one that was accepted is accepted in every repetition.

use crate::attitude_filter::{AttitudeBiasFilter, GyroNoise};
use crate::attitude_gate::AttitudeGate;
use crate::attitude_observation::Correction;
use crate::binary64::infinity;
use crate::delayed_observation::DelayedObservation;
use crate::maths::min;
use crate::reading_status::ReadingStatus;
use crate::ticks::Ticks;
use crate::vector3::Vector3;

/// Number of counters of refused readings.
pub const REFUSAL_COUNTERS: usize = 8;

/// Attitude filter at one instant of its recent past.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct AttitudeHistoryEntry {
    /// Time of the entry.
    pub time: Ticks,
    /// Gyro reading (rad/s) of the interval that ends at this entry.
    pub reading: Vector3,
    /// Filter after the events at this time.
    pub filter: AttitudeBiasFilter,
}

impl AttitudeHistoryEntry {
    /// Empty entry, which fills storage.
    pub const NONE: Self =
        Self { time: Ticks { whole: 0, part: 0 }, reading: Vector3::ZERO, filter: AttitudeBiasFilter::NONE };
}

/// Counts of the entries and measurements of an attitude filter's recent past.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct AttitudeHistory {
    /// Gyro noise in the filter's model.
    pub noise: GyroNoise,
    /// Largest delay of a measurement.
    pub reach: Ticks,
    /// Limits of the readings.
    pub gate: AttitudeGate,
    /// Number of improbable measurements in a row, which a correction by one that is about as accurate ends.
    pub improbable: u32,
    /// Least variance (rad²), summed over the axes, of the improbable measurements in a row.
    pub least_variance: f64,
    /// Exposure of the last correction that left no improbable measurements to count; before the first one, the start.
    pub confirmed: Ticks,
    /// Variance (rad²/s²) by which that of the bias is inflated at most: that of the start.
    pub most_bias_inflation: f64,
    /// True after the clock was set back, until a measurement has corrected the filter with an inflated covariance.
    pub is_unsure: bool,
    /// Number of gyro readings in a row that were older than the last one.
    pub setbacks: u32,
    /// Number of readings of each sensor refused since the start; the last counter has those of all further sensors too.
    pub refused: [u64; REFUSAL_COUNTERS],
    /// Exposure of the last measurement that corrected the filter; before the first one, the start.
    pub corrected: Ticks,
    /// Index of the oldest entry.
    pub first: usize,
    /// Number of entries, by time.
    pub entries: usize,
    /// Number of measurements that have corrected an entry, by exposure and then by arrival: the first ones of the storage.
    pub applied: usize,
    /// Number of measurements whose exposure no gyro reading covers yet, by arrival: the next ones of the storage.
    pub waiting: usize,
}

impl AttitudeHistory {
    /// Starts the history of a filter at its first time, in `entries`, two or more.
    pub fn start(
        time: Ticks,
        filter: AttitudeBiasFilter,
        noise: GyroNoise,
        reach: Ticks,
        gate: AttitudeGate,
        entries: &mut [AttitudeHistoryEntry],
    ) -> Self {
        let mut count: usize = 0;
        if entries.len() > 1 {
            entries[0] = AttitudeHistoryEntry { time, reading: Vector3::ZERO, filter };
            count = 1;
        }
        Self {
            noise,
            reach,
            gate,
            improbable: 0,
            least_variance: 0.0,
            confirmed: time,
            most_bias_inflation: filter.covariance.rows[3][3],
            is_unsure: false,
            setbacks: 0,
            refused: [0; REFUSAL_COUNTERS],
            corrected: time,
            first: 0,
            entries: count,
            applied: 0,
            waiting: 0,
        }
    }

    /// Returns true if the storage holds the history.
    #[inline]
    fn is_held(&self, entries: &[AttitudeHistoryEntry], observations: &[DelayedObservation]) -> bool {
        self.entries > 0
            && self.first + self.entries <= entries.len()
            && self.applied + self.waiting <= observations.len()
    }

    /// Returns the index of the latest entry.
    #[inline]
    pub fn latest(&self) -> usize {
        self.first + self.entries - 1
    }

    /// Adds the gyro reading (rad/s) of the interval that ends at `now`. Returns the last correction by a measurement that
    /// waited for it. If the storage is full, the oldest entry is dropped.
    pub fn add_gyro(
        &mut self,
        now: Ticks,
        reading: Vector3,
        entries: &mut [AttitudeHistoryEntry],
        observations: &mut [DelayedObservation],
    ) -> Correction {
        let mut correction: Correction = Correction::NONE;
        let is_added: bool = self.add_interval(now, reading, entries, observations);
        if !is_added {
            return correction;
        }
        let mut early: usize = 0;
        while early < self.waiting {
            let result: Correction = self.apply_waiting(early, now, entries, observations);
            if result.status == ReadingStatus::Waiting {
                early += 1;
            }
            if result.status.has_corrected() {
                correction = result;
            }
        }
        self.forget(now, entries);
        correction
    }

    /// Adds the gyro reading (rad/s) of the interval that ends at `now`, without the measurements that waited for it; returns false if
    /// it is not later than the last one.
    pub fn add_interval(
        &mut self,
        now: Ticks,
        reading: Vector3,
        entries: &mut [AttitudeHistoryEntry],
        observations: &[DelayedObservation],
    ) -> bool {
        if !self.is_held(entries, observations) || entries.len() < 2 {
            return false;
        }
        let from: Ticks = entries[self.latest()].time;
        if !from.is_before(now) {
            return false;
        }
        self.make_room(entries);
        let last: usize = self.latest();
        entries[last + 1] = entries[last];
        entries[last + 1].time = now;
        entries[last + 1].reading = reading;
        entries[last + 1].filter.predict(&reading, now.since(from).seconds(), &self.noise);
        self.entries += 1;
        true
    }

    /// Removes the entries that no accepted measurement reaches any more.
    pub fn forget(&mut self, now: Ticks, entries: &[AttitudeHistoryEntry]) {
        // The last older entry stays: the interval with the oldest exposure still accepted begins there.
        while self.entries > 1 && !now.is_before(entries[self.first + 1].time.plus(self.reach)) {
            self.first += 1;
            self.entries -= 1;
        }
    }

    /// Corrects by the waiting measurement with this index, if a gyro reading until `now` covers it: then it waits no longer.
    pub fn apply_waiting(
        &mut self,
        index: usize,
        now: Ticks,
        entries: &mut [AttitudeHistoryEntry],
        observations: &mut [DelayedObservation],
    ) -> Correction {
        let place: usize = self.applied + index;
        if now.is_before(observations[place].exposed) {
            return Correction::unused(ReadingStatus::Waiting);
        }
        self.apply(place, entries, observations)
    }

    /// Adds a measurement, delayed or not. Returns its result: it corrects the filter, waits for a gyro reading, or is refused.
    pub fn add_observation(
        &mut self,
        observation: DelayedObservation,
        entries: &mut [AttitudeHistoryEntry],
        observations: &mut [DelayedObservation],
    ) -> Correction {
        if !self.is_held(entries, observations) {
            self.count_refusal(observation.sensor);
            return Correction::unused(ReadingStatus::Untimely);
        }
        if !observation.observation.is_sound() {
            self.count_refusal(observation.sensor);
            return Correction::unused(ReadingStatus::Unsound);
        }
        if self.applied + self.waiting == observations.len() {
            self.discard_old(entries, observations);
        }
        let index: usize = self.applied + self.waiting;
        if index == observations.len() {
            self.count_refusal(observation.sensor);
            return Correction::unused(ReadingStatus::Untimely);
        }
        observations[index] = observation;
        self.waiting += 1;
        if entries[self.latest()].time.is_before(observation.exposed) {
            return Correction::unused(ReadingStatus::Waiting);
        }
        self.apply(index, entries, observations)
    }

    /// Corrects by the waiting measurement at `index`, which is not later than the latest entry, and repeats the later
    /// steps.
    fn apply(
        &mut self,
        index: usize,
        entries: &mut [AttitudeHistoryEntry],
        observations: &mut [DelayedObservation],
    ) -> Correction {
        let mut observation: DelayedObservation = observations[index];
        // No innovation passes the limit -1.
        let most_nis: f64 = if self.is_unsure { -1.0 } else { self.gate.most_nis };
        let mut correction: Correction = self.correct_at_exposure(&observation, most_nis, entries);
        if correction.status == ReadingStatus::Improbable && self.is_reaccepted(&observation) {
            // As uncertain as the innovation shows, and the bias as if it had drifted since the last correction, but no more than at the
            // start: after a gyro that spiked the bias is none the worse.
            let seconds: f64 = observation.exposed.since(self.confirmed).seconds();
            observation.angle_inflation = correction.innovation.norm_squared();
            if seconds > 0.0 && !self.is_unsure {
                observation.bias_inflation =
                    min(observation.angle_inflation / (seconds * seconds), self.most_bias_inflation);
            }
            correction = self.correct_at_exposure(&observation, infinity(), entries);
            if correction.status == ReadingStatus::Accepted {
                correction.status = ReadingStatus::Reaccepted;
            }
        }
        if correction.status == ReadingStatus::Improbable {
            let variance: f64 = observation.observation.angle_variance();
            self.count_improbable(variance);
        }
        if correction.status.is_refusal() {
            self.count_refusal(observation.sensor);
        }
        if correction.status.has_corrected() {
            self.is_unsure = false;
            if correction.status == ReadingStatus::Reaccepted || self.ends_row(&observation.observation) {
                self.improbable = 0;
                if self.confirmed.is_before(observation.exposed) {
                    self.confirmed = observation.exposed;
                }
            }
            if self.corrected.is_before(observation.exposed) {
                self.corrected = observation.exposed;
            }
            let mut place: usize = index;
            while place > self.applied
                || place > 0 && observation.exposed.is_before(observations[place - 1].exposed)
            {
                observations[place] = observations[place - 1];
                place -= 1;
            }
            observations[place] = observation;
            self.applied += 1;
            self.waiting -= 1;
            self.repeat(observation.exposed, place + 1, entries, observations);
        } else {
            for place in (index + 1)..(self.applied + self.waiting) {
                observations[place - 1] = observations[place];
            }
            self.waiting -= 1;
        }
        correction
    }

    /// Corrects the filter at the exposure of a measurement, for which it inserts an entry if there is none.
    fn correct_at_exposure(
        &mut self,
        observation: &DelayedObservation,
        most_nis: f64,
        entries: &mut [AttitudeHistoryEntry],
    ) -> Correction {
        let exposed: Ticks = observation.exposed;
        if exposed.is_before(entries[self.first].time) {
            return Correction::unused(ReadingStatus::Untimely);
        }
        let mut later: usize = 0;
        while later + 1 < self.entries && !entries[self.latest() - later - 1].time.is_before(exposed) {
            later += 1;
        }
        if exposed.is_before(entries[self.latest() - later].time) {
            if self.entries == entries.len() && later + 2 == self.entries {
                // The entry from which the filter is propagated would have to be dropped.
                return Correction::unused(ReadingStatus::Untimely);
            }
            self.insert_entry(later, exposed, entries);
            later += 1;
        }
        observation.correct(&mut entries[self.latest() - later].filter, most_nis)
    }

    /// Inserts an entry at `time`, between the oldest and the one before which there are `later` later entries.
    fn insert_entry(&mut self, later: usize, time: Ticks, entries: &mut [AttitudeHistoryEntry]) {
        self.make_room(entries);
        let place: usize = self.latest() - later;
        let mut moved: usize = self.latest() + 1;
        while moved > place {
            entries[moved] = entries[moved - 1];
            moved -= 1;
        }
        self.entries += 1;
        // The reading of the later entry is that of the inserted one too.
        let reading: Vector3 = entries[place].reading;
        let from: Ticks = entries[place - 1].time;
        entries[place].time = time;
        entries[place].filter = entries[place - 1].filter;
        entries[place].filter.predict(&reading, time.since(from).seconds(), &self.noise);
    }

    /// Repeats the propagation and the corrections of all entries after a time, with the measurements from index
    /// `observation` on.
    fn repeat(
        &self,
        after: Ticks,
        observation: usize,
        entries: &mut [AttitudeHistoryEntry],
        observations: &[DelayedObservation],
    ) {
        let mut start: usize = self.latest() + 1;
        while start > self.first && after.is_before(entries[start - 1].time) {
            start -= 1;
        }
        let mut next: usize = observation;
        let end: usize = self.latest() + 1;
        for index in start..end {
            let before: Ticks = entries[index - 1].time;
            let time: Ticks = entries[index].time;
            let reading: Vector3 = entries[index].reading;
            entries[index].filter = entries[index - 1].filter;
            entries[index].filter.predict(&reading, time.since(before).seconds(), &self.noise);
            while next < self.applied && !time.is_before(observations[next].exposed) {
                observations[next].correct(&mut entries[index].filter, infinity());
                next += 1;
            }
        }
    }

    /// Moves the entries to the front of the storage if there is no room behind them, without the oldest if there is
    /// none in front of them either.
    fn make_room(&mut self, entries: &mut [AttitudeHistoryEntry]) {
        if self.first + self.entries < entries.len() {
            return;
        }
        if self.first == 0 {
            self.first = 1;
            self.entries -= 1;
        }
        for index in 0..self.entries {
            entries[index] = entries[self.first + index];
        }
        self.first = 0;
    }

    /// Removes measurements that no step repeats any more: those of the oldest entry and before.
    pub fn discard_old(&mut self, entries: &[AttitudeHistoryEntry], observations: &mut [DelayedObservation]) {
        if !self.is_held(entries, observations) {
            return;
        }
        let oldest: Ticks = entries[self.first].time;
        let mut old: usize = 0;
        while old < self.applied && !oldest.is_before(observations[old].exposed) {
            old += 1;
        }
        let kept: usize = self.applied + self.waiting - old;
        for index in 0..kept {
            observations[index] = observations[old + index];
        }
        self.applied -= old;
    }
}
