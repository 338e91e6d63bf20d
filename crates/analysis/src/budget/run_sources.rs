//! Sources of a pointing index that the runs of a campaign show: the bias of each run, its sines of given frequencies, and a
//! random part.

use std::f64::consts::{PI, TAU};

use nalgebra::{Complex, DMatrix, DVector};

use super::{ErrorSources, SourceCombination};
use crate::margins::frequency_response::{modulus, unit_circle};

/// Bias, relative to the random part, that is rounding.
const ROUNDING: f64 = 1e-9;
/// Largest number of combinations of groups of runs and groups of places.
const MOST_COMBINATIONS: usize = 8192;
/// Smallest number of values of all runs at a group of places, and the largest number of such groups.
const VALUES_AT_PLACES: usize = 400;
const PLACE_GROUPS: usize = 64;

/// Two standard deviations of the quotient of two variances of variances, times the root of the number of runs, where a run
/// has some ten independent values.
const SAMPLING_ERROR: f64 = 5.0;

/// Values of an index in one run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct IndexRun {
    /// Values in the order of time.
    pub values: Vec<f64>,
    /// Frequencies of the sines that act in the run (rad/s).
    pub frequencies: Vec<f64>,
}

/// Times at which an index has its values.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct ValueTimes {
    /// Sampling period (s).
    pub period: f64,
    /// Number of values of each window, less the mean of which they are; 1 for a window that slides.
    pub window: usize,
    /// Number of values after which the random part repeats.
    pub cycle: usize,
}

/// Fit of a run: bias, amplitudes, and what remains.
struct RunFit {
    bias: f64,
    /// Amplitude of each sine before the mean of its window is taken off; 0 of one that the run does not show.
    amplitudes: Vec<f64>,
    /// Factors on the amplitudes at each place of a window.
    factors: Vec<Vec<f64>>,
    residual: Vec<f64>,
    /// Variance of the random part.
    variance: f64,
}

/// Returns the sources that runs show.
pub fn fit_sources(runs: &[IndexRun], times: ValueTimes) -> ErrorSources {
    let mut fits: Vec<RunFit> = runs.iter().map(|run| RunFit::new(run, times)).collect();
    shrink(&mut fits);
    let total = fits.iter().map(|fit| fit.residual.len()).sum::<usize>();
    let groups = (total / VALUES_AT_PLACES).clamp(1, PLACE_GROUPS).min(times.cycle);
    let shares = place_shares(&fits, times, groups);
    let mut combinations = Vec::new();
    for runs in alike_runs(fits, MOST_COMBINATIONS / groups) {
        let count = runs.len() as f64;
        let mean = |value: &dyn Fn(&RunFit) -> f64| runs.iter().map(value).sum::<f64>() / count;
        let bias = mean(&|fit| fit.bias);
        let spread = mean(&|fit| (fit.bias - bias) * (fit.bias - bias));
        let variance = mean(&|fit| fit.variance);
        let sines = runs.first().map_or(0, |fit| fit.amplitudes.len());
        for (group, share) in shares.iter().enumerate() {
            let square = |fit: &RunFit, sine: usize| {
                fit.amplitudes[sine]
                    * fit.amplitudes[sine]
                    * mean_square(&fit.factors[sine], times.cycle, (group, groups))
            };
            let amplitude = |sine: usize| f64::sqrt(mean(&|fit| square(fit, sine)));
            combinations.push(SourceCombination {
                weight: count * share.weight,
                bias,
                amplitudes: (0..sines).map(amplitude).collect(),
                noise: f64::sqrt(spread + share.variance * variance),
            });
        }
    }
    // The mean of a uniform relative error is 0 but for rounding.
    let sources = ErrorSources::new(combinations);
    if sources.largest_bias() >= ROUNDING * sources.noise() {
        return sources;
    }
    let unbiased = |own: SourceCombination| SourceCombination { bias: 0.0, ..own };
    ErrorSources { combinations: sources.combinations.into_iter().map(unbiased).collect() }
}

/// Part of the values at a group of places, and the variance there relative to that of all.
struct PlaceShare {
    weight: f64,
    variance: f64,
}

/// Returns the group of a place of a cycle.
fn group_of(place: usize, cycle: usize, groups: usize) -> usize {
    place * groups / cycle
}

/// Returns the mean square of the factors on a sine at the places of a cycle that are in one of some groups.
fn mean_square(factors: &[f64], cycle: usize, (group, groups): (usize, usize)) -> f64 {
    let own = (0..cycle).filter(|place| group_of(*place, cycle, groups) == group);
    let factor = |place: usize| factors[place % factors.len()];
    let (count, sum) =
        own.fold((0.0, 0.0), |(count, sum), place| (count + 1.0, sum + factor(place) * factor(place)));
    sum / count
}

/// Returns the parts of groups of places.
fn place_shares(fits: &[RunFit], times: ValueTimes, groups: usize) -> Vec<PlaceShare> {
    let mut sums = vec![(0.0, 0.0); groups];
    for fit in fits {
        for (index, value) in fit.residual.iter().enumerate() {
            let sum = &mut sums[group_of(index % times.cycle, times.cycle, groups)];
            *sum = (sum.0 + 1.0, sum.1 + value * value);
        }
    }
    let (count, square) =
        sums.iter().fold((0.0, 0.0), |(count, square), own| (count + own.0, square + own.1));
    let share = |(own, own_square): &(f64, f64)| PlaceShare {
        weight: own / count,
        variance: if square > 0.0 && *own > 0.0 { own_square / own / (square / count) } else { 1.0 },
    };
    sums.iter().map(share).collect()
}

