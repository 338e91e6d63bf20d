//! Waveforms: a command over time as a sum of terms, and the exact response of a mode to it.

use crate::phasor::{Complex, Phasor};

/// A command over time: the sum of its terms. Units are those of the command (N m, or rad/s² where the hub's motion
/// is commanded).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Waveform {
    /// The terms, in no order; they may overlap.
    pub terms: Vec<Term>,
}

/// A term of a waveform: zero outside `from <= t < to`.
#[derive(Clone, Debug, PartialEq)]
pub struct Term {
    /// When it begins (s).
    pub from: f64,
    /// When it ends (s).
    pub to: f64,
    /// What it is in between.
    pub shape: Shape,
}

/// The shape of a term, in the time t - from since it began.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// sum c\[n\] (t - from)^n.
    Polynomial(Vec<f64>),
    /// cosine cos(frequency (t - from)) + sine sin(frequency (t - from)).
    Harmonic {
        /// Frequency (rad/s).
        frequency: f64,
        /// Amplitude of the cosine.
        cosine: f64,
        /// Amplitude of the sine.
        sine: f64,
    },
}

impl Waveform {
    /// The value at a time (s), right-continuous.
    pub fn at(&self, t: f64) -> f64 {
        let active = self.terms.iter().filter(|term| term.from <= t && t < term.to);
        active.map(|term| term.value(t)).sum()
    }

    /// The times at which a term begins or ends (s), in order, each once.
    pub fn breaks(&self) -> Vec<f64> {
        let mut breaks: Vec<f64> = self.terms.iter().flat_map(|term| [term.from, term.to]).collect();
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        breaks
    }

    /// When the last term ends (s).
    pub fn end(&self) -> f64 {
        self.terms.iter().map(|term| term.to).fold(0.0, f64::max)
    }

    /// The integral of exp(pole (to - t)) u(t) from one time to another (s): what drives a mode of this pole.
    ///
    /// A mode x'' + 2 zeta w x' + w² x = g u with pole s = -zeta w + i w_d, w_d = w sqrt(1 - zeta²), that rests at
    /// `from` has x(to) = g Im(Z)/w_d and x'(to) = g Im(s Z)/w_d, Z being this integral.
    pub fn response(&self, pole: Phasor, from: f64, to: f64) -> Phasor {
        self.terms.iter().fold(Phasor::default(), |sum, term| sum + term.response(pole, from, to))
    }

    /// The integral of u(t) from one time to another (s).
    pub fn impulse(&self, from: f64, to: f64) -> f64 {
        self.response(Phasor::default(), from, to).re
    }

    /// The integral of (to - t) u(t) from one time to another (s): the angle that a unit inertia gains from it.
    pub fn travel(&self, from: f64, to: f64) -> f64 {
        self.terms.iter().map(|term| term.travel(from, to)).sum()
    }

    /// The same command later (s) and larger.
    #[must_use]
    pub fn shifted(&self, delay: f64, factor: f64) -> Self {
        let shift = |term: &Term| Term {
            from: term.from + delay,
            to: term.to + delay,
            shape: match &term.shape {
                Shape::Polynomial(c) => Shape::Polynomial(c.iter().map(|c| c * factor).collect()),
                Shape::Harmonic { frequency, cosine, sine } => {
                    Shape::Harmonic { frequency: *frequency, cosine: cosine * factor, sine: sine * factor }
                }
            },
        };
        Self { terms: self.terms.iter().map(shift).collect() }
    }
}

impl Term {
    /// The value that the shape has at a time (s), within the window or not.
    pub fn value(&self, t: f64) -> f64 {
        let t = t - self.from;
        match &self.shape {
            Shape::Polynomial(c) => c.iter().rev().fold(0.0, |sum, c| sum * t + c),
            Shape::Harmonic { frequency, cosine, sine } => {
                let (s, c) = libm::sincos(frequency * t);
                cosine * c + sine * s
            }
        }
    }

