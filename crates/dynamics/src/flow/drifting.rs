//! Motion of a body whose frequencies drift, by successive steps of its Taylor series.

use flexsc_numerics::polynomial::Series;

use super::taylor_series::{DriftingEquations, RatioSeries, SAFETY};
use crate::axis_model::AxisModel;
use crate::frequency_drift::{FrequencyDrift, SERIES};

/// Largest number of steps of one call.
const STEPS: u32 = 16;

/// Motion of a body with drifting frequencies under a constant input.
#[derive(Clone, Debug)]
pub struct DriftingFlow {
    drift: FrequencyDrift,
    springs: DriftingEquations<f64>,
    /// Taylor coefficients by order, for all coordinates: the rigid angle first, then the modes.
    series: Vec<f64>,
    /// True if only the first two terms of the series are valid.
    raw: bool,
    ratios: Vec<RatioSeries<f64>>,
    moment: f64,
    departed: f64,
    /// Angles, then rates, at departure.
    start: Vec<f64>,
    /// Origin of the series, after departure (s).
    begins: f64,
    /// Time of the current state, after departure (s).
    seen: f64,
}

impl DriftingFlow {
    /// Creates the motion of a body from its initial state, under no input. A wheel's back-EMF a (1/s) acts on the
    /// total rate if `total` is true, else on the rigid rate.
    pub fn new(body: &AxisModel, drift: &FrequencyDrift, back_emf: f64, total: bool) -> Self {
        let frequencies: Vec<f64> = body.modes.iter().map(|mode| mode.frequency.get()).collect();
        let start = body.initial_state().to_vector(&frequencies);
        let springs = DriftingEquations::new(body, back_emf, total);
        let mut series = vec![0.0; SERIES * springs.count()];
        // Angles and rates alternate in the state vector.
        for (n, index) in (0..2).flat_map(|n| (0..springs.count()).map(move |index| (n, index))) {
            series[n * springs.count() + index] = start[2 * index + n];
        }
        Self {
            start: series[..2 * springs.count()].to_vec(),
            ratios: vec![RatioSeries::new(0.0); drift.count()],
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

    /// Begins a motion under a constant reduced moment (rad/s²), from the current state, at the time `now` (s).
    pub fn depart(&mut self, now: f64, moment: f64) {
        self.rebase(self.seen - self.begins);
        (self.moment, self.departed) = (moment, now);
        (self.begins, self.seen) = (0.0, 0.0);
        self.start.copy_from_slice(&self.series[..2 * self.springs.count()]);
    }

    /// Sets the rigid angle and rate to 0 in the current state: the accuracy of steps is relative to the largest
    /// coordinate.
    pub fn zero_rigid_angle(&mut self) {
        self.rebase(self.seen - self.begins);
        self.begins = self.seen;
        let count = self.springs.count();
        (self.series[0], self.series[count]) = (0.0, 0.0);
    }

    /// Returns the equations of motion.
    pub fn equations(&self) -> &DriftingEquations<f64> {
        &self.springs
    }

    /// Returns the angles of all coordinates at departure, then their rates.
    pub fn start(&self) -> &[f64] {
        &self.start
    }

    /// Expands the ratios of the frequencies at a time (s).
    pub fn expand_ratios(&self, t: f64, into: &mut [RatioSeries<f64>]) {
        for (mode, ratio) in into.iter_mut().enumerate() {
            ratio.expand(&self.drift, mode, t);
        }
    }

    /// Returns the number of frequency ratios.
    pub fn ratios(&self) -> usize {
        self.ratios.len()
    }

    /// Returns true if the series begin at departure and are valid.
    pub fn is_at_start(&self) -> bool {
        self.begins == 0.0 && !self.raw
    }

    /// Returns a copy of the motion, restarted from its departure.
    #[must_use]
    pub fn restarted(&self) -> Self {
        let mut again = self.clone();
        again.series[..2 * self.springs.count()].copy_from_slice(&self.start);
        (again.begins, again.seen) = (0.0, 0.0);
        again.raw = true;
        again.expand();
        again
    }

    /// Moves the origin of the series to `h` seconds after departure, not before the present origin.
    pub fn expand_to(&mut self, h: f64) {
        if h > self.begins {
            self.rebase(h - self.begins);
            self.begins = h;
        }
        self.expand();
    }

    /// Writes the series of all coordinates; returns the time for which they are valid (s), infinite if that is at
    /// least `far`.
    pub fn write_series(&self, far: f64, coordinates: &mut [Series]) -> f64 {
        let count = self.springs.count();
        for (index, into) in coordinates.iter_mut().enumerate().take(count) {
            for (n, term) in into[..SERIES].iter_mut().enumerate() {
                *term = self.series[n * count + index];
            }
        }
        if self.springs.certainly_converges_to(&self.series, far) { f64::INFINITY } else { self.reach() }
    }

    /// Advances by some steps towards `h` seconds after departure, which must not precede an earlier request; returns
    /// true if that time is reached.
    pub fn approach(&mut self, h: f64) -> bool {
        self.expand();
        for _ in 0..STEPS {
            let left = h - self.begins;
            if self.springs.certainly_converges_to(&self.series, left) {
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

    /// Advances to `h` seconds after departure, which must not precede an earlier request.
    pub fn advance(&mut self, h: f64) {
        while !self.approach(h) {}
        self.seen = h;
    }

    /// Returns angle (rad), rate (rad/s) and acceleration (rad/s²) of each coordinate in the current state.
    pub fn motion(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        let h = self.seen - self.begins;
        (0..self.springs.count()).map(move |index| self.springs.at(&self.series, index, h))
    }

    /// Returns the time for which the series are valid (s).
    fn reach(&self) -> f64 {
        self.springs.radius(&self.series) / SAFETY
    }

    /// Moves the origin of the series by `h` seconds; only their first two terms are then valid.
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

    /// Computes all series from their first two terms, unless they are valid.
    fn expand(&mut self) {
        if !std::mem::take(&mut self.raw) {
            return;
        }
        for (mode, ratio) in self.ratios.iter_mut().enumerate() {
            ratio.expand(&self.drift, mode, self.departed + self.begins);
        }
        self.springs.expand(&self.ratios, self.moment, &mut self.series);
    }
}
