//! Waveforms: a command over time as a sum of terms, and the exact response of a mode to it.

use flexsc_numerics::phasor::{Complex, Phasor};
use flexsc_numerics::phi::{exp, moment, phi};
use flexsc_numerics::polynomial::{Series, TERMS};

/// Command over time: the sum of its terms, in the unit of the command (N m, or rad/s² if the hub's motion is
/// commanded).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Waveform {
    /// Terms, in no order; they may overlap.
    pub terms: Vec<Term>,
}

/// Term of a waveform, zero outside `from <= t < to`.
#[derive(Clone, Debug, PartialEq)]
pub struct Term {
    /// Start time (s).
    pub from: f64,
    /// End time (s).
    pub to: f64,
    /// Shape within the window.
    pub shape: TermShape,
}

/// Shape of a term, as a function of the time t - from since its start.
#[derive(Clone, Debug, PartialEq)]
pub enum TermShape {
    /// Polynomial sum c\[n\] (t - from)^n.
    Polynomial(Vec<f64>),
    /// Harmonic cosine cos(frequency (t - from)) + sine sin(frequency (t - from)).
    Harmonic {
        /// Frequency (rad/s).
        frequency: f64,
        /// Amplitude of the cosine.
        cosine: f64,
        /// Amplitude of the sine.
        sine: f64,
    },
    /// Exponential Re(exp(pole (t - from)) sum c\[n\] (t - from)^n).
    Exponential {
        /// Growth (1/s) and frequency (rad/s).
        pole: Phasor,
        /// Coefficients c.
        coefficients: Vec<Phasor>,
    },
}

impl Waveform {
    /// Returns the value at a time (s), right-continuous.
    pub fn at(&self, t: f64) -> f64 {
        self.value_on_piece(t, t)
    }

    /// Returns the value at `t` (s) of the terms that are active at `middle` (s): at a break, the limit from that
    /// side.
    pub fn value_on_piece(&self, middle: f64, t: f64) -> f64 {
        let active = self.terms.iter().filter(|term| term.from <= middle && middle < term.to);
        active.map(|term| term.value(t)).sum()
    }

    /// Returns the largest frequency of a term (rad/s).
    pub fn fastest(&self) -> f64 {
        let frequency = |term: &Term| match &term.shape {
            TermShape::Polynomial(c) => (c.len() as f64 - 1.0).max(0.0) / (term.to - term.from),
            TermShape::Harmonic { frequency, .. } => frequency.abs(),
            TermShape::Exponential { pole, .. } => flexsc_numerics::phasor::abs(*pole),
        };
        self.terms.iter().map(frequency).fold(0.0, f64::max)
    }

    /// Returns the times at which a term begins or ends (s), in order, each once.
    pub fn breaks(&self) -> Vec<f64> {
        let mut breaks: Vec<f64> = self.terms.iter().flat_map(|term| [term.from, term.to]).collect();
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        breaks
    }

    /// Returns the end time of the last term (s).
    pub fn end(&self) -> f64 {
        self.terms.iter().map(|term| term.to).fold(0.0, f64::max)
    }

    /// Returns true if every number is finite.
    pub fn is_finite(&self) -> bool {
        self.terms.iter().all(|term| match &term.shape {
            TermShape::Polynomial(c) => c.iter().all(|c| c.is_finite()),
            TermShape::Harmonic { frequency, cosine, sine } => {
                frequency.is_finite() && cosine.is_finite() && sine.is_finite()
            }
            TermShape::Exponential { pole, coefficients } => {
                coefficients.iter().chain([pole]).all(|c| c.re.is_finite() && c.im.is_finite())
            }
        })
    }

    /// Returns the integral of exp(pole (to - t)) u(t) over `from` to `to` (s), which drives a mode of this pole.
    ///
    /// A mode x'' + 2 zeta w x' + w² x = g u with pole s = -zeta w + i w_d, w_d = w sqrt(1 - zeta²), that rests at
    /// `from` has x(to) = g Im(Z)/w_d and x'(to) = g Im(s Z)/w_d, where Z is this integral.
    pub fn response(&self, pole: Phasor, from: f64, to: f64) -> Phasor {
        self.terms.iter().fold(Phasor::default(), |sum, term| sum + term.response(pole, from, to))
    }

    /// Returns the integral of u(t) over `from` to `to` (s).
    pub fn impulse(&self, from: f64, to: f64) -> f64 {
        self.response(Phasor::default(), from, to).re
    }

    /// Returns the integral of (to - t) u(t) over `from` to `to` (s): the resulting angle of a unit inertia.
    pub fn travel(&self, from: f64, to: f64) -> f64 {
        self.terms.iter().map(|term| term.travel(from, to)).sum()
    }

    /// Returns the Taylor series at `t` (s) of the terms that are active at `middle` (s).
    pub fn series(&self, middle: f64, t: f64) -> Series {
        let mut series = [0.0; TERMS];
        for term in self.terms.iter().filter(|term| term.from <= middle && middle < term.to) {
            let (pole, coefficients) = term.shifted(t);
            // Product of exp(pole t) and each power of t.
            let mut factor = Phasor::new(1.0, 0.0);
            for k in 0..TERMS {
                for (n, c) in coefficients.iter().enumerate().take(TERMS - k) {
                    series[n + k] += (c * factor).re;
                }
                factor = factor * pole / (k + 1) as f64;
            }
        }
        series
    }

