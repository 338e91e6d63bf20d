//! Digital filter of second order, in direct form II transposed.

/// Biquad y = b0 x + b1 x1 + b2 x2 - a1 y1 - a2 y2, for the samples x and y now, one and two before.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct BiquadFilter {
    /// Coefficients b0, b1, b2.
    pub numerator: [f64; 3],
    /// Coefficients a1, a2.
    pub denominator: [f64; 2],
    /// State, in the unit of the samples.
    pub state: [f64; 2],
}

impl BiquadFilter {
    /// Filters a sample and returns the output. One that is not finite leaves the state as it was.
    #[inline]
    pub fn filter(&mut self, sample: f64) -> f64 {
        let output: f64 = self.numerator[0] * sample + self.state[0];
        let first: f64 = self.numerator[1] * sample - self.denominator[0] * output + self.state[1];
        let second: f64 = self.numerator[2] * sample - self.denominator[1] * output;
        if first.is_finite() && second.is_finite() {
            self.state[0] = first;
            self.state[1] = second;
        }
        output
    }
}

/// Filters a sample by several filters, in their order, and returns the output of the last one.
#[inline]
pub fn filter_in_series(filters: &mut [BiquadFilter], sample: f64) -> f64 {
    let mut output: f64 = sample;
    for index in 0..filters.len() {
        output = filters[index].filter(output);
    }
    output
}
