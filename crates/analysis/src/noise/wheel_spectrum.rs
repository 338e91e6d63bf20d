//! Lines of outputs over the speed of unbalanced wheels.

use flexsc_formats::document::ConfigError;
use rayon::prelude::*;
use serde::Serialize;

use super::image_contrast::ImageBlur;
use super::line_source::LineSource;
use super::lines::LineLoop;
use super::noisy_loop::NoiseError;
use super::spectral_line::{OutputLines, SpectralLine};
use super::speed_grid::ResonantSpeed;
use super::window_rms::WindowRms;
use super::windows::Window;
use super::worst_lines::maxima;

/// Lines of the outputs under one harmonic of one wheel at one speed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WheelLines {
    /// Speed of the wheel (rad/s).
    pub speed_rad_s: f64,
    /// Number of the wheel, from 1.
    pub wheel: usize,
    /// Order of the harmonic: periods per turn.
    pub order: f64,
    /// Lines of each output.
    pub outputs: Vec<OutputLines>,
}

/// Lines of the outputs over the speed of the wheels.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WheelSpectrum {
    /// Speeds (rad/s).
    pub speed_rad_s: Vec<f64>,
    /// Rms of each output at each speed, of all lines of all wheels, whose phases are unrelated.
    pub rms: Vec<Vec<f64>>,
    /// Lines of each harmonic of each wheel at each speed.
    pub lines: Vec<WheelLines>,
    /// Indices of each output at each speed, of all lines of all wheels, over windows that begin at any time; empty without
    /// a window.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub windows: Vec<Vec<WindowRms>>,
    /// Modulation transfer of each output at each speed, of the noise and of all lines; empty for outputs that are no angles, and
    /// without a pixel.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub mtf: Vec<Vec<f64>>,
}

/// Rise of an rms above the level between two steps that makes a peak.
const RISE: f64 = 1.2;
/// Speeds beside a peak, in half widths, and those farther beside a high one.
const FLANKS: [f64; 2] = [-1.5, 1.5];
const FAR_FLANKS: [f64; 4] = [-24.0, -6.0, 6.0, 24.0];
/// Rise of an rms above the level between two steps that makes a high peak.
const HIGH: f64 = 10.0;

impl WheelSpectrum {
    /// Computes the lines of some outputs at speeds of the wheels (rad/s): of each harmonic of each wheel alone.
    ///
    /// # Errors
    /// See [`LineSource::at`].
    pub fn new(
        source: &LineSource,
        lines: &LineLoop<'_>,
        speeds: &[f64],
        outputs: &[usize],
    ) -> Result<Self, ConfigError> {
        let at = |speed: &f64| -> Result<Vec<WheelLines>, ConfigError> {
            let found = source.at(lines, *speed, outputs)?.into_iter().map(|own| WheelLines {
                speed_rad_s: *speed,
                wheel: own.wheel,
                order: own.order,
                outputs: own.outputs.into_iter().map(|lines| OutputLines::new(lines, own.strength)).collect(),
            });
            Ok(found.collect())
        };
        let lines: Vec<Vec<WheelLines>> = speeds.par_iter().map(at).collect::<Result<_, _>>()?;
        let rms = |output: usize| {
            let at = |own: &Vec<WheelLines>| {
                f64::sqrt(own.iter().map(|lines| lines.outputs[output].mean_square()).sum())
            };
            lines.iter().map(at).collect()
        };
        Ok(Self {
            rms: (0..outputs.len()).map(rms).collect(),
            speed_rad_s: speeds.to_vec(),
            lines: lines.into_iter().flatten().collect(),
            windows: Vec::new(),
            mtf: Vec::new(),
        })
    }

