//! The motion of a body whose frequencies drift, as Taylor series in time.
//!
//! x_r'' = p, x_i'' + 2 zeta_i w_i r_i(t) x_i' + w_i² r_i(t)² x_i = k_i p with p = m - a x' and the ratios r_i given as series
//! themselves: each coefficient follows from those before it. The series have order 20, and the step keeps what they leave
//! out at the last bit of the largest coordinate (Jorba and Zou, Experimental Mathematics 14, 2005).

use super::{Drift, Planar, SERIES};
use crate::numerics::polynomial::Series;

/// e²: the step over the radius of convergence at which the series of this order leaves out the last bit of a double.
const SAFETY: f64 = 7.389_056_098_930_65;
/// Steps that are taken at a time.
const STEPS: u32 = 16;

/// One coordinate: its series, and what moves it.
#[derive(Clone, Debug)]
struct Coordinate {
    gain: f64,
    /// w² and 2 zeta w at a ratio of 1; 0 of the rigid one.
    stiffness: f64,
    drag: f64,
    /// Whether its rate is opposed by the back-EMF.
    felt: bool,
    series: [f64; SERIES],
}

/// The ratio of some modes over a step, and its square: their series, and how many terms are not 0.
#[derive(Clone, Debug)]
struct Ratio {
    itself: [f64; SERIES],
    square: [f64; SERIES],
    terms: (usize, usize),
}

/// A motion under a constant input.
#[derive(Clone, Debug)]
pub struct Drifting {
    drift: Drift,
    back_emf: f64,
    /// The rigid angle first, then the modes.
    coordinates: Vec<Coordinate>,
    ratios: Vec<Ratio>,
    /// A time in which the fastest mode turns by a radian (s).
    unit: f64,
    moment: f64,
    departed: f64,
    /// Angle and rate of each coordinate at departure.
    start: Vec<[f64; 2]>,
    /// When the series begin, after departure, and how far they reach (s).
    begins: f64,
    reach: f64,
    /// Where the body was seen last, after departure (s).
    seen: f64,
}

impl Ratio {
    const ONE: Self = Self { itself: [0.0; SERIES], square: [0.0; SERIES], terms: (0, 0) };

    /// Expands a profile at a time (s).
    fn expand(&mut self, drift: &Drift, mode: usize, t: f64) {
        let terms = drift.series(mode, t, &mut self.itself);
        let last = (2 * terms - 1).min(SERIES);
        for n in 0..last {
            let parts = n.saturating_sub(terms - 1)..=n.min(terms - 1);
            self.square[n] = parts.map(|j| self.itself[j] * self.itself[n - j]).sum();
        }
        self.terms = (terms, last);
    }
}

impl Drifting {
    /// A body at its start, under no input. A wheel takes back-EMF a (1/s) from the total rate, or from the rigid one.
    pub fn new(body: &Planar, drift: &Drift, back_emf: f64, total: bool) -> Self {
        let frequencies: Vec<f64> = body.modes.iter().map(|mode| mode.frequency.get()).collect();
        let start = body.start().to_vector(&frequencies);
        let placed = |index: usize| {
            let mut series = [0.0; SERIES];
            (series[0], series[1]) = (start[2 * index], start[2 * index + 1]);
            series
        };
        let rigid = Coordinate { gain: 1.0, stiffness: 0.0, drag: 0.0, felt: true, series: placed(0) };
        let modes = body.modes.iter().zip(&frequencies).enumerate().map(|(index, (mode, w))| Coordinate {
            gain: mode.gain.get(),
            stiffness: w * w,
            drag: 2.0 * mode.damping.get() * w,
            felt: total,
            series: placed(index + 1),
        });
        let fastest = frequencies.iter().copied().fold(1e-9, f64::max);
        let coordinates: Vec<_> = std::iter::once(rigid).chain(modes).collect();
        let mut drifting = Self {
            start: coordinates.iter().map(Coordinate::begins).collect(),
            coordinates,
            ratios: vec![Ratio::ONE; drift.count()],
            drift: drift.clone(),
            back_emf,
            unit: 1.0 / fastest,
            moment: 0.0,
            departed: 0.0,
            begins: 0.0,
            reach: 0.0,
            seen: 0.0,
        };
        drifting.expand();
        drifting
    }

    /// Begins a motion under a constant reduced moment (rad/s²), from where the body was seen last, at a time (s).
    pub fn depart(&mut self, now: f64, moment: f64) {
        self.rebase(self.seen - self.begins);
        (self.moment, self.departed) = (moment, now);
        (self.begins, self.seen) = (0.0, 0.0);
        for (start, coordinate) in self.start.iter_mut().zip(&self.coordinates) {
            *start = coordinate.begins();
        }
        self.expand();
    }

