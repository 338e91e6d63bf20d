//! Recent past of an attitude filter with elastic modes: a delayed measurement corrects the state at its exposure.
//!
//! Each entry holds the filter after the events at its instant, with the gyro reading of the interval that ends there
//! and the measurements exposed there. A delayed measurement is inserted at its exposure, and all later steps are
//! repeated: the result is that of a filter without delays.

use std::collections::VecDeque;

use flexsc_flight::attitude_filter::GyroNoise;
use flexsc_flight::attitude_gate::AttitudeGate;
use flexsc_flight::attitude_observation::Correction;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::time::{Instant, Span};

use super::elastic_filter::ElasticFilter;
use super::measurement::DelayedMeasurement;

/// Filter and its recent past.
#[derive(Clone, Debug)]
pub struct ElasticHistory {
    between: Propagation,
    /// Largest delay of a measurement.
    reach: Span,
    /// Limits of the readings.
    pub(super) gate: AttitudeGate,
    /// Exposure of the last measurement that corrected the filter; before the first one, the start.
    pub(super) corrected: Instant,
    entries: VecDeque<HistoryEntry>,
    /// Measurements whose exposure no gyro reading covers yet.
    early: Vec<DelayedMeasurement>,
}

/// Inputs of the propagation between entries.
#[derive(Clone, Debug)]
struct Propagation {
    noise: GyroNoise,
    /// Torques on the modes (N m), each with the time from which on it acts.
    torques: VecDeque<(Instant, Vector)>,
}

impl Propagation {
    /// Returns the torques (N m) between two instants, each with its duration (s).
    fn pushed(&self, from: Instant, to: Instant) -> Vec<(f64, Vector)> {
        let mut pieces = Vec::new();
        let mut now = from;
        let mut torque = Vector::zeros();
        for (begins, next) in &self.torques {
            if *begins >= to {
                break;
            }
            if *begins > now {
                pieces.push((begins.since(now).seconds(), torque));
                now = *begins;
            }
            torque = *next;
        }
        pieces.push((to.since(now).seconds(), torque));
        pieces
    }

    /// Propagates a filter between two instants with the gyro reading of an interval that contains both.
    fn carry(&self, filter: &mut ElasticFilter, reading: &Vector, [from, to]: [Instant; 2]) {
        let seconds = to.since(from).seconds();
        filter.predict(reading, seconds, &self.noise, &self.pushed(from, to));
    }
}

#[derive(Clone, Debug)]
struct HistoryEntry {
    time: Instant,
    /// Gyro reading of the interval that ends at this entry (rad/s).
    reading: Vector,
    fixes: Vec<DelayedMeasurement>,
    filter: ElasticFilter,
}

impl ElasticHistory {
    /// Creates the history of a filter at its first instant; `reach` is the largest delay of a measurement.
    pub fn new(
        time: Instant,
        filter: ElasticFilter,
        noise: GyroNoise,
        reach: Span,
        gate: AttitudeGate,
    ) -> Self {
        let entry = HistoryEntry { time, reading: Vector::zeros(), fixes: Vec::new(), filter };
        let between = Propagation { noise, torques: VecDeque::new() };
        Self { between, reach, gate, corrected: time, entries: VecDeque::from([entry]), early: Vec::new() }
    }

    /// Returns the filter after everything it has received.
    pub fn latest(&self) -> &ElasticFilter {
        // The history always has an entry.
        &self.entries[self.entries.len() - 1].filter
    }

    /// Sets the torque on the modes (N m) from `now` on.
    pub fn set_torque(&mut self, now: Instant, torque: Vector) {
        let torques = &mut self.between.torques;
        if torques.back().is_some_and(|(from, _)| *from == now) {
            torques.pop_back();
        }
        torques.push_back((now, torque));
        let oldest = self.entries[0].time;
        while torques.get(1).is_some_and(|(from, _)| *from <= oldest) {
            torques.pop_front();
        }
    }

    /// Adds the gyro reading (rad/s) of the interval that ends at `now`. Returns the corrections by measurements that waited for it,
    /// with the indices of their sensors.
    pub fn add_gyro(&mut self, now: Instant, reading: Vector) -> Vec<(usize, Correction)> {
        let last = &self.entries[self.entries.len() - 1];
        if now <= last.time {
            return Vec::new();
        }
        // The entry's own filter is propagated in place: filters are large.
        let (from, filter) = (last.time, last.filter.clone());
        self.entries.push_back(HistoryEntry { time: now, reading, fixes: Vec::new(), filter });
        if let Some(entry) = self.entries.back_mut() {
            self.between.carry(&mut entry.filter, &reading, [from, now]);
        }
        let waiting = std::mem::take(&mut self.early);
        let results =
            waiting.into_iter().filter_map(|fix| Some((fix.sensor, self.add_measurement(&fix)?))).collect();
        // The last older entry stays: the interval with the oldest exposure still accepted begins there.
        while self.entries.get(1).is_some_and(|second| second.time + self.reach <= now) {
            self.entries.pop_front();
        }
        results
    }

    /// Adds a measurement, delayed or not; returns `None` if it is older than the history, or waits for a gyro reading.
    pub fn add_measurement(&mut self, fix: &DelayedMeasurement) -> Option<Correction> {
        let Some(index) = self.entries.iter().position(|entry| fix.exposed <= entry.time) else {
            self.early.push(*fix);
            return None;
        };
        if self.entries[index].time > fix.exposed {
            // Exposures before the oldest entry are rejected.
            let before = index.checked_sub(1)?;
            let (reading, from) = (self.entries[index].reading, &self.entries[before]);
            let mut filter = from.filter.clone();
            self.between.carry(&mut filter, &reading, [from.time, fix.exposed]);
            self.entries
                .insert(index, HistoryEntry { time: fix.exposed, reading, fixes: Vec::new(), filter });
        }
        let entry = &mut self.entries[index];
        let correction = entry.filter.correct(fix.sensor, &fix.measured, &fix.noise)?;
        entry.fixes.push(*fix);
        self.corrected = self.corrected.max(fix.exposed);
        self.again(index + 1);
        Some(correction)
    }

    /// Repeats the propagation and the corrections of all entries from index `from` on.
    fn again(&mut self, from: usize) {
        let entries = self.entries.make_contiguous();
        for index in from..entries.len() {
            let (before, after) = entries.split_at_mut(index);
            let ([.., last], [entry, ..]) = (before, after) else { return };
            let HistoryEntry { time, reading, fixes, filter } = entry;
            filter.clone_from(&last.filter);
            self.between.carry(filter, reading, [last.time, *time]);
            for fix in &*fixes {
                filter.correct(fix.sensor, &fix.measured, &fix.noise);
            }
        }
    }
}