    fn response(&self, pole: Phasor, from: f64, to: f64) -> Phasor {
        let Some((start, end)) = self.within(from, to) else { return Phasor::default() };
        let h = end - start;
        let driven = match &self.shape {
            Shape::Polynomial(c) => {
                let mut power = h; // n! h^(n + 1)
                let mut sum = Phasor::default();
                for (n, c) in rebased(c, start - self.from).into_iter().enumerate() {
                    sum += phi(n + 1, pole * h) * (c * power);
                    power *= h * (n + 1) as f64;
                }
                sum
            }
            Shape::Harmonic { frequency, .. } => {
                let phasor = self.phasor(start);
                let i = Complex { re: 0.0, im: *frequency };
                let swing = |i: Phasor| exp(pole * h) * phi(1, (i - pole) * h) * h;
                (phasor * swing(i) + phasor.conj() * swing(-i)) * 0.5
            }
        };
        if end < to { driven * exp(pole * (to - end)) } else { driven }
    }

    fn travel(&self, from: f64, to: f64) -> f64 {
        let Some((start, end)) = self.within(from, to) else { return 0.0 };
        let h = end - start;
        let (impulse, travel) = match &self.shape {
            Shape::Polynomial(c) => {
                let mut power = h;
                let (mut impulse, mut travel) = (0.0, 0.0);
                for (n, c) in rebased(c, start - self.from).into_iter().enumerate() {
                    let n = n as f64;
                    impulse += c * power / (n + 1.0);
                    travel += c * power * h / ((n + 1.0) * (n + 2.0));
                    power *= h;
                }
                (impulse, travel)
            }
            Shape::Harmonic { frequency, .. } => {
                let phasor = self.phasor(start);
                let turn = Complex { re: 0.0, im: frequency * h };
                ((phasor * phi(1, turn)).re * h, (phasor * phi(2, turn)).re * h * h)
            }
        };
        travel + impulse * (to - end)
    }

    /// The part of an interval that lies within the term's window.
    fn within(&self, from: f64, to: f64) -> Option<(f64, f64)> {
        let (start, end) = (from.max(self.from), to.min(self.to));
        (start < end).then_some((start, end))
    }

    /// A harmonic as Re(phasor exp(i frequency (t - at))).
    fn phasor(&self, at: f64) -> Phasor {
        match self.shape {
            Shape::Harmonic { frequency, cosine, sine } => {
                let turn = exp(Complex { re: 0.0, im: frequency * (at - self.from) });
                Complex { re: cosine, im: -sine } * turn
            }
            Shape::Polynomial(_) => Phasor::default(),
        }
    }
}

/// The coefficients of a polynomial about another origin.
fn rebased(coefficients: &[f64], origin: f64) -> Vec<f64> {
    let mut c = coefficients.to_vec();
    if origin != 0.0 {
        for low in 0..c.len() {
            for n in (low..c.len() - 1).rev() {
                c[n] += origin * c[n + 1];
            }
        }
    }
    c
}

fn exp(z: Phasor) -> Phasor {
    crate::phasor::polar(libm::exp(z.re), z.im)
}

/// phi_n(z) = sum z^k/(n + k)! = the integral of exp(z (1 - t)) t^(n-1)/(n-1)! from 0 to 1.
fn phi(n: usize, z: Phasor) -> Phasor {
    let size = crate::phasor::abs(z);
    if size < (n + 1) as f64 {
        // Each term is smaller than the one before: nothing cancels.
        let mut term = Phasor::new((1..=n).fold(1.0, |product, k| product / k as f64), 0.0);
        let mut sum = term;
        let mut k = n;
        while crate::phasor::abs(term) > 1e-18 * crate::phasor::abs(sum) {
            k += 1;
            term = term * z / k as f64;
            sum += term;
        }
        return sum;
    }
    // Upwards from exp, which |z| > n keeps from growing errors.
    let mut factorial = 1.0;
    let mut value = exp(z);
    for k in 0..n {
        value = (value - 1.0 / factorial) / z;
        factorial *= (k + 1) as f64;
    }
    value
}
