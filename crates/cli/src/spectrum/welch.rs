//! Welch's estimate of the density of a column of a log, beside the exact one.
//!
//! Segments overlap by half, are freed of their mean, and have Hann's window \[Welch67\]. With an overlap of a half, K
//! segments have the spread of K/(1 + (K - 1)/(18 K)) that do not overlap.

use std::path::Path;

use flexsc_core::analysis::noise::NoisyLoop;
use flexsc_core::numerics::normal::quantile;
use flexsc_core::record::Log;
use rustfft::FftPlanner;
use rustfft::num_complex::Complex;
use serde::Serialize;

use crate::error::CliError;

/// Probability of the interval of an estimate.
const PROBABILITY: f64 = 0.9;
/// Segments that the default length gives at least, without overlap.
const SEGMENTS: usize = 8;
/// Smallest number of samples of a segment.
const SHORTEST: usize = 16;
/// Largest number of samples of a segment for which the expectation of an estimate is computed.
const EXPECTED: usize = 8192;
/// Part of the time between rows by which rows may miss their place.
const ROUNDING: f64 = 1e-6;

/// Part of a log, and the segments it is divided into.
pub struct LogPart<'a> {
    /// Path of the log.
    pub path: &'a Path,
    /// Start of the part (s).
    pub from: f64,
    /// Samples of a segment; none for an eighth of the part.
    pub segment: Option<usize>,
}

/// Estimate for one output, beside the exact density.
#[derive(Clone, Debug, Serialize)]
pub struct WelchEstimate {
    /// Name of the output.
    pub output: String,
    /// Column of the log.
    pub column: String,
    /// Rms of the column about its mean, in its unit.
    pub rms: f64,
    /// Samples of a segment, and number of segments.
    pub segment: usize,
    pub segments: usize,
    /// Frequencies (Hz).
    pub frequency_hz: Vec<f64>,
    /// Estimate (unit² per Hz), and its 90 % interval relative to it.
    pub density: Vec<f64>,
    pub interval: [f64; 2],
    /// Exact density (unit² per Hz).
    pub exact: Vec<f64>,
    /// Expectation of the estimate (unit² per Hz), if the log has a row for each sample of the law.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub expectation: Option<Vec<f64>>,
    /// Samples of a segment that resolves the narrowest peak of the loop, and the frequency of that peak (Hz).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub narrowest: Option<(f64, f64)>,
}

impl WelchEstimate {
    /// Returns the part of the bins whose expectation, or exact density, is within the interval of the estimate.
    pub fn part_within(&self) -> f64 {
        let expected = self.expectation.as_ref().unwrap_or(&self.exact);
        let [low, high] = self.interval;
        let within = self
            .density
            .iter()
            .zip(expected)
            .filter(|(found, exact)| (low..high).contains(&(*exact / *found)));
        within.count() as f64 / self.density.len().max(1) as f64
    }
}

/// Returns the topic and the column of an output in a log; `None` for an output that logs do not have.
fn column_of(output: &str) -> Option<(&'static str, String)> {
    match output {
        "angle" => Some(("/attitude", "angle_rad".to_owned())),
        "rate" => Some(("/rate", "rate_rad_s".to_owned())),
        "roll_error" | "pitch_error" | "yaw_error" => Some(("/pointing", format!("{output}_rad"))),
        _ => None,
    }
}

/// Estimates the densities of outputs from a log.
///
/// # Errors
/// A log without a column of an output, or with rows that are not evenly spaced or too few.
pub fn estimates(
    part: &LogPart<'_>,
    noisy: &NoisyLoop,
    outputs: &[usize],
) -> Result<Vec<WelchEstimate>, CliError> {
    let log = Log::open(part.path)?;
    let mut found = Vec::new();
    for output in outputs {
        let name = &noisy.outputs[*output].name;
        let Some((topic, column)) = column_of(name) else { continue };
        let columns = log.columns(topic)?;
        let (Some(times), Some(values)) = (columns.numbers("time_s"), columns.numbers(&column)) else {
            return Err(refused(part.path, &format!("has no {topic} {column}")));
        };
        let (step, values) = even_rows(times, values, part)?;
        let estimate = estimate((noisy, *output), (step, &values), part)?;
        found.push(WelchEstimate { column: format!("{topic} {column}"), ..estimate });
    }
    if found.is_empty() {
        let why = "has no column of these outputs: angle, rate, roll_error, pitch_error and yaw_error have one in a \
                   full log";
        return Err(refused(part.path, why));
    }
    Ok(found)
}

fn refused(path: &Path, why: &str) -> CliError {
    CliError::Arguments(format!("--log {}: {why}", path.display()))
}

/// Returns the time between rows (s), and the values of rows that far apart; rows of events between them are left out.
fn even_rows(times: &[f64], values: &[f64], part: &LogPart<'_>) -> Result<(f64, Vec<f64>), CliError> {
    let mut gaps: Vec<f64> =
        times.windows(2).map(|pair| pair[1] - pair[0]).filter(|gap| *gap > 0.0).collect();
    gaps.sort_by(f64::total_cmp);
    let Some(step) = gaps.get(gaps.len() / 2).copied() else {
        return Err(refused(part.path, "has no two rows"));
    };
    let mut even: Vec<(i64, f64)> = Vec::new();
    for (time, value) in times.iter().zip(values) {
        let place = (time / step).round();
        if *time < part.from || (time / step - place).abs() > ROUNDING * place.abs().max(1.0) {
            continue;
        }
        match even.last_mut() {
            Some(last) if last.0 == place as i64 => last.1 = *value,
            _ => even.push((place as i64, *value)),
        }
    }
    let is_even = even.windows(2).all(|pair| pair[1].0 == pair[0].0 + 1);
    if !is_even || even.iter().any(|(_, value)| !value.is_finite()) {
        return Err(refused(part.path, &format!("has no rows of numbers every {step} s")));
    }
    Ok((step, even.into_iter().map(|(_, value)| value).collect()))
}

