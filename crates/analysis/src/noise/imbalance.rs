//! Imbalance of the wheels as loads on the body that turn: lines over the speed of the wheels.

use flexsc_control::actuator::Wheels;
use flexsc_dynamics::three_axis::HarmonicLine;
use flexsc_dynamics::three_axis_model::ThreeAxisModel;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::Positive;
use flexsc_numerics::scalar_search::resonance;
use rayon::prelude::*;
use serde::Serialize;

use super::image_contrast::ImageBlur;
use super::lines::LineLoop;
use super::spectral_line::{OutputLines, SineLoad, SpectralLine};
use super::speed_grid::{ResonantSpeed, resonant_speeds, whirl_speeds};
use super::vibration::load_column;
use super::window_rms::WindowRms;
use super::windows::Window;
use flexsc_scenario::Scenario;

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

/// Number of equal steps up to the largest speed, and the smallest of them relative to the largest.
const SPEEDS: u32 = 48;
const LOWEST: f64 = 0.05;

/// Rise of an rms above the level between two steps that makes a peak.
const RISE: f64 = 1.2;
/// Speeds beside a peak, in half widths, and those farther beside a high one.
const FLANKS: [f64; 2] = [-1.5, 1.5];
const FAR_FLANKS: [f64; 4] = [-24.0, -6.0, 6.0, 24.0];
/// Rise of an rms above the level between two steps that makes a high peak.
const HIGH: f64 = 10.0;

/// Harmonic of a wheel: loads per square of the speed.
struct WheelHarmonic {
    wheel: usize,
    order: f64,
    load: SineLoad,
}

/// Largest number of maxima over the speed that are found exactly, of each output.
const MOST_MAXIMA: usize = 12;

impl WheelSpectrum {
    /// Returns the spectrum with the indices of its lines over windows: each line has its weight.
    #[must_use]
    pub fn over_windows(mut self, window: Window) -> Self {
        let each = (self.lines.len() / self.speed_rad_s.len().max(1)).max(1);
        let index = |output: usize| {
            let at = |own: &[WheelLines]| {
                let lines = own.iter().flat_map(|lines| lines.outputs[output].all());
                WindowRms::from_lines(lines.copied(), window)
            };
            self.lines.chunks(each).map(at).collect()
        };
        self.windows = (0..self.rms.len()).map(index).collect();
        self
    }

    /// Returns the highest frequency of all lines (rad/s).
    pub(super) fn highest_frequency(&self) -> f64 {
        let lines = self.lines.iter().flat_map(|lines| lines.outputs.iter().flat_map(OutputLines::all));
        lines.map(|line| line.frequency_rad_s).fold(0.0, f64::max)
    }