/// Moves the variances of the runs towards their mean, by the part of their differences that the differences of the halves of
/// runs explain, with its sampling error.
fn shrink(fits: &mut [RunFit]) {
    let count = fits.len() as f64;
    let mean = fits.iter().map(|fit| fit.variance).sum::<f64>() / count;
    let spread = fits.iter().map(|fit| (fit.variance - mean) * (fit.variance - mean)).sum::<f64>() / count;
    let within = |fit: &RunFit| {
        let (first, second) = fit.residual.split_at(fit.residual.len() / 2);
        let square = |values: &[f64]| values.iter().map(|v| v * v).sum::<f64>() / values.len().max(1) as f64;
        let difference = square(first) - square(second);
        0.25 * difference * difference
    };
    let sampling_error = SAMPLING_ERROR / f64::sqrt(count);
    let explained = fits.iter().map(within).sum::<f64>() / count * (1.0 + sampling_error);
    let kept = if spread > explained { f64::sqrt(1.0 - explained / spread) } else { 0.0 };
    for fit in fits.iter_mut() {
        fit.variance = mean + kept * (fit.variance - mean);
    }
}

/// Divides runs into at most a number of groups of runs that are alike: in halves, by the source that differs most.
fn alike_runs(mut fits: Vec<RunFit>, groups: usize) -> Vec<Vec<RunFit>> {
    let most = groups.min(fits.len());
    if most <= 1 {
        return vec![fits];
    }
    let sines = fits.first().map_or(0, |fit| fit.amplitudes.len());
    let spread = |source: usize| {
        let count = fits.len() as f64;
        let mean = fits.iter().map(|fit| fit.source(source)).sum::<f64>() / count;
        fits.iter().map(|fit| (fit.source(source) - mean) * (fit.source(source) - mean)).sum::<f64>()
    };
    let spreads: Vec<f64> = (0..2 + sines).map(spread).collect();
    let source = (0..spreads.len()).max_by(|a, b| spreads[*a].total_cmp(&spreads[*b])).unwrap_or(0);
    fits.sort_by(|a, b| a.source(source).total_cmp(&b.source(source)));
    let rest = fits.split_off(fits.len() * (most / 2) / most);
    let mut found = alike_runs(fits, most / 2);
    found.extend(alike_runs(rest, most - most / 2));
    found
}

impl RunFit {
    /// Returns the size of a source: the bias, the random part, then each sine.
    fn source(&self, index: usize) -> f64 {
        match index {
            0 => self.bias,
            1 => f64::sqrt(self.variance),
            sine => self.amplitudes[sine - 2],
        }
    }

    /// Fits a bias and sines to the values of a run by least squares.
    fn new(run: &IndexRun, times: ValueTimes) -> Self {
        let count = run.values.len();
        // A run shows a sine that it, and the difference from others, goes through once.
        let folded = |frequency: f64| {
            let angle = (frequency * times.period) % TAU;
            angle.min(TAU - angle)
        };
        let angles: Vec<f64> = run.frequencies.iter().map(|frequency| folded(*frequency)).collect();
        let least = TAU / count as f64;
        let is_shown = |sine: usize| {
            let apart = |other: usize| other == sine || (angles[other] - angles[sine]).abs() >= least;
            angles[sine] >= least && PI - angles[sine] >= least && (0..angles.len()).all(apart)
        };
        let shown: Vec<usize> = (0..angles.len()).filter(|sine| is_shown(*sine)).collect();
        let factors: Vec<Vec<Complex<f64>>> =
            angles.iter().map(|angle| window_factors(*angle, times.window)).collect();
        // Columns: the bias, then cosine and sine of each sine, as an index has them.
        let row = |index: usize| {
            let (window, place) = (index / times.window, index % times.window);
            let mut row = DVector::from_element(1 + 2 * shown.len(), 1.0);
            for (column, sine) in shown.iter().enumerate() {
                let turn = unit_circle(angles[*sine] * (window * times.window) as f64);
                let value = turn * factors[*sine][place];
                (row[1 + 2 * column], row[2 + 2 * column]) = (value.re, -value.im);
            }
            row
        };
        let size = 1 + 2 * shown.len();
        let (mut normal, mut right) = (DMatrix::zeros(size, size), DVector::zeros(size));
        for (index, value) in run.values.iter().enumerate() {
            let row = row(index);
            normal.ger(1.0, &row, &row, 1.0);
            right.axpy(*value, &row, 1.0);
        }
        let fit = normal.cholesky().map_or_else(|| DVector::zeros(size), |factors| factors.solve(&right));
        let residual: Vec<f64> =
            run.values.iter().enumerate().map(|(index, value)| value - row(index).dot(&fit)).collect();
        let mut amplitudes = vec![0.0; angles.len()];
        for (column, sine) in shown.iter().enumerate() {
            amplitudes[*sine] = libm::hypot(fit[1 + 2 * column], fit[2 + 2 * column]);
        }
        Self {
            bias: fit[0],
            amplitudes,
            factors: factors.iter().map(|own| own.iter().map(|factor| modulus(*factor)).collect()).collect(),
            variance: residual.iter().map(|value| value * value).sum::<f64>() / count.max(1) as f64,
            residual,
        }
    }
}

/// Returns the values of exp(j angle k) at the places of a window, less their mean; 1 for a window of one place.
fn window_factors(angle: f64, window: usize) -> Vec<Complex<f64>> {
    let all: Vec<Complex<f64>> = (0..window).map(|place| unit_circle(angle * place as f64)).collect();
    if window == 1 {
        return all;
    }
    let mean = all.iter().sum::<Complex<f64>>() / window as f64;
    all.into_iter().map(|value| value - mean).collect()
}