    /// Computes the lines of some outputs at equal steps up to the largest speed that the scenario gives, and at the peaks between
    /// them.
    ///
    /// # Errors
    /// See [`LineSource::at`]; a scenario that gives no largest speed.
    pub fn refined(source: &LineSource, lines: &LineLoop<'_>, outputs: &[usize]) -> Result<Self, NoiseError> {
        let steps = source.steps().ok_or_else(NoiseError::without_speed)?;
        let range = [steps[0], steps[steps.len() - 1]];
        let at = |speeds: &[f64]| Self::new(source, lines, speeds, outputs);
        let resonant = source.resonant_speeds(lines, outputs, (range, steps[1] - steps[0]))?;
        let own = at(&steps)?;
        let examined: Vec<f64> = resonant.iter().map(|peak| peak.speed).collect();
        let tops = at(&examined)?;
        let rise = |place: usize| {
            let speed = examined[place];
            let after = steps.partition_point(|step| *step < speed).clamp(1, steps.len() - 1);
            let share = (speed - steps[after - 1]) / (steps[after] - steps[after - 1]);
            let rises = own.rms.iter().zip(&tops.rms).map(|(rms, tops)| {
                let level = libm::pow(rms[after - 1], 1.0 - share) * libm::pow(rms[after], share);
                if tops[place] > RISE * level { tops[place] / level } else { 0.0 }
            });
            rises.fold(0.0, f64::max)
        };
        let beside = |place: usize| {
            let ResonantSpeed { speed, width } = resonant[place];
            let far = FAR_FLANKS.into_iter().filter(move |_| rise(place) > HIGH);
            FLANKS.into_iter().chain(far).map(move |part| speed + part * width)
        };
        let risen: Vec<usize> = (0..examined.len()).filter(|place| rise(*place) > 0.0).collect();
        let mut flanks: Vec<f64> = risen.iter().flat_map(|place| beside(*place)).collect();
        flanks.retain(|speed| (range[0]..range[1]).contains(speed));
        let found = own.merged(tops.selected(&risen)).merged(at(&flanks)?);
        if !source.has_whirl(lines) {
            return Ok(found);
        }
        // The maxima of the rms of each output between the speeds.
        let mut speeds = Vec::new();
        for (place, output) in outputs.iter().enumerate() {
            let rms = |speed| Ok(Self::new(source, lines, &[speed], &[*output])?.rms[0][0]);
            speeds.extend(maxima(&found.speed_rad_s, &found.rms[place], &rms)?);
        }
        Ok(found.merged(at(&speeds)?))
    }

    /// Returns the spectrum with the indices of its lines over windows: each line has its weight.
    #[must_use]
    pub fn over_windows(mut self, window: Window) -> Self {
        let index = |output: usize| {
            let at = |(_, lines): (f64, Vec<SpectralLine>)| WindowRms::from_lines(lines.into_iter(), window);
            self.over_speed(output).map(at).collect()
        };
        self.windows = (0..self.rms.len()).map(index).collect();
        self
    }

    /// Returns all lines of an output at each speed (rad/s).
    pub(super) fn over_speed(&self, output: usize) -> impl Iterator<Item = (f64, Vec<SpectralLine>)> {
        let each = (self.lines.len() / self.speed_rad_s.len().max(1)).max(1);
        let of = move |own: &[WheelLines]| {
            own.iter().flat_map(|lines| lines.outputs[output].all()).copied().collect()
        };
        self.speed_rad_s.iter().copied().zip(self.lines.chunks(each).map(of))
    }

    /// Returns the highest frequency of all lines (rad/s).
    pub(super) fn highest_frequency(&self) -> f64 {
        let lines = self.lines.iter().flat_map(|lines| lines.outputs.iter().flat_map(OutputLines::all));
        lines.map(|line| line.frequency_rad_s).fold(0.0, f64::max)
    }

    /// Adds the modulation transfer at a spatial frequency (cycles/rad) of some outputs, each with the blur of its noise.
    pub(super) fn add_contrast(&mut self, frequency: f64, outputs: &[(usize, ImageBlur)]) {
        self.mtf = vec![Vec::new(); self.rms.len()];
        for (output, blur) in outputs {
            let contrasts = self.over_speed(*output).map(|(_, lines)| blur.contrast(frequency, &lines));
            self.mtf[*output] = contrasts.collect();
        }
    }

    /// Returns the lines at some of the speeds.
    fn selected(&self, places: &[usize]) -> Self {
        let each = self.lines.len() / self.speed_rad_s.len().max(1);
        let of = |values: &Vec<f64>| places.iter().map(|place| values[*place]).collect();
        let lines = places.iter().flat_map(|place| &self.lines[place * each..(place + 1) * each]);
        Self {
            speed_rad_s: of(&self.speed_rad_s),
            rms: self.rms.iter().map(of).collect(),
            lines: lines.cloned().collect(),
            windows: Vec::new(),
            mtf: Vec::new(),
        }
    }

    /// Returns the lines at the speeds of two spectra, in increasing order of the speed.
    fn merged(mut self, other: Self) -> Self {
        self.speed_rad_s.extend(other.speed_rad_s);
        self.rms.iter_mut().zip(other.rms).for_each(|(rms, more)| rms.extend(more));
        self.lines.extend(other.lines);
        let mut places: Vec<usize> = (0..self.speed_rad_s.len()).collect();
        places.sort_by(|a, b| self.speed_rad_s[*a].total_cmp(&self.speed_rad_s[*b]));
        places.dedup_by(|a, b| self.speed_rad_s[*a] == self.speed_rad_s[*b]);
        self.selected(&places)
    }
}