    /// Adds the modulation transfer at a spatial frequency (cycles/rad) of some outputs, each with the blur of its noise.
    pub(super) fn add_contrast(&mut self, frequency: f64, outputs: &[(usize, ImageBlur)]) {
        let each = (self.lines.len() / self.speed_rad_s.len().max(1)).max(1);
        self.mtf = vec![Vec::new(); self.rms.len()];
        for (output, blur) in outputs {
            let at = |own: &[WheelLines]| {
                let lines: Vec<SpectralLine> =
                    own.iter().flat_map(|lines| lines.outputs[*output].all()).copied().collect();
                blur.contrast(frequency, &lines)
            };
            self.mtf[*output] = self.lines.chunks(each).map(at).collect();
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

/// Imbalance of a scenario's wheels.
pub struct WheelImbalance {
    harmonics: Vec<WheelHarmonic>,
    /// Largest speed that the scenario gives (rad/s), if it gives one.
    pub largest_speed: Option<f64>,
}

impl WheelImbalance {
    /// Returns the imbalance of a scenario's wheels; `None` for wheels without one.
    ///
    /// # Errors
    /// An inconsistent key of the wheels, and the reason.
    pub fn from_scenario(scenario: &Scenario) -> Result<Option<Self>, ConfigError> {
        let Some(body) = scenario.model.three_axis() else { return Ok(None) };
        let members: Vec<_> = scenario.actuator.members().into_iter().collect();
        for member in &members {
            let Some(wheels) = member.kind.unbalanced_wheels() else { continue };
            let bearings = wheels.bearings(body).map_err(|fault| fault.within(&member.key))?;
            let mut harmonics = Vec::new();
            for (wheel, bearing) in bearings.iter().enumerate() {
                let mut carried = scenario.study.carried_rotors.iter();
                let is_backward = carried.any(|own| own.wheel == wheel && own.speed < 0.0);
                for line in &bearing.lines {
                    let mut load = load(body, line);
                    if is_backward {
                        load.sine.neg_mut();
                    }
                    harmonics.push(WheelHarmonic { wheel: wheel + 1, order: line.order, load });
                }
            }
            harmonics.sort_by(|a, b| a.order.total_cmp(&b.order).then(a.wheel.cmp(&b.wheel)));
            return Ok(Some(Self { harmonics, largest_speed: largest_speed(wheels) }));
        }
        Ok(None)
    }

    /// Computes the lines of some outputs at speeds of the wheels (rad/s), and their rms.
    ///
    /// # Errors
    /// See [`LineLoop::lines`].
    pub fn spectrum(
        &self,
        lines: &LineLoop<'_>,
        speeds: &[f64],
        outputs: &[usize],
    ) -> Result<WheelSpectrum, ConfigError> {
        let lines = self.lines(lines, speeds, outputs)?;
        let each = lines.len() / speeds.len().max(1);
        let rms = |output: usize| {
            let at = |own: &[WheelLines]| {
                f64::sqrt(own.iter().map(|lines| lines.outputs[output].mean_square()).sum())
            };
            lines.chunks(each.max(1)).map(at).collect()
        };
        Ok(WheelSpectrum {
            rms: (0..outputs.len()).map(rms).collect(),
            speed_rad_s: speeds.to_vec(),
            lines,
            windows: Vec::new(),
            mtf: Vec::new(),
        })
    }

    /// Computes the lines of some outputs at equal steps up to the largest speed that the scenario gives, and at the peaks between
    /// them; `None` if it gives none.
    ///
    /// # Errors
    /// See [`LineLoop::lines`].
    pub fn refined_spectrum(
        &self,
        lines: &LineLoop<'_>,
        outputs: &[usize],
    ) -> Result<Option<WheelSpectrum>, ConfigError> {
        let Some((steps, range)) = self.steps() else { return Ok(None) };
        let whirls = !lines.parts.scenario.study.carried_rotors.is_empty();
        let orders = self.orders();
        let mut resonant = resonant_speeds(&lines.parts, &orders, range, steps[1] - steps[0])?;
        if whirls {
            resonant.extend(whirl_speeds(lines.parts.scenario, &orders, range, steps[1] - steps[0])?);
        }
        let own = self.spectrum(lines, &steps, outputs)?;
        let examined: Vec<f64> = resonant.iter().map(|peak| peak.speed).collect();
        let tops = self.spectrum(lines, &examined, outputs)?;
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
        let flanks = self.spectrum(lines, &flanks, outputs)?;
        let tops = tops.selected(&risen);
        let found = own.merged(tops).merged(flanks);
        Ok(Some(if whirls { self.with_maxima(lines, found, outputs)? } else { found }))
    }

    /// Computes the lines of some outputs at equal steps, where harmonics meet modes of the body, and at the largest maxima between;
    /// `None` if the scenario gives no largest speed. Where aliases meet modes is not looked for.
    ///
    /// # Errors
    /// See [`LineLoop::lines`].
    pub fn largest_spectrum(
        &self,
        lines: &LineLoop<'_>,
        outputs: &[usize],
    ) -> Result<Option<WheelSpectrum>, ConfigError> {
        let Some((steps, range)) = self.steps() else { return Ok(None) };
        let met = whirl_speeds(lines.parts.scenario, &self.orders(), range, steps[1] - steps[0])?;
        let met: Vec<f64> = met.into_iter().map(|peak| peak.speed).collect();
        let found = self.spectrum(lines, &steps, outputs)?.merged(self.spectrum(lines, &met, outputs)?);
        self.with_maxima(lines, found, outputs).map(Some)
    }

    /// Returns equal steps of the speed, and their range (rad/s), if the scenario gives a largest speed.
    fn steps(&self) -> Option<(Vec<f64>, [f64; 2])> {
        let largest = self.largest_speed?;
        let part = |k: u32| LOWEST + (1.0 - LOWEST) * f64::from(k) / f64::from(SPEEDS - 1);
        let steps: Vec<f64> = (0..SPEEDS).map(|k| largest * part(k)).collect();
        Some((steps.clone(), [steps[0], largest]))
    }

    /// Returns the orders of all harmonics.
    fn orders(&self) -> Vec<f64> {
        self.harmonics.chunk_by(|a, b| a.order == b.order).map(|same| same[0].order).collect()
    }

    /// Returns a spectrum with the largest maxima of the rms of each output between its speeds.
    fn with_maxima(
        &self,
        lines: &LineLoop<'_>,
        spectrum: WheelSpectrum,
        outputs: &[usize],
    ) -> Result<WheelSpectrum, ConfigError> {
        let exact = self.spectrum(lines, &self.maxima(lines, &spectrum, outputs)?, outputs)?;
        Ok(spectrum.merged(exact))
    }

    /// Finds the speeds of the largest maxima of the rms of each output between those of a spectrum.
    fn maxima(
        &self,
        lines: &LineLoop<'_>,
        spectrum: &WheelSpectrum,
        outputs: &[usize],
    ) -> Result<Vec<f64>, ConfigError> {
        let mut tops: Vec<(usize, [f64; 3], [f64; 3])> = Vec::new();
        for (output, rms) in spectrum.rms.iter().enumerate() {
            let is_top = |place: &usize| rms[*place] > rms[place - 1] && rms[*place] >= rms[place + 1];
            let mut own: Vec<usize> = (1..rms.len().max(1) - 1).filter(is_top).collect();
            own.sort_by(|a, b| rms[*b].total_cmp(&rms[*a]));
            let around = |place: usize, values: &[f64]| [values[place - 1], values[place], values[place + 1]];
            let top = |place| (outputs[output], around(place, &spectrum.speed_rad_s), around(place, rms));
            tops.extend(own.into_iter().take(MOST_MAXIMA).map(top));
        }
        let find = |(output, speeds, values): &(usize, [f64; 3], [f64; 3])| {
            let mut fault = None;
            let value = |speed: f64| match self.spectrum(lines, &[speed], &[*output]) {
                Ok(spectrum) => spectrum.rms[0][0],
                Err(why) => {
                    fault.get_or_insert(why);
                    f64::NAN
                }
            };
            let speed = resonance(value, *speeds, *values);
            fault.map_or(Ok(speed), Err)
        };
        tops.par_iter().map(find).collect()
    }

    /// Computes the lines of some outputs at speeds of the wheels (rad/s): each harmonic of each wheel alone.
    ///
    /// # Errors
    /// See [`LineLoop::lines`].
    pub fn lines(
        &self,
        lines: &LineLoop<'_>,
        speeds: &[f64],
        outputs: &[usize],
    ) -> Result<Vec<WheelLines>, ConfigError> {
        let at = |speed: &f64| -> Result<Vec<WheelLines>, ConfigError> {
            let own = lines.at_wheel_speed(*speed)?;
            let lines = own.as_ref().unwrap_or(lines);
            let mut found = Vec::new();
            for same in self.harmonics.chunk_by(|a, b| a.order == b.order) {
                let strength = speed * speed;
                let load = |harmonic: &WheelHarmonic| SineLoad {
                    cosine: &harmonic.load.cosine * strength,
                    sine: &harmonic.load.sine * strength,
                };
                let loads: Vec<SineLoad> = same.iter().map(load).collect();
                let all = lines.lines(same[0].order * speed, &loads, outputs)?;
                found.extend(same.iter().zip(all).map(|(harmonic, outputs)| WheelLines {
                    speed_rad_s: *speed,
                    wheel: harmonic.wheel,
                    order: harmonic.order,
                    outputs,
                }));
            }
            Ok(found)
        };
        let found: Vec<Vec<WheelLines>> = speeds.par_iter().map(at).collect::<Result<_, _>>()?;
        Ok(found.into_iter().flatten().collect())
    }
}

/// Returns the largest speed of the wheels (rad/s) that their keys give: their limit, or the largest of their speeds.
fn largest_speed(wheels: &Wheels) -> Option<f64> {
    let by_momentum = wheels.momentum.map(|momentum| momentum.get() / wheels.inertia.get());
    let limit = wheels.speed_limit.map(Positive::get).or(by_momentum);
    limit.or(Some(wheels.largest_initial_speed())).filter(|speed| *speed > 0.0)
}

/// Returns a harmonic as a load on the rates of the body and its modes.
fn load(body: &ThreeAxisModel, line: &HarmonicLine) -> SineLoad {
    let hub = body.coupling.as_ref().map_or(&[][..], |coupling| &coupling.rotations);
    let column = |part: usize| {
        let torque = &line.torque[part];
        load_column(body, torque, |mode| {
            let turned = hub.get(mode).map_or(0.0, |turned| turned.dot(torque));
            turned + line.forces[part].get(mode).copied().unwrap_or(0.0)
        })
    };
    SineLoad { cosine: column(0), sine: column(1) }
}
