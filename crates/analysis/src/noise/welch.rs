//! Welch's estimate of a density: its expectation for a loop, and its spread.
//!
//! Segments of `length` samples overlap by half, have Hann's window and are freed of their mean. An estimate at a peak is
//! low if a bin is wide: the bandwidth is 1.5 bins, and should be below a quarter of the width of the peak \[Welch67\].

use std::f64::consts::{PI, TAU};

use super::noisy_loop::NoisyLoop;

/// Bandwidth of Hann's window, in bins.
const BANDWIDTH: f64 = 1.5;
/// Part of a peak's width that the bandwidth should be below.
const PART: f64 = 0.25;

/// Resonance of a loop, and the segments that resolve it.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct NarrowestPeak {
    /// Frequency (Hz).
    pub frequency: f64,
    /// Width at half of its height (Hz).
    pub width: f64,
    /// Number of samples of a segment from which on the bandwidth is below a quarter of the width.
    pub segment: f64,
}

impl NoisyLoop {
    /// Returns the expectation of Welch's one-sided density of an output at some frequencies (Hz), from segments of
    /// `length` samples of the law.
    pub fn welch_expectation(&self, output: usize, length: usize, frequencies: &[f64]) -> Vec<f64> {
        let step = self.sample_period();
        let covariance = self.autocovariance(output, length - 1);
        let weighted: Vec<f64> = covariance
            .iter()
            .enumerate()
            .map(|(lag, value)| value * window_correlation(length, lag))
            .collect();
        let power = window_correlation(length, 0);
        let at = |frequency: &f64| {
            let angle = TAU * frequency * step;
            let beyond = weighted.iter().enumerate().skip(1);
            let sum: f64 = beyond.map(|(lag, value)| 2.0 * value * libm::cos(angle * lag as f64)).sum();
            2.0 * step * (weighted[0] + sum) / power
        };
        frequencies.iter().map(at).collect()
    }

    /// Returns the resonance of the loop with the narrowest peak; none without one below the Nyquist frequency.
    pub fn narrowest_peak(&self) -> Option<NarrowestPeak> {
        let step = self.sample_period();
        let peaks = self.sample_poles().into_iter().filter_map(|pole| {
            let (angle, decay) = (libm::atan2(pole.im, pole.re), -libm::log(libm::hypot(pole.re, pole.im)));
            // Half of the height is a decay from the peak on either side.
            (decay > 0.0 && decay < 0.3 * angle && angle < PI).then(|| NarrowestPeak {
                frequency: angle / (TAU * step),
                width: decay / (PI * step),
                segment: BANDWIDTH * PI / (PART * decay),
            })
        });
        peaks.min_by(|a, b| a.width.total_cmp(&b.width))
    }
}

/// Returns the sum of the products of Hann's window 1/2 - 1/2 cos(2 pi n/L) and itself, `lag` samples later.
fn window_correlation(length: usize, lag: usize) -> f64 {
    let (turn, count) = (TAU / length as f64, (length - lag) as f64);
    // Sum of cos(a + n turn m) over the samples of both.
    let cosines = |start: f64, multiple: f64| {
        let half = 0.5 * multiple * turn;
        libm::sin(half * count) / libm::sin(half) * libm::cos(start + half * (count - 1.0))
    };
    let shift = turn * lag as f64;
    let product = 0.5 * (count * libm::cos(shift) + cosines(shift, 2.0));
    0.25 * (count - cosines(0.0, 1.0) - cosines(shift, 1.0) + product)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_correlation_of_the_window_is_its_sum() {
        let length = 12_usize;
        let window = |n: usize| 0.5 - 0.5 * libm::cos(TAU * n as f64 / length as f64);
        for lag in [0, 1, 5, 11] {
            let exact: f64 = (0..length - lag).map(|n| window(n) * window(n + lag)).sum();
            assert!((window_correlation(length, lag) - exact).abs() < 1e-13, "{lag}");
        }
    }
}