fn estimate(
    (noisy, output): (&NoisyLoop, usize),
    (step, values): (f64, &[f64]),
    part: &LogPart<'_>,
) -> Result<WelchEstimate, CliError> {
    let default = (values.len() / SEGMENTS).max(SHORTEST);
    let segment = part.segment.unwrap_or(default);
    if segment < SHORTEST || segment > values.len() {
        let why = format!("must be from {SHORTEST} to the {} rows of the log, got {segment}", values.len());
        return Err(CliError::Arguments(format!("--segment {why}")));
    }
    let (frequency_hz, density, segments) = welch(values, step, segment);
    let below = frequency_hz.partition_point(|frequency| *frequency <= noisy.nyquist() * (1.0 + 1e-9));
    let (frequency_hz, density) = (frequency_hz[..below].to_vec(), density[..below].to_vec());
    let count = segments as f64;
    let freedom = 2.0 * count / (1.0 + (count - 1.0) / (18.0 * count));
    let is_sampled = (step / noisy.sample_period() - 1.0).abs() < ROUNDING && segment <= EXPECTED;
    let narrowest =
        noisy.narrowest_peak().map(|peak| (peak.segment * noisy.sample_period() / step, peak.frequency));
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let square = values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>();
    Ok(WelchEstimate {
        output: noisy.outputs[output].name.clone(),
        column: String::new(),
        rms: (square / values.len() as f64).sqrt(),
        segment,
        segments,
        exact: noisy.densities(&[output], &frequency_hz).remove(0).total,
        expectation: is_sampled.then(|| noisy.welch_expectation(output, segment, &frequency_hz)),
        interval: interval(freedom),
        frequency_hz,
        density,
        narrowest,
    })
}

/// Returns the factors on an estimate between which the density is with 90 % probability: Wilson and Hilferty's quantiles
/// of chi-square.
fn interval(freedom: f64) -> [f64; 2] {
    let half = 0.5 * (1.0 - PROBABILITY);
    let factor = |probability: f64| {
        let part = 2.0 / (9.0 * freedom);
        let root = 1.0 - part + quantile(probability) * part.sqrt();
        1.0 / (root * root * root)
    };
    [factor(1.0 - half), factor(half)]
}

/// Returns frequencies (Hz) without 0, the one-sided density, and the number of segments.
fn welch(values: &[f64], step: f64, length: usize) -> (Vec<f64>, Vec<f64>, usize) {
    let turn = std::f64::consts::TAU / length as f64;
    let window: Vec<f64> = (0..length).map(|n| 0.5 - 0.5 * (turn * n as f64).cos()).collect();
    let power: f64 = window.iter().map(|weight| weight * weight).sum();
    let transform = FftPlanner::new().plan_fft_forward(length);
    let bins = length / 2;
    let mut sums = vec![0.0; bins];
    let starts: Vec<usize> = (0..=values.len() - length).step_by((length - length / 2).max(1)).collect();
    for start in &starts {
        let segment = &values[*start..start + length];
        let mean = segment.iter().sum::<f64>() / length as f64;
        let weighted = segment.iter().zip(&window).map(|(value, weight)| (value - mean) * weight);
        let mut buffer: Vec<Complex<f64>> = weighted.map(|value| Complex::new(value, 0.0)).collect();
        transform.process(&mut buffer);
        for (bin, sum) in sums.iter_mut().enumerate() {
            // The Nyquist frequency of an even length has no twin.
            let sides = if 2 * (bin + 1) == length { 1.0 } else { 2.0 };
            *sum += sides * step / power * buffer[bin + 1].norm_sqr() / starts.len() as f64;
        }
    }
    let frequencies = (1..=bins).map(|bin| bin as f64 / (length as f64 * step)).collect();
    (frequencies, sums, starts.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A line and a cosine at the Nyquist frequency: `scipy.signal.welch(x, 2.0, nperseg=16)`.
    #[test]
    fn densities_are_those_of_scipy() {
        let value = |n: u32| (0.7 * f64::from(n)).sin() + if n.is_multiple_of(2) { 0.3 } else { -0.3 };
        let values: Vec<f64> = (0..40).map(value).collect();
        let (frequencies, density, segments) = welch(&values, 0.5, 16);
        assert_eq!((frequencies[0], frequencies[7], segments), (0.125, 1.0, 4));
        let expected = [
            1.397_405_701_737_130_2,
            2.511_520_912_358_823_6,
            0.311_853_247_210_528_04,
            0.001_406_726_740_169_410_9,
            0.000_114_596_486_900_207_57,
            1.976_919_700_163_430_8e-05,
            0.238_189_687_098_309_34,
            0.481_505_082_078_291_85,
        ];
        for (found, exact) in density.iter().zip(expected) {
            assert!((found - exact).abs() < 1e-12, "{found} {exact}");
        }
    }

    /// Quantiles of chi-square by `scipy.stats.chi2`: 40 degrees of freedom.
    #[test]
    fn intervals_are_those_of_chi_square() {
        let [low, high] = interval(40.0);
        assert!((low * 55.758_48 / 40.0 - 1.0).abs() < 1e-3 && (high * 26.509_30 / 40.0 - 1.0).abs() < 1e-3);
    }
}
