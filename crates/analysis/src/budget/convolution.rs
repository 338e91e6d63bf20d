//! Distribution of a mixture of sums of an offset, sines of random phase and a Gaussian number.

use std::f64::consts::PI;

use flexsc_numerics::phasor::polar;

use super::{bisect, gaussian};

/// Standard deviations beyond which a Gaussian number is left out: its probability is below the rounding of a double.
const FARTHEST: f64 = 9.0;
/// Smallest standard deviation, relative to the largest value, with which the series is summed: a smaller one changes no level
/// by more than a part of it.
const SMALLEST: f64 = 1e-5;
/// Smallest standard deviation for each sum of a mixture, relative to the largest value: it bounds the terms of all.
const SMALLEST_SHARE: f64 = 2.5e-7;
/// Negative exponent of a factor below the rounding of a double.
const VANISHING: f64 = 37.0;

/// Number of rotations after which phasors are computed anew, before their rounding errors grow.
const RESTART: usize = 64;

/// Sum of independent parts, which occurs with a probability.
#[derive(Clone, Debug, PartialEq)]
pub struct Sum {
    /// Probability of the sum.
    pub weight: f64,
    /// Constant.
    pub offset: f64,
    /// Amplitudes of the sines.
    pub sines: Vec<f64>,
    /// Standard deviation of the Gaussian part.
    pub noise: f64,
}

/// Mixture of sums, and the Fourier series of the density of its magnitude.
#[derive(Clone, Debug)]
pub struct Mixture {
    sums: Vec<Sum>,
    /// Half of the series' period, in which the density vanishes at the ends.
    half: f64,
    /// Real parts of the characteristic function.
    coefficients: Vec<f64>,
}

impl Sum {
    /// Returns the largest magnitude; of a Gaussian part, that which is practically never exceeded.
    fn largest(&self) -> f64 {
        self.offset.abs() + self.sines.iter().sum::<f64>() + FARTHEST * self.noise
    }
}

impl Mixture {
    /// Creates a mixture of sums, whose weights add up to 1.
    pub(super) fn new(sums: impl Iterator<Item = Sum>) -> Self {
        let mut all: Vec<Sum> = Vec::new();
        for own in sums {
            match all.last_mut() {
                Some(last) if Sum { weight: last.weight, ..own.clone() } == *last => {
                    last.weight += own.weight;
                }
                _ => all.push(own),
            }
        }
        let largest = all.iter().map(Sum::largest).fold(0.0, f64::max);
        let (half, coefficients) = series(&all, largest.max(f64::MIN_POSITIVE));
        Self { sums: all, half, coefficients }
    }

    /// Returns the level of the magnitude at a probability.
    pub fn level(&self, probability: f64) -> f64 {
        let largest = self.sums.iter().map(Sum::largest).fold(0.0, f64::max);
        if largest == 0.0 || probability >= 1.0 {
            return largest;
        }
        if let [Sum { offset, sines, noise, .. }] = &self.sums[..] {
            match (*offset == 0.0, &sines[..], *noise > 0.0) {
                (true, [amplitude], false) => return amplitude * libm::sin(0.5 * PI * probability),
                (true, [], true) => return noise * gaussian(probability),
                (false, [], false) => return offset.abs(),
                _ => {}
            }
        }
        bisect(probability, largest, |most| self.probability(most))
    }

    /// Returns the probability that the magnitude is at most `most`.
    pub fn probability(&self, most: f64) -> f64 {
        let angle = PI / self.half * most;
        // Rotations in place of sines, of which a series has half a million.
        let turn = polar(1.0, angle);
        let mut sum = 0.0;
        for (chunk, coefficients) in self.coefficients.chunks(RESTART).enumerate() {
            let first = chunk * RESTART + 1;
            let mut point = polar(1.0, angle * first as f64);
            for (index, coefficient) in coefficients.iter().enumerate() {
                sum += coefficient * point.im / (first + index) as f64;
                point *= turn;
            }
        }
        (most / self.half + 2.0 * sum / PI).clamp(0.0, 1.0)
    }
}

/// Returns half of the period and the coefficients of the Fourier series of sums whose magnitudes are at most `largest`.
fn series(sums: &[Sum], largest: f64) -> (f64, Vec<f64>) {
    let smallest = SMALLEST.max(SMALLEST_SHARE * sums.len() as f64) * largest;
    let half = 2.0 * (largest + FARTHEST * smallest);
    let step = PI / half;
    let noise = |sum: &Sum| sum.noise.max(smallest);
    let count = |noise: f64| (f64::sqrt(2.0 * VANISHING) / (noise * step)) as usize + 1;
    let most = sums.iter().map(|sum| count(noise(sum))).max().unwrap_or(0);
    let mut coefficients = vec![0.0; most];
    for sum in sums {
        let noise = noise(sum);
        for (index, coefficient) in coefficients[..count(noise)].iter_mut().enumerate() {
            let t = step * (index + 1) as f64;
            let wave: f64 = sum.sines.iter().map(|amplitude| libm::j0(amplitude * t)).product();
            let damped = sum.weight * libm::exp(-0.5 * noise * noise * t * t);
            *coefficient += damped * wave * libm::cos(sum.offset * t);
        }
    }
    (half, coefficients)
}
