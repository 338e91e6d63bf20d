//! The motion of a body whose frequencies drift, from step to step of its Taylor series.

use super::series::{Ratio, SAFETY, Springs};
use crate::body::{Drift, Planar, SERIES};
use crate::numerics::polynomial::Series;

/// Steps that are taken at a time.
const STEPS: u32 = 16;

/// A motion under a constant input.
#[derive(Clone, Debug)]
pub struct Drifting {
    drift: Drift,
    springs: Springs<f64>,
    /// The n-th terms of all coordinates side by side: the rigid angle first, then the modes.
    series: Vec<f64>,
    /// Whether only the first two terms are found yet.
    raw: bool,
    ratios: Vec<Ratio<f64>>,
    moment: f64,
    departed: f64,
    /// Angles and rates at departure.
    start: Vec<f64>,
    /// When the series begin, after departure (s).
    begins: f64,
    /// Where the body was seen last, after departure (s).
    seen: f64,
}

impl Drifting {
    /// A body at its start, under no input. A wheel takes back-EMF a (1/s) from the total rate, or from the rigid one.
    pub fn new(body: &Planar, drift: &Drift, back_emf: f64, total: bool) -> Self {
        let frequencies: Vec<f64> = body.modes.iter().map(|mode| mode.frequency.get()).collect();
        let start = body.start().to_vector(&frequencies);
        let springs = Springs::new(body, back_emf, total);
        let mut series = vec![0.0; SERIES * springs.count()];
        // Angles and rates take turns in the vector of the state.
        for (n, index) in (0..2).flat_map(|n| (0..springs.count()).map(move |index| (n, index))) {
            series[n * springs.count() + index] = start[2 * index + n];
        }
        Self {
            start: series[..2 * springs.count()].to_vec(),
            ratios: vec![Ratio::new(0.0); drift.count()],
            drift: drift.clone(),
            springs,
            series,
            raw: true,
            moment: 0.0,
            departed: 0.0,
            begins: 0.0,
            seen: 0.0,
        }
    }

    /// Begins a motion under a constant reduced moment (rad/s²), from where the body was seen last, at a time (s).
    pub fn depart(&mut self, now: f64, moment: f64) {
        self.rebase(self.seen - self.begins);
        (self.moment, self.departed) = (moment, now);
        (self.begins, self.seen) = (0.0, 0.0);
        self.start.copy_from_slice(&self.series[..2 * self.springs.count()]);
    }

    /// Puts the rigid coordinate to rest at 0, where the body was seen last: steps are as exact as the largest coordinate needs.
    pub fn rest_hub(&mut self) {
        self.rebase(self.seen - self.begins);
        self.begins = self.seen;
        let count = self.springs.count();
        (self.series[0], self.series[count]) = (0.0, 0.0);
    }

    /// What moves it.
    pub fn springs(&self) -> &Springs<f64> {
        &self.springs
    }

    /// Angles and rates at departure: those of all coordinates, first the angles.
    pub fn start(&self) -> &[f64] {
        &self.start
    }

    /// Expands the ratios of the frequencies at a time (s).
    pub fn expand_ratios(&self, t: f64, into: &mut [Ratio<f64>]) {
        for (mode, ratio) in into.iter_mut().enumerate() {
            ratio.expand(&self.drift, mode, t);
        }
    }

    /// How many ratios there are.
    pub fn ratios(&self) -> usize {
        self.ratios.len()
    }

    /// Whether the series are those from departure on.
    pub fn is_fresh(&self) -> bool {
        self.begins == 0.0 && !self.raw
    }

    /// The same motion, back at its departure.
    #[must_use]
    pub fn from_departure(&self) -> Self {
        let mut again = self.clone();
        again.series[..2 * self.springs.count()].copy_from_slice(&self.start);
        (again.begins, again.seen) = (0.0, 0.0);
        again.raw = true;
        again.expand();
        again
    }

    /// The series go on `h` seconds after departure, not before they begin.
    pub fn unfold(&mut self, h: f64) {
        if h > self.begins {
            self.rebase(h - self.begins);
            self.begins = h;
        }
        self.expand();
    }

    /// Puts the series of all coordinates, and returns how far they reach (s): infinitely, if that is as far as is asked for.
    pub fn tell(&self, far: f64, coordinates: &mut [Series]) -> f64 {
        let count = self.springs.count();
        for (index, into) in coordinates.iter_mut().enumerate().take(count) {
            for (n, term) in into[..SERIES].iter_mut().enumerate() {
                *term = self.series[n * count + index];
            }
        }
        if self.springs.surely_reach(&self.series, far) { f64::INFINITY } else { self.reach() }
    }

    /// Takes some steps towards `h` seconds after departure, not before a time gone to earlier; whether no more are needed.
    pub fn approach(&mut self, h: f64) -> bool {
        self.expand();
        for _ in 0..STEPS {
            let left = h - self.begins;
            if self.springs.surely_reach(&self.series, left) {
                return true;
            }
            let reach = self.reach();
            if left <= reach {
                return true;
            }
            self.rebase(reach);
            self.begins += reach;
            self.expand();
        }
        false
    }

    /// Goes to `h` seconds after departure, not before a time gone to earlier.
    pub fn go(&mut self, h: f64) {
        while !self.approach(h) {}
        self.seen = h;
    }

    /// Angle and rate of each coordinate where the body is (rad, rad/s), and its acceleration (rad/s²).
    pub fn motion(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        let h = self.seen - self.begins;
        (0..self.springs.count()).map(move |index| self.springs.at(&self.series, index, h))
    }

    /// How far the series reach (s).
    fn reach(&self) -> f64 {
        self.springs.radius(&self.series) / SAFETY
    }

    /// The series begin again `h` seconds later.
    fn rebase(&mut self, h: f64) {
        if h != 0.0 {
            let count = self.springs.count();
            for index in 0..count {
                let [angle, rate, _] = self.springs.at(&self.series, index, h);
                (self.series[index], self.series[count + index]) = (angle, rate);
            }
        }
        self.raw = true;
    }

    /// Finds all series from their first two terms, unless they are there.
    fn expand(&mut self) {
        if !std::mem::take(&mut self.raw) {
            return;
        }
        for (mode, ratio) in self.ratios.iter_mut().enumerate() {
            ratio.expand(&self.drift, mode, self.departed + self.begins);
        }
        self.springs.fill(&self.ratios, self.moment, &mut self.series);
    }
}
