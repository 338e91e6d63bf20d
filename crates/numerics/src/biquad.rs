//! Design of digital filters of second order.

use flexsc_flight::biquad::BiquadFilter;

/// Biquad y = b0 x + b1 x1 + b2 x2 - a1 y1 - a2 y2, for the samples x and y now, one and two before, in direct form
/// II transposed.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Biquad(BiquadFilter);

impl Biquad {
    /// Creates the filter with b0, b1, b2 and a1, a2, at rest.
    pub fn new(numerator: [f64; 3], denominator: [f64; 2]) -> Self {
        Self(BiquadFilter { numerator, denominator, state: [0.0; 2] })
    }

    /// Discretises (n0 + n1 s + n2 s²)/(d0 + d1 s + d2 s²) with a sample period (s): s = K (z - 1)/(z + 1), with the
    /// K at which both have the same gain and phase at a frequency below pi/period (rad/s).
    pub fn tustin(numerator: [f64; 3], denominator: [f64; 3], frequency: f64, period: f64) -> Self {
        let k = frequency / libm::tan(0.5 * frequency * period);
        let polynomial = |[c0, c1, c2]: [f64; 3]| {
            let (first, second) = (c1 * k, c2 * k * k);
            [second + first + c0, 2.0 * (c0 - second), second - first + c0]
        };
        let (b, [a0, a1, a2]) = (polynomial(numerator), polynomial(denominator));
        Self::new(b.map(|b| b / a0), [a1 / a0, a2 / a0])
    }

    /// Returns b0, b1, b2 and a1, a2.
    pub fn coefficients(&self) -> ([f64; 3], [f64; 2]) {
        (self.0.numerator, self.0.denominator)
    }

    /// Returns true if the filter is stable.
    pub fn is_stable(&self) -> bool {
        let [a1, a2] = self.0.denominator;
        a2.abs() < 1.0 && a1.abs() < 1.0 + a2
    }

    /// Returns the filter at run time, as flight code has it.
    pub fn flight(&self) -> BiquadFilter {
        self.0
    }

    /// Filters a sample and returns the output.
    pub fn filter(&mut self, sample: f64) -> f64 {
        self.0.filter(sample)
    }

    /// Returns gain and phase (rad) at a frequency (rad/s), for a sample period (s).
    pub fn response(&self, frequency: f64, period: f64) -> [f64; 2] {
        let (sin, cos) = libm::sincos(frequency * period);
        // Here z^-1 = cos - i sin, z^-2 = z^-1 squared.
        let polynomial = |[c0, c1, c2]: [f64; 3]| {
            [c0 + c1 * cos + c2 * (cos * cos - sin * sin), -c1 * sin - c2 * 2.0 * sin * cos]
        };
        let ([nr, ni], [dr, di]) =
            (polynomial(self.0.numerator), polynomial([1.0, self.0.denominator[0], self.0.denominator[1]]));
        let phase = libm::atan2(ni * dr - nr * di, nr * dr + ni * di);
        [libm::hypot(nr, ni) / libm::hypot(dr, di), phase]
    }
}
