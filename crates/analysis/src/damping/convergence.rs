//! Convergence of the recurrence observer with a frozen regressor: \[Timakov14\], pages 44 to 46.
//!
//! A constant elastic rate cannot be distinguished from a rigid one: one eigenvalue is 1 whatever the weights. The
//! others are the roots of z³ + a2 z² + a1 z + a0 with, by A = 2 exp(-zeta w T) cos(w_d T), B = exp(-2 zeta w T) and
//! kappa = W4 |g|, a2 = kappa - A - 1 + W1 - (W3 - A W2), a1 = B + A - W1 A + (W3 - A W2) - B W2, a0 = B (W1 + W2 - 1).

use serde::Serialize;

/// Strips in which the area of a region is summed.
const STRIPS: u32 = 20_000;

/// Recurrence observer of one mode.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Convergence {
    /// Natural frequency of the mode (rad/s).
    pub frequency: f64,
    /// Damping ratio of the mode, below 1.
    pub damping: f64,
    /// Sampling period (s).
    pub period: f64,
    /// Weights W1, W2 and W3: parts of an innovation that correct the rigid rate and the elastic rate, and the part
    /// that is subtracted from the next innovation.
    pub weights: [f64; 3],
}

/// Edge of a region of convergence at one weight W2.
#[derive(Copy, Clone, Debug, PartialEq, Serialize)]
pub struct RegionEdge {
    /// Weight W2.
    pub elastic: f64,
    /// Range of the weight W3 in which the observer converges; none if it converges with no W3.
    pub next: Option<(f64, f64)>,
}

impl Convergence {
    /// Returns the name of the first number that is out of range, and the reason.
    pub fn inconsistency(&self) -> Option<(&'static str, String)> {
        let Self { frequency, damping, period, weights } = *self;
        if !(0.0..1.0).contains(&damping) {
            return Some(("damping", format!("must be 0 or more and below 1, got {damping}")));
        }
        if !(period > 0.0 && period < 1e100) {
            return Some(("period", format!("must be above 0 and below 1e100, got {period:e}")));
        }
        let nyquist = std::f64::consts::PI / period;
        if !(frequency > 0.0 && frequency < nyquist) {
            let why = format!(
                "must be above 0 and below the Nyquist frequency of {nyquist} rad/s, got {frequency}"
            );
            return Some(("frequency", why));
        }
        let wrong = weights.into_iter().find(|weight| !(-1e3..1e3).contains(weight))?;
        Some(("weights", format!("must be three numbers below 1000, got {wrong}")))
    }

    /// Returns the coefficients A and B of the mode's recurrence.
    pub fn recurrence(&self) -> (f64, f64) {
        let Self { frequency, damping, period, .. } = self;
        let turn = frequency * f64::sqrt((1.0 - damping) * (1.0 + damping)) * period;
        let shrink = libm::exp(-damping * frequency * period);
        (2.0 * shrink * libm::cos(turn), shrink * shrink)
    }

    /// Returns a0, a1 and a2 of the characteristic polynomial for `kappa`.
    pub fn cubic(&self, kappa: f64) -> [f64; 3] {
        let ((a, b), [w1, w2, w3]) = (self.recurrence(), self.weights);
        let w3 = w3 - a * w2;
        [b * (w1 + w2 - 1.0), b + a - w1 * a + w3 - b * w2, kappa - a - 1.0 + w1 - w3]
    }

    /// Returns true if all roots lie within the unit circle, by Jury's criterion.
    pub fn converges(&self, kappa: f64) -> bool {
        let [.., w3] = self.weights;
        self.edge(kappa).is_some_and(|(low, high)| low < w3 && w3 < high)
    }

    /// Returns the range of W3 in which the observer converges with its W1 and W2; `None` if it converges with no W3.
    fn edge(&self, kappa: f64) -> Option<(f64, f64)> {
        let [w1, w2, _] = self.weights;
        let (a, b) = self.recurrence();
        let [a0, a1, a2] = Self { weights: [w1, w2, 0.0], ..*self }.cubic(kappa);
        // W3 is added to a1 and subtracted from a2: P(1) does not depend on it, and -P(-1) and a0 a2 - a1 are linear in
        // it.
        if a0.abs() >= 1.0 || w1 * (1.0 - a + b) + kappa <= 0.0 {
            return None;
        }
        let (middle, half) = ((a0 * a2 - a1) / (1.0 + a0), 1.0 - a0);
        let low = (middle - half).max(-0.5 * (1.0 - a2 + a1 - a0));
        let high = middle + half;
        (low < high).then_some((low, high))
    }

    /// Returns the region of convergence in the plane of W2 and W3 for `kappa` (figure 2 of the paper): its edges at
    /// the given W2 (`elastic`).
    pub fn region(&self, kappa: f64, elastic: &[f64]) -> Vec<RegionEdge> {
        let [w1, _, w3] = self.weights;
        let value_at =
            |&w2: &f64| RegionEdge { elastic: w2, next: Self { weights: [w1, w2, w3], ..*self }.edge(kappa) };
        elastic.iter().map(value_at).collect()
    }

    /// Returns the area of the region of convergence in the plane of W2 and W3 for `kappa`.
    pub fn area(&self, kappa: f64) -> f64 {
        let (_, b) = self.recurrence();
        // The strips cover all W2 with |a0| < 1.
        let (from, width) = (1.0 - self.weights[0] - 1.0 / b, 2.0 / (b * f64::from(STRIPS)));
        let middles: Vec<f64> = (0..STRIPS).map(|i| from + width * (f64::from(i) + 0.5)).collect();
        let heights = self.region(kappa, &middles);
        let heights = heights.iter().filter_map(|edge| edge.next).map(|(low, high)| high - low);
        // The sum of an empty iterator is -0.
        width * (0.0 + heights.sum::<f64>())
    }
}
