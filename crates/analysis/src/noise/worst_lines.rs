//! Lines of a machine or of wheels at the worst speed for an output.
//!
//! The measure of an output is largest where a harmonic meets a resonance, or at an end of the speeds. Equal steps and these speeds
//! are examined, then the surroundings of the highest ones: a search from one start may stop at a lower peak.

use std::f64::consts::TAU;

use flexsc_formats::document::ConfigError;
use flexsc_numerics::scalar_search::{maximum, resonance};
use nalgebra::Complex;
use rayon::prelude::*;

use super::line_source::{HarmonicLines, LineSource};
use super::lines::LineLoop;
use super::source_motion::{Measure, SourceMotion, WorstTone};
use super::spectral_line::SpectralLine;
use crate::margins::frequency_response::{modulus, unit_circle};

/// Largest number of maxima over the speed that are found exactly.
const MOST_MAXIMA: usize = 12;
/// Instants in a period of the highest harmonic at which the peak is sought.
const INSTANTS: f64 = 32.0;
/// Largest multiple of the frequency common to all harmonics for which the peak is searched for.
const MOST_WHOLE: f64 = 1000.0;

/// Returns the motion of each output at the worst of some speeds (rad/s) of a source for it, and of the maxima between them.
pub(super) fn worst_lines(
    source: &LineSource,
    lines: &LineLoop<'_>,
    outputs: &[usize],
    (speeds, measure): (&[f64], Measure<'_>),
) -> Result<Vec<SourceMotion>, ConfigError> {
    // The lines at all speeds would be many.
    let values = |speed: &f64| -> Result<Vec<f64>, ConfigError> {
        let found = source.at(lines, *speed, outputs)?;
        let value =
            |(place, output): (usize, &usize)| measure(*output, &all_lines(&found, place)).max(0.0).sqrt();
        Ok(outputs.iter().enumerate().map(value).collect())
    };
    let values = speeds.par_iter().map(values).collect::<Result<Vec<_>, _>>()?;
    let worst = |(place, output): (usize, &usize)| {
        let own: Vec<f64> = values.iter().map(|values| values[place]).collect();
        let value = |speed: f64| -> Result<f64, ConfigError> {
            let found = source.at(lines, speed, &[*output])?;
            Ok(measure(*output, &all_lines(&found, 0)).max(0.0).sqrt())
        };
        let mut all: Vec<(f64, f64)> = speeds.iter().copied().zip(own.iter().copied()).collect();
        for speed in maxima(speeds, &own, &value)? {
            all.push((speed, value(speed)?));
        }
        let Some((speed, _)) = all.into_iter().max_by(|a, b| a.1.total_cmp(&b.1)) else {
            return Ok(SourceMotion::default());
        };
        Ok(motion(&source.at(lines, speed, &[*output])?, speed))
    };
    outputs.iter().enumerate().map(worst).collect()
}

/// Finds the arguments of the largest maxima of a positive function between increasing ones, at which it has these values.
pub(super) fn maxima(
    arguments: &[f64],
    values: &[f64],
    value: &(dyn Fn(f64) -> Result<f64, ConfigError> + Sync),
) -> Result<Vec<f64>, ConfigError> {
    let is_top = |place: &usize| values[*place] > values[place - 1] && values[*place] >= values[place + 1];
    let mut tops: Vec<usize> = (1..values.len().max(1) - 1).filter(is_top).collect();
    tops.sort_by(|a, b| values[*b].total_cmp(&values[*a]));
    tops.truncate(MOST_MAXIMA);
    let find = |place: &usize| {
        let mut fault = None;
        let at = |argument: f64| {
            value(argument).unwrap_or_else(|why| {
                fault.get_or_insert(why);
                f64::NAN
            })
        };
        let around = |all: &[f64]| [all[place - 1], all[*place], all[place + 1]];
        let found = resonance(at, around(arguments), around(values));
        fault.map_or(Ok(found), Err)
    };
    tops.par_iter().map(find).collect()
}

/// Returns all lines of an output.
fn all_lines(found: &[HarmonicLines], output: usize) -> Vec<SpectralLine> {
    let of_load = |own: &HarmonicLines| {
        let lines = own.outputs[output].iter();
        let line = |(frequency, amplitude): &(f64, Complex<f64>)| SpectralLine {
            frequency_rad_s: frequency.abs(),
            amplitude: own.strength * modulus(*amplitude),
        };
        lines.map(line).collect::<Vec<_>>()
    };
    found.iter().flat_map(of_load).collect()
}

/// Returns the motion of the only output at a speed (rad/s).
fn motion(found: &[HarmonicLines], speed: f64) -> SourceMotion {
    let direct = |own: &HarmonicLines| Some((own.order, own.outputs[0].last()?.1 * own.strength));
    let harmonics: Vec<(f64, Complex<f64>)> = found.iter().filter_map(direct).collect();
    let own = SourceMotion { lines: all_lines(found, 0), ..SourceMotion::default() };
    let worst = Some(WorstTone { frequency: speed, peak: peak(&harmonics) });
    SourceMotion { sample_variance: own.variance(), worst, ..own }
}

/// Returns the largest magnitude over time of sines, each with its multiple of a frequency and its complex amplitude: without a common
/// period, or one that is very long, the sum of the amplitudes.
fn peak(harmonics: &[(f64, Complex<f64>)]) -> f64 {
    let lowest = harmonics.first().map_or(1.0, |harmonic| harmonic.0);
    let highest = harmonics.iter().map(|harmonic| harmonic.0).fold(lowest, f64::max);
    let is_common = |least: &f64| {
        let off = |multiple: f64| (multiple / least - libm::round(multiple / least)).abs();
        harmonics.iter().all(|(multiple, _)| off(*multiple) < 1e-9)
    };
    let parts = (1..).map(|part| lowest / f64::from(part));
    let Some(least) = parts.take_while(|least| highest <= MOST_WHOLE * least).find(is_common) else {
        return harmonics.iter().map(|(_, amplitude)| modulus(*amplitude)).sum();
    };
    let most = highest / least;
    let count = libm::ceil(INSTANTS * most) as usize;
    let value = |angle: f64| {
        let all = harmonics
            .iter()
            .map(|(multiple, amplitude)| (unit_circle(multiple / least * angle) * amplitude).re);
        all.sum::<f64>().abs()
    };
    let step = TAU / count as f64;
    let at = |instant: usize| value(step * instant as f64);
    let best = (0..count).max_by(|a, b| at(*a).total_cmp(&at(*b))).unwrap_or(0) as f64;
    maximum(value, step * (best - 1.0), step * (best + 1.0)).1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn peaks_add_by_their_phases() {
        let harmonic = |multiple: f64, phase: f64| (multiple, unit_circle(phase));
        // cos t + cos 3 t has 2 at t = 0, and cos t - cos 3 t has 8/sqrt(27) where cos² t = 1/3.
        assert!((peak(&[harmonic(2.0, 0.0), harmonic(6.0, 0.0)]) - 2.0).abs() < 1e-12);
        let found = peak(&[harmonic(2.0, 0.0), harmonic(6.0, std::f64::consts::PI)]);
        assert!((found - 8.0 / f64::sqrt(27.0)).abs() < 1e-9, "{found}");
        // sin 2 t + sin 3 t, by mpmath; the same of steps of a motor. Without a common period the amplitudes add up.
        for scale in [1.0, 200.0] {
            let sines = [2.0, 3.0].map(|multiple| harmonic(scale * multiple, -0.25 * TAU));
            assert!((peak(&sines) - 1.905_961_118_715_785_2).abs() < 1e-9, "{}", peak(&sines));
        }
        assert!((peak(&[harmonic(1.0, 0.0), harmonic(f64::sqrt(2.0), 2.0)]) - 2.0).abs() < 1e-12);
    }
}