    /// The same motion, back at its departure.
    #[must_use]
    pub fn from_departure(&self) -> Self {
        let mut again = self.clone();
        for (coordinate, start) in again.coordinates.iter_mut().zip(&self.start) {
            [coordinate.series[0], coordinate.series[1]] = *start;
        }
        (again.begins, again.seen) = (0.0, 0.0);
        again.expand();
        again
    }

    /// Puts the series of all coordinates `h` seconds after departure, not before they begin, and returns how far they reach
    /// (s).
    pub fn unfold(&mut self, h: f64, coordinates: &mut [Series]) -> f64 {
        if h > self.begins {
            self.rebase(h - self.begins);
            self.begins = h;
            self.expand();
        }
        for (into, coordinate) in coordinates.iter_mut().zip(&self.coordinates) {
            into[..SERIES].copy_from_slice(&coordinate.series);
        }
        self.reach
    }

    /// Takes some steps towards `h` seconds after departure, not before a time gone to earlier; whether no more are needed.
    pub fn approach(&mut self, h: f64) -> bool {
        for _ in 0..STEPS {
            if h - self.begins <= self.reach {
                return true;
            }
            self.rebase(self.reach);
            self.begins += self.reach;
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
        self.coordinates.iter().map(move |coordinate| coordinate.at(h))
    }

    /// The series begin again `h` seconds later.
    fn rebase(&mut self, h: f64) {
        for coordinate in &mut self.coordinates {
            let [angle, rate, _] = coordinate.at(h);
            (coordinate.series[0], coordinate.series[1]) = (angle, rate);
        }
    }

    /// Finds all series from their first two terms.
    fn expand(&mut self) {
        let Self { coordinates, ratios, drift, departed, begins, .. } = self;
        for (mode, ratio) in ratios.iter_mut().enumerate() {
            ratio.expand(drift, mode, *departed + *begins);
        }
        for n in 0..SERIES - 2 {
            let term = (n + 1) as f64;
            let felt: f64 = coordinates.iter().filter(|c| c.felt).map(|c| c.series[n + 1]).sum();
            let push = if n == 0 { self.moment } else { 0.0 } - self.back_emf * term * felt;
            for (index, c) in coordinates.iter_mut().enumerate() {
                let mut acceleration = c.gain * push;
                if index > 0 {
                    let ratio = &ratios[(index - 1).min(ratios.len() - 1)];
                    let spring: f64 =
                        (0..ratio.terms.1.min(n + 1)).map(|j| ratio.square[j] * c.series[n - j]).sum();
                    acceleration -= c.stiffness * spring;
                    if c.drag > 0.0 {
                        let rate = |j: usize| (n - j + 1) as f64 * c.series[n - j + 1];
                        let slowing: f64 =
                            (0..ratio.terms.0.min(n + 1)).map(|j| ratio.itself[j] * rate(j)).sum();
                        acceleration -= c.drag * slowing;
                    }
                }
                c.series[n + 2] = acceleration / (term * (term + 1.0));
            }
        }
        self.reach = self.radius() / SAFETY;
    }

    /// The radius of convergence by the last two terms (s); infinite of a body at rest.
    fn radius(&self) -> f64 {
        let largest = |n: usize| self.coordinates.iter().map(|c| c.series[n].abs()).fold(0.0, f64::max);
        let size = largest(0).max(self.unit * largest(1)).max(self.unit * self.unit * largest(2));
        let of = |n: usize| match largest(n) {
            0.0 => f64::INFINITY,
            term => libm::pow(size / term, 1.0 / n as f64),
        };
        let radius = of(SERIES - 1).min(of(SERIES - 2));
        // What is no number ends the run where it is seen.
        if radius > 0.0 { radius } else { f64::INFINITY }
    }
}

impl Coordinate {
    /// Angle and rate where the series begin.
    fn begins(&self) -> [f64; 2] {
        [self.series[0], self.series[1]]
    }

    /// Angle, rate and acceleration `h` seconds after the series begin.
    fn at(&self, h: f64) -> [f64; 3] {
        let [mut x, mut v, mut half] = [0.0; 3];
        for term in self.series.iter().rev() {
            half = half * h + v;
            v = v * h + x;
            x = x * h + term;
        }
        [x, v, 2.0 * half]
    }
}
