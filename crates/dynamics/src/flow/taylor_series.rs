//! Taylor series of a body whose frequencies drift, for one run or for a batch of runs in lanes.
//!
//! x_r'' = p, x_i'' + 2 zeta_i w_i r_i(t) x_i' + w_i² r_i(t)² x_i = k_i p with p = m - a x' and the ratios r_i given as
//! series themselves: each coefficient follows from the previous ones. The series have order 20, and the step keeps
//! their truncation error at the last bit of the largest coordinate (Jorba and Zou, Experimental Mathematics 14, 2005).

use flexsc_numerics::lanes::LaneFloat;

use crate::axis_model::{AxisMode, AxisModel};
use crate::frequency_drift::{FrequencyDrift, SERIES};

/// Ratio e² of the radius of convergence to the step at which a series of this order truncates the last bit of a
/// double.
pub const SAFETY: f64 = 7.389_056_098_930_65;
/// Safety factor on a step that covers the rounding of the valid time.
const SURE: f64 = 1.000_001;

/// Coefficients of the equations of motion, for the rigid angle and then the modes.
#[derive(Clone, Debug)]
pub struct DriftingEquations<R> {
    gain: Vec<R>,
    /// Values of w², and 2 zeta w in `drag`, at a ratio of 1; 0 for the rigid angle.
    stiffness: Vec<R>,
    drag: Vec<R>,
    damped: Vec<bool>,
    back_emf: R,
    /// Number of coordinates whose rates the back-EMF opposes.
    felt: usize,
    /// Time in which the fastest mode turns by a radian (s).
    unit: R,
}

/// Series of the frequency ratio of some modes over a step and of its square, with the number of terms that are not 0.
#[derive(Clone, Debug)]
pub struct RatioSeries<R> {
    itself: [R; SERIES],
    square: [R; SERIES],
    terms: (usize, usize),
}

impl<R: LaneFloat> RatioSeries<R> {
    /// Creates a ratio that is not yet expanded.
    pub fn new(kind: R) -> Self {
        let zero = kind.splat(0.0);
        Self { itself: [zero; SERIES], square: [zero; SERIES], terms: (1, 1) }
    }

    /// Sets the lanes to the ratios of index `index` of a batch of runs; terms that one of them lacks are 0.
    #[inline(always)]
    pub fn set_lane(&mut self, all: &[Vec<RatioSeries<f64>>], index: usize) {
        self.terms = (1, 1);
        for one in all {
            let one = &one[index];
            self.terms = (self.terms.0.max(one.terms.0), self.terms.1.max(one.terms.1));
        }
        let mut each = [[0.0; 16]; 2];
        for n in 0..self.terms.1 {
            for (lane, one) in all.iter().enumerate() {
                let one = &one[index];
                each[0][lane] = if n < one.terms.0 { one.itself[n] } else { 0.0 };
                each[1][lane] = if n < one.terms.1 { one.square[n] } else { 0.0 };
            }
            (self.itself[n], self.square[n]) = (self.itself[0].load(&each[0]), self.itself[0].load(&each[1]));
        }
    }
}

impl RatioSeries<f64> {
    /// Expands the profile of a mode at a time (s).
    pub fn expand(&mut self, drift: &FrequencyDrift, mode: usize, t: f64) {
        let terms = drift.series(mode, t, &mut self.itself);
        let last = (2 * terms - 1).min(SERIES);
        for n in 0..last {
            let parts = n.saturating_sub(terms - 1)..=n.min(terms - 1);
            self.square[n] = parts.map(|j| self.itself[j] * self.itself[n - j]).sum();
        }
        self.terms = (terms, last);
    }
}

impl DriftingEquations<f64> {
    /// Creates the equations of a body. A wheel's back-EMF a (1/s) acts on the total rate if `total` is true, else on
    /// the rigid rate.
    pub fn new(body: &AxisModel, back_emf: f64, total: bool) -> Self {
        let frequencies = || body.modes.iter().map(|mode| mode.frequency.get());
        let with = |rigid: f64, of: &dyn Fn(&AxisMode) -> f64| {
            std::iter::once(rigid).chain(body.modes.iter().map(of)).collect::<Vec<f64>>()
        };
        let drag = with(0.0, &|mode| 2.0 * mode.damping.get() * mode.frequency.get());
        Self {
            gain: with(1.0, &|mode| mode.gain.get()),
            stiffness: with(0.0, &|mode| mode.frequency.get() * mode.frequency.get()),
            damped: drag.iter().map(|drag| *drag > 0.0).collect(),
            drag,
            back_emf,
            felt: if total { 1 + body.modes.len() } else { 1 },
            unit: 1.0 / frequencies().fold(1e-9, f64::max),
        }
    }

