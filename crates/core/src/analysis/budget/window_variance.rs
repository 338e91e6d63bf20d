//! Variances of the pointing indices of a stationary error, in closed form from its autocovariance as a sum of exponentials.
//!
//! R(x) = sum of Re(c e^(p |x|)), as a linear loop has it from its poles p and residues c, and a sine of amplitude A and
//! frequency w with c = A²/2, p = iw.

use nalgebra::Complex;

/// Product of pole and window below which a power series replaces differences of nearly equal numbers.
const SMALL: f64 = 0.1;
/// Number of terms of the power series.
const TERMS: u32 = 14;

/// Term Re(c e^(p |x|)) of an autocovariance.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct AutocovarianceTerm {
    /// Residue c.
    pub residue: Complex<f64>,
    /// Pole p (1/s), whose real part is at most 0.
    pub pole: Complex<f64>,
}

impl AutocovarianceTerm {
    /// Returns the term of a sine.
    pub fn sine(amplitude: f64, frequency: f64) -> Self {
        let residue = Complex::new(0.5 * amplitude * amplitude, 0.0);
        Self { residue, pole: Complex::new(0.0, frequency) }
    }
}

/// Variances of the pointing indices of an error.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct IndexVariances {
    /// Absolute error.
    pub absolute: f64,
    /// Mean over a window.
    pub mean: f64,
    /// Error less its mean, at any instant of the window.
    pub relative_uniform: f64,
    /// Error less its mean, at the end of the window.
    pub relative_end: f64,
    /// Error less its mean, in the middle of the window.
    pub relative_middle: f64,
    /// Difference of the means over two windows.
    pub difference: f64,
}

impl IndexVariances {
    /// Returns the variances for a window (s), and for two of them that begin `shift` (s) apart, at least the window.
    pub fn new(terms: &[AutocovarianceTerm], window: f64, shift: f64) -> Self {
        let sum = |value: &dyn Fn(Complex<f64>) -> Complex<f64>| -> f64 {
            terms.iter().map(|term| (term.residue * value(term.pole)).re).sum()
        };
        let absolute = sum(&|_| Complex::new(1.0, 0.0));
        // Means of R over the part of a window on one side of an instant, for the whole and for half of it.
        let [whole, half] = [window, 0.5 * window].map(|length| sum(&|pole| first(pole * length)));
        let mean = 2.0 * sum(&|pole| second(pole * window));
        let apart = sum(&|pole| between(pole, window, shift));
        Self {
            absolute,
            mean,
            relative_uniform: absolute - mean,
            relative_end: absolute + mean - 2.0 * whole,
            relative_middle: absolute + mean - 2.0 * half,
            difference: 2.0 * mean - 2.0 * apart,
        }
    }
}

fn is_small(z: Complex<f64>) -> bool {
    libm::hypot(z.re, z.im) < SMALL
}

fn exp(z: Complex<f64>) -> Complex<f64> {
    let size = libm::exp(z.re);
    Complex::new(size * libm::cos(z.im), size * libm::sin(z.im))
}

/// Returns (e^z - 1)/z.
fn first(z: Complex<f64>) -> Complex<f64> {
    if is_small(z) { series(z, 1) } else { (exp(z) - 1.0) / z }
}

/// Returns (e^z - 1 - z)/z².
fn second(z: Complex<f64>) -> Complex<f64> {
    if is_small(z) { series(z, 2) } else { (exp(z) - 1.0 - z) / (z * z) }
}

/// Returns e^(pS) (e^(pT) - 2 + e^(-pT))/(pT)², the covariance of the means over two windows of length T that begin S apart:
/// the square of (e^(pT) - 1)/(pT), times e^(p(S - T)).
fn between(pole: Complex<f64>, window: f64, shift: f64) -> Complex<f64> {
    let mean = first(pole * window);
    mean * mean * exp(pole * (shift - window))
}

/// Returns the sum of z^n/(n + skip)!.
fn series(z: Complex<f64>, skip: u32) -> Complex<f64> {
    let mut factor = (1..=skip).map(f64::from).product::<f64>().recip();
    let (mut power, mut sum) = (Complex::new(1.0, 0.0), Complex::new(0.0, 0.0));
    for n in 0..TERMS {
        sum += power * factor;
        power *= z;
        factor /= f64::from(n + skip + 1);
    }
    sum
}
