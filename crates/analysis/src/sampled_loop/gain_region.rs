//! Admissible gains of the extra loop over the frequency of the dominant mode (\[Wheel11, Sukhanov\], figure 5).

use rayon::prelude::*;
use serde::Serialize;

use super::{ClosedLoop, DiscretePlant, SampledLoop, SettlingWindow};

/// Modes whose frequencies scale with that of the dominant one.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub enum Scaling {
    /// All modes scale by one ratio.
    #[default]
    All,
    /// The dominant mode alone changes.
    First,
}

/// Equidistant gains.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Gains {
    /// Lowest gain.
    pub low: f64,
    /// Highest gain.
    pub high: f64,
    /// Step from one gain to the next.
    pub step: f64,
}

impl Gains {
    /// Returns the gains, the lowest first.
    pub fn values(&self) -> Vec<f64> {
        let count = libm::floor((self.high - self.low) / self.step + 1e-9) as usize + 1;
        (0..count).map(|index| self.low + index as f64 * self.step).collect()
    }
}

/// Admissible gains at one frequency of the dominant mode: the longest interval of them without a gap.
#[derive(Copy, Clone, Debug, PartialEq, Serialize)]
pub struct GainRegion {
    /// Frequency of the dominant mode (rad/s).
    pub frequency_rad_s: f64,
    /// Lowest and highest gain of the interval; none if no gain is admissible.
    pub gain: Option<(f64, f64)>,
    /// Midpoint of the interval: k_d of equations (10) and (12).
    pub midpoint: Option<f64>,
    /// Settling time with the gain `midpoint` (s).
    pub settling_s: Option<f64>,
    /// Spectral radius with the gain `midpoint`.
    pub spectral_radius: Option<f64>,
    /// Settling time without the extra loop (s).
    pub settling_without_s: Option<f64>,
    /// Spectral radius without the extra loop.
    pub spectral_radius_without: f64,
}

/// Returns true if a loop is stable and settles in time: an angle may stay small while a mode grows.
fn does(closed: &ClosedLoop, window: SettlingWindow, limit: f64) -> bool {
    closed.settle(window).time_s.is_some_and(|time| time <= limit) && closed.spectral_radius() < 1.0
}

/// First and last gain of an interval, and the number of gains in it.
type GainInterval = (f64, f64, usize);

/// Returns the admissible gains at one frequency (rad/s): the loop is stable, and its settling time is at most the
/// limit (s).
pub fn region(
    sampled_loop: &SampledLoop,
    frequency: f64,
    scaling: Scaling,
    gains: Gains,
    window: SettlingWindow,
    limit: f64,
) -> GainRegion {
    let held = DiscretePlant::new(sampled_loop, &sampled_loop.ratios(frequency, scaling));
    let (mut best, mut run): (Option<GainInterval>, Option<GainInterval>) = (None, None);
    for gain in gains.values() {
        run = does(&held.closed(gain), window, limit)
            .then(|| run.map_or((gain, gain, 1), |(first, _, count)| (first, gain, count + 1)));
        if run.map_or(0, |run| run.2) > best.map_or(0, |best| best.2) {
            best = run;
        }
    }
    let midpoint = best.map(|(low, high, _)| 0.5 * (low + high));
    let middle = midpoint.map(|gain| held.closed(gain));
    let without = held.closed(0.0);
    GainRegion {
        frequency_rad_s: frequency,
        gain: best.map(|(low, high, _)| (low, high)),
        midpoint,
        settling_s: middle.as_ref().and_then(|closed| closed.settle(window).time_s),
        spectral_radius: middle.as_ref().map(ClosedLoop::spectral_radius),
        settling_without_s: without.settle(window).time_s,
        spectral_radius_without: without.spectral_radius(),
    }
}

/// Returns the admissible gains at each of these frequencies (rad/s) in order, computed on the threads of the current
/// rayon pool.
pub fn regions(
    sampled_loop: &SampledLoop,
    frequencies: &[f64],
    scaling: Scaling,
    gains: Gains,
    window: SettlingWindow,
    limit: f64,
) -> Vec<GainRegion> {
    frequencies.par_iter().map(|w| region(sampled_loop, *w, scaling, gains, window, limit)).collect()
}

/// Returns the schedule of the midpoints: frequencies (rad/s) and gains, where there are any.
pub fn midpoints(regions: &[GainRegion]) -> Vec<(f64, f64)> {
    regions.iter().filter_map(|region| Some((region.frequency_rad_s, region.midpoint?))).collect()
}