    /// Combines the equations of a batch of bodies in lanes; `None` unless they have the same structure.
    pub fn for_lanes<R: LaneFloat>(kind: R, all: &[&Self]) -> Option<DriftingEquations<R>> {
        let [first, rest @ ..] = all else { return None };
        if rest.iter().any(|other| other.damped != first.damped || other.felt != first.felt) {
            return None;
        }
        let beside = |of: &dyn Fn(&Self) -> f64| {
            let each: Vec<f64> = (0..R::LANES).map(|lane| of(all[lane.min(all.len() - 1)])).collect();
            kind.load(&each)
        };
        let list = |of: fn(&Self) -> &[f64]| (0..first.gain.len()).map(|at| beside(&|s| of(s)[at])).collect();
        Some(DriftingEquations {
            gain: list(|springs| &springs.gain),
            stiffness: list(|springs| &springs.stiffness),
            drag: list(|springs| &springs.drag),
            damped: first.damped.clone(),
            back_emf: beside(&|springs| springs.back_emf),
            felt: first.felt,
            unit: beside(&|springs| springs.unit),
        })
    }

    /// Estimates the radius of convergence from the last two terms (s); infinite for a body at rest.
    pub fn radius(&self, series: &[f64]) -> f64 {
        let size = self.size(series);
        let of = |n: usize| match self.largest(series, n) {
            0.0 => f64::INFINITY,
            term => libm::pow(size / term, 1.0 / n as f64),
        };
        let radius = of(SERIES - 1).min(of(SERIES - 2));
        // A NaN ends the run at the point where the state is evaluated.
        if radius > 0.0 { radius } else { f64::INFINITY }
    }
}

impl<R: LaneFloat> DriftingEquations<R> {
    /// Returns the number of coordinates.
    #[inline(always)]
    pub fn count(&self) -> usize {
        self.gain.len()
    }

    /// Computes all series from their first two terms, stored by order for all coordinates, under a constant reduced
    /// moment (rad/s²).
    #[inline(always)]
    pub fn expand(&self, ratios: &[RatioSeries<R>], moment: R, series: &mut [R]) {
        let count = self.gain.len();
        let series = &mut series[..SERIES * count];
        // Slices of one length, so that no index within is checked.
        let (gain, stiffness) = (&self.gain[..count], &self.stiffness[..count]);
        let (drag, damped) = (&self.drag[..count], &self.damped[..count]);
        for n in 0..SERIES - 2 {
            let term = (n + 1) as f64;
            let (known, new) = series.split_at_mut((n + 2) * count);
            let (coordinates, rates) = (&known[n * count..][..count], &known[(n + 1) * count..][..count]);
            let new = &mut new[..count];
            let mut sensed = rates[0];
            for index in 1..self.felt {
                sensed = sensed + rates[index];
            }
            let outer = if n == 0 { moment } else { moment.splat(0.0) };
            let push = outer - self.back_emf * term * sensed;
            let divisor = moment.splat(term * (term + 1.0));
            new[0] = gain[0] * push / divisor;
            for index in 1..count {
                let ratio = &ratios[(index - 1).min(ratios.len() - 1)];
                let mut spring = coordinates[index] * ratio.square[0];
                for j in 1..ratio.terms.1.min(n + 1) {
                    spring = spring + known[(n - j) * count + index] * ratio.square[j];
                }
                let mut acceleration = gain[index] * push - stiffness[index] * spring;
                if damped[index] {
                    let mut slowing = rates[index] * term * ratio.itself[0];
                    for j in 1..ratio.terms.0.min(n + 1) {
                        let rate = known[(n - j + 1) * count + index] * (n - j + 1) as f64;
                        slowing = slowing + rate * ratio.itself[j];
                    }
                    acceleration = acceleration - drag[index] * slowing;
                }
                new[index] = acceleration / divisor;
            }
        }
    }

    /// Returns a mask of the lanes whose series are certainly valid for `h` (s).
    #[inline(always)]
    pub fn certainly_converges_to(&self, series: &[R], h: R) -> R::Mask {
        let size = self.size(series);
        let step = h * SAFETY * SURE;
        let (square, mut power) = (step * step, step);
        for _ in 0..9 {
            power = power * square;
        }
        let (last, before) = (self.largest(series, SERIES - 1), self.largest(series, SERIES - 2));
        (last * power * step).le(size) & (before * power).le(size)
    }

    /// Returns the largest absolute value of the n-th terms.
    #[inline(always)]
    fn largest(&self, series: &[R], n: usize) -> R {
        let count = self.gain.len();
        let mut largest = series[n * count].abs();
        for index in 1..count {
            largest = series[n * count + index].abs().max(largest);
        }
        largest
    }

    /// Returns the size of the motion, in the unit of its angles (rad).
    #[inline(always)]
    fn size(&self, series: &[R]) -> R {
        let (angle, rate, half) = (self.largest(series, 0), self.largest(series, 1), self.largest(series, 2));
        angle.max(self.unit * rate).max(self.unit * self.unit * half)
    }

    /// Returns angle, rate and acceleration of a coordinate at `h` seconds after the origin of the series.
    #[inline(always)]
    pub fn at(&self, series: &[R], index: usize, h: R) -> [R; 3] {
        let count = self.gain.len();
        let mut x = h.splat(0.0);
        let (mut v, mut half) = (x, x);
        for n in (0..SERIES).rev() {
            half = half * h + v;
            v = v * h + x;
            x = x * h + series[n * count + index];
        }
        [x, v, half * 2.0]
    }
}
