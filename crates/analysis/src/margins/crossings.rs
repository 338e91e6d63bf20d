//! Crossings of a loop: of the unit circle, with phase and delay margins, and of the negative real axis, with gain
//! margins.

use std::f64::consts::{PI, TAU};

use flexsc_numerics::scalar_search::root;
use nalgebra::Complex;
use schemars::JsonSchema;
use serde::Serialize;

use super::frequency_response::{FrequencyResponse, modulus, unit_circle};
use super::loci::{LociValues, LocusSegment, eigenvector};
use super::sample_components::LoopSamples;

/// Loop gains below this are zeros of a filter.
const SMALLEST: f64 = 1e-9;
/// Loop gains above this are poles.
const LARGEST: f64 = 1e9;

/// Frequency at which the loop gain is 1.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct GainCrossing {
    /// Frequency (rad/s).
    pub frequency_rad_s: f64,
    /// Phase margin (rad), from -pi to pi: positive if the loop may lag by it, negative if it may lead.
    pub phase_rad: f64,
    /// Delay (s) that uses up the phase; none for several samples in a period, where a delay is more than a phase.
    pub delay_s: Option<f64>,
}

/// Frequency at which the loop transfer is real and negative.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct PhaseCrossing {
    /// Frequency (rad/s).
    pub frequency_rad_s: f64,
    /// Gain margin: factor on the loop gain at which the loop is at the limit of stability.
    pub factor: f64,
}

/// Crossings of a loop, each in increasing order of frequency.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct Crossings {
    /// Crossings of the unit circle, where the loop gain is 1, in increasing order of frequency.
    #[schemars(extend("x-name" = "gain_crossings"))]
    pub gain: Vec<GainCrossing>,
    /// Crossings of the negative real axis, in increasing order of frequency.
    #[schemars(extend("x-name" = "phase_crossings"))]
    pub phase: Vec<PhaseCrossing>,
}

/// Loop with its samples in a period of the transfer.
pub struct SampledTransfer<'a> {
    /// Response of the loop, of as many inputs as there are samples.
    pub response: &'a FrequencyResponse,
    /// Period of the transfer (s).
    pub period: f64,
    /// Samples in a period.
    pub samples: usize,
}

impl Crossings {
    /// Finds the crossings of these loci of a transfer.
    pub fn find(transfer: &SampledTransfer<'_>, all: &[LociValues]) -> Self {
        let mut found = Self::default();
        for pair in all.windows(2) {
            for (first, last) in pair[0].values.iter().zip(&pair[1].values) {
                // A value that is rounding has no crossings.
                if *first == Complex::ZERO || *last == Complex::ZERO {
                    continue;
                }
                let ends = [(pair[0].angle, *first), (pair[1].angle, *last)];
                let segment = LocusSegment { response: transfer.response, ends };
                found.add_gain_crossing(transfer, &segment);
                found.add_phase_crossing(transfer, &segment);
            }
        }
        let count = all.first().map_or(0, |first| first.values.len());
        let value = |at: &LociValues, locus: usize| (at.angle, at.values[locus]);
        for locus in 0..count {
            let is_known = |at: &&LociValues| at.values[locus] != Complex::ZERO;
            if let Some(last) = all.last().filter(is_known) {
                found.add_end(transfer, value(last, locus));
            }
            // The Nyquist frequency of the law may be at the angle 0.
            if let Some(first) = all.iter().find(is_known).filter(|_| transfer.samples > 1) {
                found.add_end(transfer, value(first, locus));
            }
        }
        found.gain.sort_by(|a, b| a.frequency_rad_s.total_cmp(&b.frequency_rad_s));
        found.phase.sort_by(|a, b| a.frequency_rad_s.total_cmp(&b.frequency_rad_s));
        found
    }

    fn add_gain_crossing(&mut self, transfer: &SampledTransfer<'_>, segment: &LocusSegment<'_>) {
        let [(low, first), (high, last)] = segment.ends;
        if (modulus(first) > 1.0) == (modulus(last) > 1.0) {
            return;
        }
        let angle = root(|angle| libm::log(modulus(segment.at(angle))), low, high);
        let value = segment.at(angle);
        let (frequency, is_mirrored) = transfer.frequency(angle, value);
        let phase = libm::atan2(-value.im, -value.re) * if is_mirrored { -1.0 } else { 1.0 };
        let lag = if phase < 0.0 { phase + TAU } else { phase };
        self.gain.push(GainCrossing {
            frequency_rad_s: frequency,
            phase_rad: phase,
            delay_s: (transfer.samples == 1).then(|| lag / frequency),
        });
    }

    fn add_phase_crossing(&mut self, transfer: &SampledTransfer<'_>, segment: &LocusSegment<'_>) {
        let [(low, first), (high, last)] = segment.ends;
        // At the Nyquist frequency, an imaginary part is rounding, and the end is added by itself.
        if (first.im > 0.0) == (last.im > 0.0)
            || (first.re > 0.0 && last.re > 0.0)
            || (high == PI && is_real(high, last))
        {
            return;
        }
        let angle = root(|angle| segment.at(angle).im, low, high);
        self.add_real(transfer, angle, segment.at(angle));
    }

    /// Adds the end of a locus, an angle and a value, if it is real there.
    fn add_end(&mut self, transfer: &SampledTransfer<'_>, (angle, value): (f64, Complex<f64>)) {
        if is_real(angle, value) && modulus(value) < 1e6 {
            self.add_real(transfer, angle, Complex::new(value.re, 0.0));
        }
    }

    /// Adds a real value of a locus: not a positive one, a zero, or a pole, at which the imaginary part changes its sign
    /// as well.
    fn add_real(&mut self, transfer: &SampledTransfer<'_>, angle: f64, value: Complex<f64>) {
        let size = modulus(value);
        if value.re < 0.0 && value.im.abs() < 1e-6 * size && (SMALLEST..LARGEST).contains(&size) {
            let (frequency, _) = transfer.frequency(angle, value);
            self.phase.push(PhaseCrossing { frequency_rad_s: frequency, factor: -1.0 / value.re });
        }
    }
}

/// Returns true if a value is real but for rounding and for its distance from the angle 0 or pi.
fn is_real(angle: f64, value: Complex<f64>) -> bool {
    value.im.abs() <= 10.0 * (angle.min(PI - angle) + 1e-9) * value.re.abs()
}

impl SampledTransfer<'_> {
    /// Returns the frequency (rad/s) of the strongest component of the motion at an angle, and whether the phase of that
    /// component is the negative one, by the eigenvector of a value of the loci.
    fn frequency(&self, angle: f64, value: Complex<f64>) -> (f64, bool) {
        let count = self.samples;
        if count == 1 {
            return (angle / self.period, false);
        }
        let vector = self.response.at(unit_circle(angle)).and_then(|own| eigenvector(own, value));
        let Some(vector) = vector else { return (angle / self.period, false) };
        LoopSamples { period: self.period, count }.frequency(angle, vector.as_slice())
    }
}
