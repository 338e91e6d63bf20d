//! Lines of a machine whose frequency is known to a tolerance: those at its worst frequency for each output.
//!
//! The measure of an output is largest where a harmonic meets a resonance, or at an end of the range. All these frequencies and equal steps
//! are examined, then the surroundings of the highest ones by golden section: a search from one start may stop at a lower peak.

use std::f64::consts::TAU;

use flexsc_formats::document::ConfigError;
use flexsc_numerics::scalar_search::maximum;
use flexsc_spacecraft::load_lines::LoadLines;
use nalgebra::Complex;
use rayon::prelude::*;

use super::lines::LineLoop;
use super::measured_loads::VibrationLoad;
use super::source_motion::{Measure, SourceMotion, WorstTone};
use super::spectral_line::SpectralLine;
use super::transfer::LoopTransfer;
use crate::margins::frequency_response::{modulus, unit_circle};

/// Equal steps in the range of a frequency, and resonances of each harmonic that are examined beside.
const STEPS: usize = 32;
const MOST_RESONANCES: usize = 200;
/// Number of the highest peaks that are refined.
const REFINED: usize = 3;
/// Difference of orders, relative, below which harmonics are one line.
const EQUAL: f64 = 1e-12;
/// Instants in a period of the highest harmonic at which the peak is sought.
const INSTANTS: f64 = 32.0;
/// Largest multiple of the frequency common to all harmonics for which the peak is searched for.
const MOST_WHOLE: f64 = 1000.0;

/// Machine with lines.
pub(super) struct ToneSource<'a> {
    pub lines: &'a LoadLines,
    /// Load of each harmonic at its amplitude.
    pub loads: Vec<VibrationLoad>,
}

/// Machine in a loop.
struct ToneLoop<'a> {
    source: &'a ToneSource<'a>,
    transfer: LoopTransfer<'a>,
    outputs: usize,
}

/// Returns the motion of each output at the worst frequency of a machine for it.
pub(super) fn worst_tones(
    lines: &LineLoop<'_>,
    outputs: &[usize],
    source: &ToneSource<'_>,
    measure: Measure<'_>,
) -> Result<Vec<SourceMotion>, ConfigError> {
    let transfer = LoopTransfer::new(lines, outputs, &source.loads)?;
    let tones = ToneLoop { source, transfer, outputs: outputs.len() };
    let frequencies = tones.frequencies();
    // The lines at all frequencies would be many.
    let values = |at: &f64| -> Result<Vec<f64>, ConfigError> {
        let motions = tones.at(*at)?;
        Ok(outputs.iter().zip(motions).map(|(output, own)| measure(*output, &own.lines)).collect())
    };
    let values = frequencies.par_iter().map(values).collect::<Result<Vec<_>, _>>()?;
    let worst = |place: usize| {
        let own: Vec<f64> = values.iter().map(|values| values[place]).collect();
        tones.worst((&frequencies, &own), place, &|lines| measure(outputs[place], lines))
    };
    (0..outputs.len()).map(worst).collect()
}

impl ToneLoop<'_> {
    /// Returns the frequencies that are examined (rad/s), in increasing order.
    fn frequencies(&self) -> Vec<f64> {
        let [from, to] = self.source.lines.range();
        if from == to {
            return vec![from];
        }
        let lines = self.source.lines;
        let met = lines.harmonics.iter().flat_map(|harmonic| {
            let multiple = lines.multiple(harmonic);
            let (direct, aliases) = self.transfer.resonances_below(to * multiple);
            let all = direct.into_iter().chain(aliases.into_iter().map(|(alias, _)| alias));
            let met = all.map(move |[at, _]| at / multiple);
            met.filter(|at| (from..to).contains(at)).take(MOST_RESONANCES)
        });
        let step = |step| from + (to - from) * step as f64 / STEPS as f64;
        let mut all: Vec<f64> = (0..=STEPS).map(step).chain(met).collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    }

    /// Returns the worst of the examined frequencies for an output, refined, and its lines there.
    fn worst(
        &self,
        (frequencies, values): (&[f64], &[f64]),
        output: usize,
        measure: &dyn Fn(&[SpectralLine]) -> f64,
    ) -> Result<SourceMotion, ConfigError> {
        let mut order: Vec<usize> = (0..values.len()).collect();
        let rises = |place: usize| place == 0 || values[place - 1] <= values[place];
        let falls = |place: usize| values.get(place + 1).is_none_or(|next| *next <= values[place]);
        order.retain(|place| rises(*place) && falls(*place));
        order.sort_by(|a, b| values[*b].total_cmp(&values[*a]));
        let Some(first) = order.first() else { return Ok(SourceMotion::default()) };
        let mut best = (frequencies[*first], values[*first]);
        for place in order.into_iter().take(REFINED).filter(|_| values.len() > 1) {
            let beside = |place: usize| frequencies[place.min(values.len() - 1)];
            // A frequency without an answer is no maximum.
            let at = |frequency: f64| self.at(frequency).map_or(0.0, |found| measure(&found[output].lines));
            let found = maximum(at, beside(place.saturating_sub(1)), beside(place + 1));
            if found.1 > best.1 {
                best = found;
            }
        }
        Ok(self.at(best.0)?.swap_remove(output))
    }

    /// Returns the lines of each output at a frequency of the machine (rad/s).
    fn at(&self, frequency: f64) -> Result<Vec<SourceMotion>, ConfigError> {
        let lines = self.source.lines;
        let mut motions = vec![SourceMotion::default(); self.outputs];
        // Complex amplitudes of the harmonics of each output, for the peak.
        let mut direct: Vec<Vec<(f64, Complex<f64>)>> = vec![Vec::new(); self.outputs];
        let mut order: Vec<usize> = (0..lines.harmonics.len()).collect();
        let multiple = |place: usize| lines.multiple(&lines.harmonics[place]);
        order.sort_by(|a, b| multiple(*a).total_cmp(&multiple(*b)));
        for same in order.chunk_by(|a, b| multiple(*b) - multiple(*a) <= EQUAL * multiple(*b)) {
            let responses = self.transfer.at(frequency * multiple(same[0]))?;
            for (output, motion) in motions.iter_mut().enumerate() {
                let mut before = responses[same[0]].lines[output].clone();
                for (line, (_, amplitude)) in before.iter_mut().enumerate() {
                    let each = same.iter().map(|place| {
                        let phase = lines.harmonics[*place].phase.get();
                        responses[*place].lines[output][line].1 * unit_circle(phase)
                    });
                    *amplitude = each.sum();
                }
                let behind = self.transfer.behind_mirror(output, vec![before]).swap_remove(0);
                direct[output].extend(behind.last().map(|(_, own)| (multiple(same[0]), *own)));
                let line = |(at, amplitude): (f64, Complex<f64>)| SpectralLine {
                    frequency_rad_s: at.abs(),
                    amplitude: modulus(amplitude),
                };
                motion.lines.extend(behind.into_iter().map(line));
            }
        }
        for (motion, harmonics) in motions.iter_mut().zip(direct) {
            motion.sample_variance = motion.variance();
            motion.worst = Some(WorstTone { frequency, peak: peak(&harmonics) });
        }
        Ok(motions)
    }
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
