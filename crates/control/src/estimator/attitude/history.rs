//! The recent past of an attitude filter, so that a measurement that arrives late corrects it where the body was exposed.
//!
//! Each entry holds the filter after what happened at its instant, with the gyro reading of the interval that ends there and
//! what was measured there. A late measurement is put where it belongs, and all that is later is done again:
//! the result is that of a filter to which nothing is late.

use std::collections::VecDeque;

use nalgebra::{Matrix3, Matrix6x3};

use super::filter::{AttitudeFilterState, Correction};
use super::measurement::{AttitudeMeasurement, GyroNoise};
use crate::attitude::Vector;
use crate::time::{Instant, Span};

/// A measurement that corrects.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Fix {
    /// When the body was exposed.
    pub exposed: Instant,
    /// What was measured.
    pub measured: AttitudeMeasurement,
    /// Covariance of its error in the body's axes (rad², or that of the vector's unit).
    pub noise: Matrix3<f64>,
    /// The constant gain of a filter that has one.
    pub gain: Option<Matrix6x3<f64>>,
    /// Which of the sensors measured it.
    pub sensor: usize,
}

impl Fix {
    fn correct(&self, filter: &mut AttitudeFilterState) -> Option<Correction> {
        if filter.swinging.is_some() {
            return filter.correct_at(self.sensor, &self.measured, &self.noise);
        }
        match (&self.measured, &self.gain) {
            (AttitudeMeasurement::Attitude(attitude), None) => filter.correct(attitude, &self.noise),
            (AttitudeMeasurement::Vector(sight), None) => filter.correct_by(sight, &self.noise),
            (measured, Some(gain)) => filter.correct_with(measured, &self.noise, gain),
        }
    }
}

/// A filter and its recent past.
#[derive(Clone, Debug)]
pub struct FilterHistory {
    between: Between,
    /// How late a measurement may be.
    reach: Span,
    entries: VecDeque<Entry>,
    /// Measurements of instants that no gyro reading covers yet.
    early: Vec<Fix>,
}

/// What carries a filter on between entries.
#[derive(Clone, Debug)]
struct Between {
    noise: GyroNoise,
    /// Torques that act on the modes (N m), each from an instant on.
    torques: VecDeque<(Instant, Vector)>,
}

impl Between {
    /// The torques between two instants, each with how long it acts (s).
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

    /// Carries a filter on from one instant to another, with a reading of an interval that has both in it.
    fn carry(&self, filter: &mut AttitudeFilterState, reading: &Vector, [from, to]: [Instant; 2]) {
        let seconds = to.since(from).seconds();
        if filter.swinging.is_some() {
            filter.predict_under(reading, seconds, &self.noise, &self.pushed(from, to));
        } else {
            filter.predict(reading, seconds, &self.noise);
        }
    }
}

#[derive(Clone, Debug)]
struct Entry {
    at: Instant,
    /// The gyro reading of the interval that ends here (rad/s).
    reading: Vector,
    fixes: Vec<Fix>,
    filter: AttitudeFilterState,
}

impl FilterHistory {
    /// The history of a filter that begins at an instant, to which nothing is later than `reach`.
    pub fn new(at: Instant, filter: AttitudeFilterState, noise: GyroNoise, reach: Span) -> Self {
        let entry = Entry { at, reading: Vector::zeros(), fixes: Vec::new(), filter };
        let between = Between { noise, torques: VecDeque::new() };
        Self { between, reach, entries: VecDeque::from([entry]), early: Vec::new() }
    }

    /// The filter after all that it was told.
    pub fn latest(&self) -> &AttitudeFilterState {
        // There is always an entry.
        &self.entries[self.entries.len() - 1].filter
    }

    /// The last gyro reading (rad/s).
    pub fn reading(&self) -> Vector {
        self.entries[self.entries.len() - 1].reading
    }

    /// Takes over the torque that acts on the modes from now on (N m).
    pub fn push(&mut self, now: Instant, torque: Vector) {
        let torques = &mut self.between.torques;
        if torques.back().is_some_and(|(from, _)| *from == now) {
            torques.pop_back();
        }
        torques.push_back((now, torque));
        let oldest = self.entries[0].at;
        while torques.get(1).is_some_and(|(from, _)| *from <= oldest) {
            torques.pop_front();
        }
    }

    /// Takes a gyro reading of the interval that ends now (rad/s); tells what measurements that waited for it made of it.
    pub fn read(&mut self, now: Instant, reading: Vector) -> Vec<Correction> {
        let last = &self.entries[self.entries.len() - 1];
        if now <= last.at {
            return Vec::new();
        }
        // It is carried on where it stays: filters are large.
        let (from, filter) = (last.at, last.filter.clone());
        self.entries.push_back(Entry { at: now, reading, fixes: Vec::new(), filter });
        if let Some(entry) = self.entries.back_mut() {
            self.between.carry(&mut entry.filter, &reading, [from, now]);
        }
        let mut told = Vec::new();
        if !self.early.is_empty() {
            let waiting = std::mem::take(&mut self.early);
            told.extend(waiting.into_iter().filter_map(|fix| self.fix(fix)));
        }
        // The last entry that is older stays: from there begins the interval with the oldest that may still be exposed.
        while self.entries.get(1).is_some_and(|second| second.at + self.reach <= now) {
            self.entries.pop_front();
        }
        told
    }

    /// Takes a measurement, as late as it may be; nothing comes of one that is later, and of one that waits for a reading.
    pub fn fix(&mut self, fix: Fix) -> Option<Correction> {
        let Some(index) = self.entries.iter().position(|entry| fix.exposed <= entry.at) else {
            self.early.push(fix);
            return None;
        };
        if self.entries[index].at > fix.exposed {
            // Older than all that is kept.
            let before = index.checked_sub(1)?;
            let (reading, from) = (self.entries[index].reading, &self.entries[before]);
            let mut filter = from.filter.clone();
            self.between.carry(&mut filter, &reading, [from.at, fix.exposed]);
            self.entries.insert(index, Entry { at: fix.exposed, reading, fixes: Vec::new(), filter });
        }
        let entry = &mut self.entries[index];
        let correction = fix.correct(&mut entry.filter)?;
        entry.fixes.push(fix);
        self.again(index + 1);
        Some(correction)
    }

    /// Does again what the entries from this index on hold.
    fn again(&mut self, from: usize) {
        let entries = self.entries.make_contiguous();
        for index in from..entries.len() {
            let (before, after) = entries.split_at_mut(index);
            let ([.., last], [entry, ..]) = (before, after) else { return };
            let Entry { at, reading, fixes, filter } = entry;
            filter.clone_from(&last.filter);
            self.between.carry(filter, reading, [last.at, *at]);
            for fix in &*fixes {
                fix.correct(filter);
            }
        }
    }
}
