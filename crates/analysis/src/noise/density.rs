//! Power spectral density of outputs at the samples of the law, and the cumulative rms.
//!
//! For one sample in a period, the one-sided density is 2 T |c (z - a)^-1 g + d|² with z = exp(2 pi i f T), up to the
//! Nyquist frequency 1/(2 T). For several samples, each with a row of its own, it is the mean density of the sequence of
//! all samples. Its integral over frequency is the mean variance at the samples.

use std::f64::consts::{PI, TAU};

use nalgebra::{Complex, DMatrix};

use super::noisy_loop::NoisyLoop;
use crate::margins::frequency_response::unit_circle;
use crate::margins::{FrequencyResponse, frequency_grid};
use crate::open_loop::TransferMatrices;

/// Densities of one output.
#[derive(Clone, Debug, PartialEq)]
pub struct OutputDensity {
    /// One-sided density from each source (unit² per Hz), at each frequency.
    pub by_source: Vec<Vec<f64>>,
    /// Sum over the sources, at each frequency.
    pub total: Vec<f64>,
}

impl NoisyLoop {
    /// Returns frequencies (Hz) from far below the slowest motion to the Nyquist frequency of the law, which follow the
    /// resonances of the loop.
    pub fn frequency_grid(&self) -> Vec<f64> {
        let per_angle = 1.0 / (TAU * self.sample_period());
        frequency_grid(&self.sample_poles(), &[]).into_iter().map(|angle| angle * per_angle).collect()
    }

    /// Returns the Nyquist frequency of the law (Hz).
    pub fn nyquist(&self) -> f64 {
        0.5 / self.sample_period()
    }

    /// Computes the densities of outputs at frequencies (Hz) up to the Nyquist frequency.
    pub fn densities(&self, outputs: &[usize], frequencies: &[f64]) -> Vec<OutputDensity> {
        let (order, step) = (self.a.nrows(), self.sample_period());
        let at = |sample: usize| self.motion.rows_at_ticks(outputs, self.step * sample as i64);
        let rows: Vec<DMatrix<f64>> = (0..self.samples).map(at).collect();
        // The transposed system has a right-hand side for each output instead of one for each draw.
        let transposed = TransferMatrices {
            a: self.a.transpose(),
            b: DMatrix::zeros(order, 0),
            c: DMatrix::zeros(0, order),
            d: DMatrix::zeros(0, 0),
        };
        let response = FrequencyResponse::new(&transposed);
        let empty = OutputDensity { by_source: vec![Vec::new(); self.sources.len()], total: Vec::new() };
        let mut found = vec![empty; outputs.len()];
        for frequency in frequencies {
            let angle = (TAU * frequency * step).min(PI);
            let mut row = DMatrix::<Complex<f64>>::zeros(outputs.len(), order + self.drawn_by.len());
            for (sample, rows) in rows.iter().enumerate() {
                let turn = unit_circle(-angle * sample as f64);
                row.zip_apply(rows, |sum, value| *sum += turn * value);
            }
            let z = unit_circle(angle * self.samples as f64);
            let state = row.columns(0, order).transpose();
            // At a pole on the unit circle, which no noise excites, there is no response.
            let across = response.states(z, &state).unwrap_or_else(|| DMatrix::zeros(order, outputs.len()));
            let scale = 2.0 * step / self.samples as f64;
            for (output, density) in found.iter_mut().enumerate() {
                let mut sums = vec![0.0; self.sources.len()];
                for (draw, source) in self.drawn_by.iter().enumerate() {
                    let through: Complex<f64> =
                        (0..order).map(|k| across[(k, output)] * self.g[(k, draw)]).sum();
                    sums[*source] += scale * (through + row[(output, order + draw)]).norm_sqr();
                }
                density.total.push(sums.iter().sum());
                for (list, sum) in density.by_source.iter_mut().zip(sums) {
                    list.push(sum);
                }
            }
        }
        found
    }
}

/// Returns the rms up to each of some frequencies (Hz), by the trapezoidal rule over a density; below the first frequency
/// the density counts as constant.
pub fn cumulative_rms(frequencies: &[f64], density: &[f64]) -> Vec<f64> {
    let Some((first, start)) = frequencies.first().zip(density.first()) else { return Vec::new() };
    let mut sum = first * start;
    let mut found = vec![f64::sqrt(sum)];
    for (f, s) in frequencies.windows(2).zip(density.windows(2)) {
        sum += 0.5 * (f[1] - f[0]) * (s[0] + s[1]);
        found.push(f64::sqrt(sum));
    }
    found
}
