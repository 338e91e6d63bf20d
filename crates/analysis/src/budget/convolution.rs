//! Distribution of a sum of an offset, uniform numbers, sines of random phase and a Gaussian number.

use std::f64::consts::PI;

use flexsc_numerics::phasor::polar;

use super::{bisect, gaussian};

/// Standard deviations beyond which a Gaussian number is left out: its probability is below the rounding of a double.
const FARTHEST: f64 = 9.0;
/// Smallest standard deviation, relative to the largest value, with which the series is summed: a smaller one changes no level
/// by more than a part of it.
const SMALLEST: f64 = 1e-5;

/// Number of rotations after which phasors are computed anew, before their rounding errors grow.
const RESTART: usize = 64;

/// Sum of independent parts.
#[derive(Clone, Debug, PartialEq)]
pub struct Sum {
    /// Constant.
    pub offset: f64,
    /// Half widths of the uniform parts.
    pub uniform: Vec<f64>,
    /// Amplitudes of the sines.
    pub sines: Vec<f64>,
    /// Standard deviation of the Gaussian part.
    pub noise: f64,
}

impl Sum {
    /// Returns the standard deviation of all parts but the offset.
    pub fn deviation(&self) -> f64 {
        let squares = |parts: &[f64]| parts.iter().map(|part| part * part).sum::<f64>();
        f64::sqrt(squares(&self.uniform) / 3.0 + squares(&self.sines) / 2.0 + self.noise * self.noise)
    }

    /// Returns the largest magnitude; of a Gaussian part, that which is practically never exceeded.
    fn largest(&self) -> f64 {
        let all = self.uniform.iter().chain(&self.sines).sum::<f64>();
        self.offset.abs() + all + FARTHEST * self.noise
    }

    /// Returns the probability that the magnitude is at most `most`.
    pub fn probability(&self, most: f64) -> f64 {
        self.series().probability(self.offset, most)
    }

    /// Returns the level of the magnitude at a probability.
    pub fn level(&self, probability: f64) -> f64 {
        let largest = self.largest();
        if largest == 0.0 || probability >= 1.0 {
            return largest;
        }
        match (self.offset == 0.0, &self.uniform[..], &self.sines[..], self.noise > 0.0) {
            (true, [half], [], false) => return half * probability,
            (true, [], [amplitude], false) => return amplitude * libm::sin(0.5 * PI * probability),
            (true, [], [], true) => return self.noise * gaussian(probability),
            (false, [], [], false) => return self.offset.abs(),
            _ => {}
        }
        let series = self.series();
        bisect(probability, largest, |most| series.probability(self.offset, most))
    }

    /// Returns the Fourier series of the density without the offset, of a period in which it vanishes at the ends.
    fn series(&self) -> Series {
        let largest = self.largest().max(f64::MIN_POSITIVE);
        let noise = self.noise.max(SMALLEST * largest);
        // The magnitude of what is compared is at most the largest value plus the offset.
        let half = 2.0 * (largest + FARTHEST * noise);
        let step = PI / half;
        // exp(-37) is below the rounding of a double.
        let count = (f64::sqrt(2.0 * 37.0) / (noise * step)) as usize + 1;
        let coefficient = |index: usize| {
            let t = step * index as f64;
            let uniform = |half: &f64| libm::sin(half * t) / (half * t);
            let flat: f64 = self.uniform.iter().filter(|half| **half > 0.0).map(uniform).product();
            let wave: f64 = self.sines.iter().map(|amplitude| libm::j0(amplitude * t)).product();
            flat * wave * libm::exp(-0.5 * noise * noise * t * t)
        };
        Series { half, coefficients: (1..=count).map(coefficient).collect() }
    }
}

/// Fourier series of a symmetric density.
struct Series {
    /// Half of the period.
    half: f64,
    /// Values of the characteristic function.
    coefficients: Vec<f64>,
}

impl Series {
    /// Returns the probability that the magnitude of the sum with an offset is at most `most`.
    fn probability(&self, offset: f64, most: f64) -> f64 {
        let step = PI / self.half;
        let ends = [most - offset, -most - offset].map(|end| step * end);
        // Rotations in place of sines, of which a series has half a million.
        let turns = ends.map(|angle| polar(1.0, angle));
        let mut sum = 0.0;
        for (chunk, coefficients) in self.coefficients.chunks(RESTART).enumerate() {
            let first = chunk * RESTART + 1;
            let [mut high, mut low] = ends.map(|angle| polar(1.0, angle * first as f64));
            for (index, coefficient) in coefficients.iter().enumerate() {
                sum += coefficient * (high.im - low.im) / (first + index) as f64;
                (high, low) = (high * turns[0], low * turns[1]);
            }
        }
        (most / self.half + sum / PI).clamp(0.0, 1.0)
    }
}
