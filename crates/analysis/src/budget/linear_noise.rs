//! Noise of the pointing indices of a sampled error under the noise of the linear loop, exact from its covariance, and under
//! broadband loads, by the gains of the indices on their lines.

use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::AXES;
use nalgebra::Complex;

use crate::margins::frequency_response::unit_circle;
use crate::noise::{LineLoop, NoisyLoop, OutputSamples, SampleSets, SampleTimes, SpectralLine, Vibration};
use flexsc_scenario::{ErrorAxis, SampledError, SampledQuantity};

/// Largest number of periods of the loop in a window.
const MOST_PERIODS: f64 = 1e6;
/// Largest number of states and draws, over all periods of a window whose places all count.
const MOST_NUMBERS: f64 = 1e8;

/// Returns the rms of the index of an error under the noise of the loop, of the norm if the error has several components;
/// `None` if the loop has no such output, or for a window that is too long for it. A scenario without machines needs no `lines`.
///
/// # Errors
/// See [`Vibration::new`].
pub fn linear_noise(
    noisy: &NoisyLoop,
    lines: Option<&LineLoop<'_>>,
    error: &SampledError,
) -> Result<Option<f64>, ConfigError> {
    let outputs: Vec<usize> = output_names(error).iter().filter_map(|name| noisy.output(name)).collect();
    if outputs.is_empty() {
        return Ok(None);
    }
    let vibration =
        lines.map_or_else(|| Ok(Vibration::default()), |own| index_vibration(own, &outputs, error))?;
    let mean = |output: usize| {
        let each = index_variances((noisy, &vibration), output, error)?;
        Some(each.iter().sum::<f64>() / each.len() as f64)
    };
    Ok(outputs.into_iter().map(mean).sum::<Option<f64>>().map(f64::sqrt))
}

/// Returns the motion of outputs under machines, each of which has the worst frequency for the index of an error.
///
/// # Errors
/// See [`Vibration::new`].
pub(super) fn index_vibration(
    lines: &LineLoop<'_>,
    outputs: &[usize],
    error: &SampledError,
) -> Result<Vibration, ConfigError> {
    let measure = |_: usize, lines: &[SpectralLine]| {
        line_variances(lines.iter(), error).map_or(0.0, |variances| variances.iter().sum())
    };
    Vibration::new(lines, outputs, &measure, &[])
}

/// Returns the names that the outputs of an error may have: about each axis, and of a body with one angle.
pub(super) fn output_names(error: &SampledError) -> Vec<String> {
    let each = [ErrorAxis::X, ErrorAxis::Y, ErrorAxis::Z].into_iter().zip(AXES);
    let chosen = each.filter(|(axis, _)| error.axis.is_none_or(|own| own == *axis));
    let (single, about): (&str, Vec<String>) = match &error.quantity {
        SampledQuantity::PointingError => {
            ("angle", chosen.map(|(_, name)| format!("{name}_error")).collect())
        }
        SampledQuantity::RateError => {
            ("rate", chosen.map(|(_, name)| format!("rigid_{name}_rate")).collect())
        }
        SampledQuantity::LineOfSight(line, _) => {
            let axes = [ErrorAxis::X, ErrorAxis::Y, ErrorAxis::Z].into_iter().zip(["x", "y", "z"]);
            let own = axes.filter(|(axis, _)| error.axis.is_none_or(|own| own == *axis));
            return own.map(|(_, name)| format!("line_of_sight{line}_{name}")).collect();
        }
    };
    about.into_iter().chain([single.to_owned()]).collect()
}

/// Returns the times of the samples of an error, and the first sample of each set whose index may differ from that of others
/// in a loop of a period (fs).
pub(super) fn set_starts(error: &SampledError, period: i64) -> (SampleTimes, Vec<u64>) {
    let times = SampleTimes { first: error.first_sample(), apart: error.period };
    let stride = error.index.places();
    let count = error.index.values(error.samples).div_ceil(stride);
    let starts = times.starts(SampleSets { length: error.index.reach(), stride, count }, period);
    (times, starts)
}

/// Returns the number of values of the index of an error after which its noise repeats, in a loop if there is one.
pub fn noise_cycle(noisy: Option<&NoisyLoop>, error: &SampledError) -> usize {
    let sets = noisy.map_or(1, |noisy| set_starts(error, noisy.period_ticks()).1.len());
    sets * error.index.places() as usize
}

/// Returns the variances of an index of an output: for each set of samples that differs from others, at each place of the
/// index; `None` for a window that is too long for the loop.
pub(super) fn index_variances(
    (noisy, vibration): (&NoisyLoop, &Vibration),
    output: usize,
    error: &SampledError,
) -> Option<Vec<f64>> {
    let periods = error.index.reach() as f64 * error.period.seconds() / noisy.period;
    let is_uniform = error.index.places() > 1;
    if periods > MOST_PERIODS || is_uniform && periods * noisy.size() as f64 > MOST_NUMBERS {
        return None;
    }
    let mut samples = OutputSamples::new(noisy, output);
    let weights = error.index.weights(0);
    let bands = line_variances(vibration.lines(output, true), error)?;
    let (times, starts) = set_starts(error, noisy.period_ticks());
    let of_set = |start: u64| {
        let places: Vec<_> = times.places(start, error.index.reach(), noisy.period_ticks()).collect();
        let mut variances = if is_uniform {
            samples.variances_about_mean(&places)
        } else {
            vec![samples.variance(&places, &weights)]
        };
        variances.iter_mut().zip(&bands).for_each(|(variance, more)| *variance += more);
        variances
    };
    Some(starts.into_iter().flat_map(of_set).collect())
}

/// Returns the variance of an index at each of its places under lines whose phases are unrelated to its samples; `None` for a window
/// with too many of them.
pub(super) fn line_variances<'a>(
    lines: impl Iterator<Item = &'a SpectralLine> + Clone,
    error: &SampledError,
) -> Option<Vec<f64>> {
    let (index, step) = (error.index, error.period.seconds());
    if index.reach() as f64 * lines.clone().count() as f64 > MOST_NUMBERS {
        return None;
    }
    let weights = index.weights(0);
    let mut sums = vec![0.0; index.places() as usize];
    for line in lines {
        let turn = |place: usize| unit_circle(line.frequency_rad_s * step * place as f64);
        let power = line.mean_square();
        if sums.len() == 1 {
            let sum: Complex<f64> =
                weights.iter().enumerate().map(|(place, weight)| turn(place) * *weight).sum();
            sums[0] += power * sum.norm_sqr();
        } else {
            let all: Vec<Complex<f64>> = (0..sums.len()).map(turn).collect();
            let mean = all.iter().sum::<Complex<f64>>() / all.len() as f64;
            sums.iter_mut().zip(all).for_each(|(sum, value)| *sum += power * (value - mean).norm_sqr());
        }
    }
    Some(sums)
}
