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
/// Largest whole multiple of the lowest harmonic for which the peak is searched for.
const MOST_WHOLE: f64 = 1000.0;

/// Machine with lines.
pub(super) struct ToneSource<'a> {
    pub lines: &'a LoadLines,
    /// Load of each harmonic at its amplitude.
    pub loads: Vec<VibrationLoad>,
}

/// Lines of each output at one frequency of a machine.
struct TonesAt {
    frequency: f64,
    motions: Vec<SourceMotion>,
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
    let examined = frequencies.par_iter().map(|at| tones.at(*at)).collect::<Result<Vec<_>, _>>()?;
    (0..outputs.len())
        .map(|place| tones.worst(&examined, place, &|own| measure(outputs[place], own)))
        .collect()
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
        examined: &[TonesAt],
        output: usize,
        measure: &dyn Fn(&[SpectralLine]) -> f64,
    ) -> Result<SourceMotion, ConfigError> {
        let values: Vec<f64> = examined.iter().map(|at| measure(&at.motions[output].lines)).collect();
        let mut order: Vec<usize> = (0..values.len()).collect();
        let rises = |place: usize| place == 0 || values[place - 1] <= values[place];
        let falls = |place: usize| values.get(place + 1).is_none_or(|next| *next <= values[place]);
        order.retain(|place| rises(*place) && falls(*place));
        order.sort_by(|a, b| values[*b].total_cmp(&values[*a]));
        let Some(first) = order.first() else { return Ok(SourceMotion::default()) };
        let mut best = (examined[*first].frequency, values[*first]);
        for place in order.into_iter().take(REFINED).filter(|_| values.len() > 1) {
            let beside = |place: usize| examined[place.min(values.len() - 1)].frequency;
            // A frequency without an answer is no maximum.
            let at = |frequency: f64| {
                self.at(frequency).map_or(0.0, |found| measure(&found.motions[output].lines))
            };
            let found = maximum(at, beside(place.saturating_sub(1)), beside(place + 1));
            if found.1 > best.1 {
                best = found;
            }
        }
        Ok(self.at(best.0)?.motions.swap_remove(output))
    }

    /// Returns the lines of each output at a frequency of the machine (rad/s).
    fn at(&self, frequency: f64) -> Result<TonesAt, ConfigError> {
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
                let behind = self.transfer.behind_mirror(output, before);
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
        Ok(TonesAt { frequency, motions })
    }
}

/// Returns the largest magnitude over time of sines, each with its multiple of a frequency and its complex amplitude: of multiples that
/// are not whole, or up to very high ones, the sum of the amplitudes.
fn peak(harmonics: &[(f64, Complex<f64>)]) -> f64 {
    let least = harmonics.first().map_or(1.0, |harmonic| harmonic.0);
    let is_whole = |multiple: f64| {
        let ratio = multiple / least;
        (ratio - libm::round(ratio)).abs() < 1e-9
    };
    let most = harmonics.iter().map(|harmonic| harmonic.0 / least).fold(1.0, f64::max);
    if most > MOST_WHOLE || !harmonics.iter().all(|(multiple, _)| is_whole(*multiple)) {
        return harmonics.iter().map(|(_, amplitude)| modulus(*amplitude)).sum();
    }
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
        assert!((peak(&[harmonic(1.0, 0.0), harmonic(1.5, 2.0)]) - 2.0).abs() < 1e-12);
    }
}