    /// Returns the command delayed by `delay` (s) and scaled by `factor`.
    #[must_use]
    pub fn shifted(&self, delay: f64, factor: f64) -> Self {
        let shift = |term: &Term| Term {
            from: term.from + delay,
            to: term.to + delay,
            shape: match &term.shape {
                TermShape::Polynomial(c) => TermShape::Polynomial(c.iter().map(|c| c * factor).collect()),
                TermShape::Harmonic { frequency, cosine, sine } => TermShape::Harmonic {
                    frequency: *frequency,
                    cosine: cosine * factor,
                    sine: sine * factor,
                },
                TermShape::Exponential { pole, coefficients } => TermShape::Exponential {
                    pole: *pole,
                    coefficients: coefficients.iter().map(|c| c * factor).collect(),
                },
            },
        };
        Self { terms: self.terms.iter().map(shift).collect() }
    }
}

impl Term {
    /// Returns the value of the shape at a time (s), whether or not within the window.
    pub fn value(&self, t: f64) -> f64 {
        let t = t - self.from;
        match &self.shape {
            TermShape::Polynomial(c) => c.iter().rev().fold(0.0, |sum, c| sum * t + c),
            TermShape::Harmonic { frequency, cosine, sine } => {
                let (s, c) = libm::sincos(frequency * t);
                cosine * c + sine * s
            }
            TermShape::Exponential { pole, coefficients } => {
                let sum = coefficients.iter().rev().fold(Phasor::default(), |sum, c| sum * t + c);
                (exp(pole * t) * sum).re
            }
        }
    }

    fn response(&self, pole: Phasor, from: f64, to: f64) -> Phasor {
        let Some((start, end)) = self.within(from, to) else { return Phasor::default() };
        let h = end - start;
        let part = |own: Phasor, coefficients: Vec<Phasor>| {
            let mut power = h; // n! h^(n + 1)
            let mut sum = Phasor::default();
            for (n, c) in coefficients.into_iter().enumerate() {
                sum += phi(n + 1, (pole - own) * h) * c * power;
                power *= h * (n + 1) as f64;
            }
            exp(own * h) * sum
        };
        let (own, coefficients) = self.shifted(start);
        let driven = if matches!(self.shape, TermShape::Polynomial(_)) {
            part(own, coefficients)
        } else {
            // The real part of the shape is half the sum of the shape and its conjugate.
            let conjugate = coefficients.iter().map(Phasor::conj).collect();
            (part(own, coefficients) + part(own.conj(), conjugate)) * 0.5
        };
        if end < to { driven * exp(pole * (to - end)) } else { driven }
    }

    fn travel(&self, from: f64, to: f64) -> f64 {
        let Some((start, end)) = self.within(from, to) else { return 0.0 };
        let h = end - start;
        let (own, coefficients) = self.shifted(start);
        let (mut impulse, mut travel) = (0.0, 0.0);
        let mut power = h;
        for (n, c) in coefficients.into_iter().enumerate() {
            // Integrals of t^n exp(z t) and of (1 - t) t^n exp(z t) from 0 to 1.
            let z = own * h;
            let (whole, remainder) = match (n, &self.shape) {
                (_, TermShape::Polynomial(_)) => {
                    let n = n as f64;
                    (Phasor::new(1.0 / (n + 1.0), 0.0), Phasor::new(1.0 / ((n + 1.0) * (n + 2.0)), 0.0))
                }
                (0, _) => (phi(1, z), phi(2, z)),
                _ => (moment(n, z), moment(n, z) - moment(n + 1, z)),
            };
            impulse += (c * whole).re * power;
            travel += (c * remainder).re * power * h;
            power *= h;
        }
        travel + impulse * (to - end)
    }

    /// Returns the part of an interval that lies within the term's window.
    fn within(&self, from: f64, to: f64) -> Option<(f64, f64)> {
        let (start, end) = (from.max(self.from), to.min(self.to));
        (start < end).then_some((start, end))
    }

    /// Returns the shape as Re(exp(pole t) sum c\[n\] t^n) in the time t since another origin: pole and c.
    fn shifted(&self, origin: f64) -> (Phasor, Vec<Phasor>) {
        let since = origin - self.from;
        let (pole, coefficients) = match &self.shape {
            TermShape::Polynomial(c) => (Phasor::default(), c.iter().map(|c| Phasor::new(*c, 0.0)).collect()),
            TermShape::Harmonic { frequency, cosine, sine } => {
                (Complex { re: 0.0, im: *frequency }, vec![Complex { re: *cosine, im: -sine }])
            }
            TermShape::Exponential { pole, coefficients } => (*pole, coefficients.clone()),
        };
        if since == 0.0 {
            return (pole, coefficients);
        }
        let turn = exp(pole * since);
        (pole, rebased(coefficients, since).into_iter().map(|c| c * turn).collect())
    }
}

/// Returns the coefficients of a polynomial about another origin.
fn rebased(mut c: Vec<Phasor>, origin: f64) -> Vec<Phasor> {
    for low in 0..c.len() {
        for n in (low..c.len() - 1).rev() {
            let above = c[n + 1];
            c[n] += above * origin;
        }
    }
    c
}
