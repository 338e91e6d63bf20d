//! Convergence of the recurrence observer with its true regressor, the oscillation of the mode.
//!
//! Each cycle of the linearised errors is a matrix that depends on the phase of the elastic rate; after a number of
//! cycles this phase returns. The frozen regressor allows gains that are too large by a factor of hundreds. Derived for
//! this project.

use nalgebra::{DMatrix, Matrix4, RowVector4};
use serde::Serialize;

use super::Convergence;
use crate::eigenvalues::eigenvalues;

/// Largest number of cycles after which the phase is taken to return.
const LONGEST: u32 = 400;
/// Difference (turns) below which two phases are the same.
const SAME: f64 = 1e-9;
/// Least and greatest gain that is tried, and the ratio of consecutive gains.
const GAINS: [f64; 3] = [1e-4, 10.0, 1.05];

/// Gains of the identification with which the observer converges.
#[derive(Copy, Clone, Debug, PartialEq, Serialize)]
pub struct GainMargin {
    /// Largest gain kappa up to which the observer converges.
    pub gain_max: f64,
    /// Gain with which the observer converges fastest.
    pub gain_best: f64,
    /// Factor by which a cycle multiplies an error with the gain `gain_best`.
    pub spectral_radius: f64,
}

impl Convergence {
    /// Returns the factor by which a cycle multiplies an error in the long run, for W4 = kappa/V under an elastic rate
    /// V cos(w T n): the observer converges below 1. Infinite if the eigenvalues cannot be found.
    pub fn spectral_radius(&self, kappa: f64) -> f64 {
        let count = self.cycles();
        let (mut product, mut scale) = (Matrix4::identity(), 0.0);
        for cycle in 0..count {
            product = self.cycle(kappa, cycle) * product;
            let size = product.amax();
            product /= size;
            scale += libm::log(size);
        }
        let product = DMatrix::from_fn(4, 4, |row, column| product[(row, column)]);
        let Some(values) = eigenvalues(&product) else { return f64::INFINITY };
        let largest = values.iter().map(|value| libm::hypot(value.re, value.im)).fold(0.0, f64::max);
        libm::exp((libm::log(largest) + scale) / f64::from(count))
    }

    /// Returns the gains with which the observer converges; `None` if it does not with the least gain that is tried.
    pub fn margin(&self) -> Option<GainMargin> {
        let [least, greatest, ratio] = GAINS;
        let radius = |gain: f64| self.spectral_radius(gain);
        let (mut low, mut best) = (least, (least, radius(least)));
        if best.1 >= 1.0 {
            return None;
        }
        let mut high = low;
        while low < greatest {
            high = low * ratio;
            let found = radius(high);
            if found >= 1.0 {
                break;
            }
            if found < best.1 {
                best = (high, found);
            }
            low = high;
        }
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            if radius(middle) < 1.0 { low = middle } else { high = middle }
        }
        let (mut from, mut to) = (best.0 / ratio, best.0 * ratio);
        for _ in 0..40 {
            let (lower, upper) = (from + (to - from) / 3.0, to - (to - from) / 3.0);
            if radius(lower) < radius(upper) { to = upper } else { from = lower }
        }
        let gain_best = 0.5 * (from + to);
        Some(GainMargin { gain_max: low, gain_best, spectral_radius: radius(gain_best) })
    }

    /// Returns the number of cycles after which the phase returns, or returns most nearly.
    fn cycles(&self) -> u32 {
        let turn = self.frequency * self.period / (2.0 * std::f64::consts::PI);
        let apart = |count: u32| {
            let turns = turn * f64::from(count);
            (turns - libm::round(turns)).abs()
        };
        let nearest = (1..=LONGEST).min_by(|&a, &b| apart(a).total_cmp(&apart(b))).unwrap_or(1);
        (1..=LONGEST).find(|&count| apart(count) < SAME).unwrap_or(nearest)
    }

    /// Returns the matrix of one cycle of the errors: of the predicted rigid rate, of the predicted elastic rate, of
    /// the elastic rate one sample before, and of A times V.
    fn cycle(&self, kappa: f64, cycle: u32) -> Matrix4<f64> {
        let ((a, b), [w1, w2, w3]) = (self.recurrence(), self.weights);
        let step = self.frequency * self.period;
        let phase = step * f64::from(cycle);
        let (now, before) = (libm::cos(phase), libm::cos(phase - step));
        let innovation = RowVector4::new(1.0, 1.0, 0.0, 0.0);
        let turn = RowVector4::new(0.0, 0.0, 0.0, 1.0) - innovation * (kappa * before.signum());
        let rigid = RowVector4::new(1.0, 0.0, 0.0, 0.0) - innovation * w1;
        let elastic = RowVector4::new(0.0, 1.0, 0.0, 0.0) - innovation * w2;
        let next = elastic * a + turn * now - RowVector4::new(0.0, 0.0, b, 0.0) + innovation * w3;
        Matrix4::from_rows(&[rigid, next, elastic, turn])
    }
}
