//! Map of stability and settling over the frequency of the dominant mode and the sampling period.

use rayon::prelude::*;
use serde::Serialize;

use super::{ClosedLoop, DiscretePlant, SampledLoop, Scaling, SettlingWindow};

/// Cell of the map.
#[derive(Copy, Clone, Debug, PartialEq, Serialize)]
pub struct MapCell {
    /// Frequency of the dominant mode (rad/s).
    pub frequency_rad_s: f64,
    /// Sampling period (s).
    pub period_s: f64,
    /// Spectral radius: the loop is stable below 1.
    pub spectral_radius: f64,
    /// Settling time (s); none if the angle does not settle within the horizon.
    pub settling_s: Option<f64>,
    /// Integral of time times |angle| (rad s²).
    pub itae_rad_s2: f64,
}

/// Returns the map with a gain of the extra loop that may depend on the frequency: a row for each frequency (rad/s),
/// within it the periods (s). Rows are computed on the threads of the current rayon pool. A delay of the loop scales
/// with the period, so that a delay of one sample stays one.
pub fn map(
    sampled_loop: &SampledLoop,
    frequencies: &[f64],
    periods: &[f64],
    scaling: Scaling,
    gain: impl Fn(f64) -> f64 + Sync,
    window: SettlingWindow,
) -> Vec<MapCell> {
    evaluate(sampled_loop, frequencies, periods, scaling, gain, |frequency_rad_s, period_s, closed| {
        let settling = closed.settle(window);
        MapCell {
            frequency_rad_s,
            period_s,
            spectral_radius: closed.spectral_radius(),
            settling_s: settling.time_s,
            itae_rad_s2: settling.itae_rad_s2,
        }
    })
}

/// Returns the spectral radii of a map, in the order of its cells.
pub fn spectral_radii(
    of: &SampledLoop,
    frequencies: &[f64],
    periods: &[f64],
    scaling: Scaling,
    gain: impl Fn(f64) -> f64 + Sync,
) -> Vec<f64> {
    evaluate(of, frequencies, periods, scaling, gain, |_, _, closed| closed.spectral_radius())
}

/// Evaluates the closed loop at each frequency and period.
fn evaluate<T: Send>(
    of: &SampledLoop,
    frequencies: &[f64],
    periods: &[f64],
    scaling: Scaling,
    gain: impl Fn(f64) -> f64 + Sync,
    value: impl Fn(f64, f64, &ClosedLoop) -> T + Sync,
) -> Vec<T> {
    let row = |frequency: &f64| -> Vec<T> {
        let ratios = of.ratios(*frequency, scaling);
        let mut changed = of.clone();
        let cell = |period: &f64| {
            (changed.period, changed.delay) = (*period, of.delay / of.period * period);
            let closed = DiscretePlant::new(&changed, &ratios).closed(gain(*frequency));
            value(*frequency, *period, &closed)
        };
        periods.iter().map(cell).collect()
    };
    let rows: Vec<Vec<T>> = frequencies.par_iter().map(row).collect();
    rows.into_iter().flatten().collect()
}
