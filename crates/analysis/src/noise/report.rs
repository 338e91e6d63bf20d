//! Noise of the outputs of a loop in numbers: rms by source, densities, and indices over windows.

use std::f64::consts::TAU;

use flexsc_control::law::LawKind;
use flexsc_formats::document::ConfigError;
use flexsc_formats::reader_units::ReaderUnits;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value as Json;

use super::density::cumulative_rms;
use super::energy_circle::EnergyCircle;
use super::image_contrast::{ImageBlur, ImageFactors};
use super::line_source::LineSource;
use super::lines::LineLoop;
use super::noisy_loop::{NoiseError, NoisyLoop};
use super::output::output_index;
use super::required_contrast::RequiredContrast;
use super::source_motion::SourceMotion;
use super::spectral_line::SpectralLine;
use super::vibration::Vibration;
use super::wheel_spectrum::WheelSpectrum;
use super::window_rms::{WindowRms, square_within};
use super::windows::Window;
use crate::fine_mirror::MirrorSensitivity;
use flexsc_scenario::Scenario;

/// Largest number of speeds of the wheels.
const MOST_SPEEDS: usize = 2000;
/// Smallest and largest angle of a pixel (rad).
const LEAST_PIXEL: f64 = 1e-12;
const MOST_PIXEL: f64 = 1.0;

/// Request for the noise of a loop.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NoiseRequest {
    /// Names of outputs, or `all`; empty for measured angles and lines of sight.
    pub signals: Vec<String>,
    /// Window of the indices, if there is one.
    pub window: Option<Window>,
    /// Angle of a pixel (rad), at whose Nyquist frequency the contrast of the image is wanted: over an exposure as long as the
    /// window, or without a window over one without end.
    pub pixel: Option<f64>,
    /// Steady rate of the image (rad/s) during an exposure as long as the window, for the factor of its smear.
    pub smear: Option<f64>,
    /// Wavelength over the diameter of a circular aperture (rad), for the factor of its diffraction.
    pub diffraction: Option<f64>,
    /// Speeds of the wheels (rad/s) for the lines of their imbalance; none for steps up to their largest and the peaks between.
    pub speeds: Option<Vec<f64>>,
}

impl NoiseRequest {
    /// Checks what is asked of an image.
    fn check_image(&self) -> Result<(), &'static str> {
        let is_angle = |value: f64| value.is_finite() && value >= 0.0;
        match (self.smear, self.diffraction) {
            (Some(_), _) if self.window.is_none() || self.pixel.is_none() => {
                Err("smear needs a window, the exposure, and a pixel")
            }
            (_, Some(_)) if self.pixel.is_none() => Err("diffraction needs a pixel"),
            (Some(rate), _) if !is_angle(rate) => Err("smear must be a rate from 0 on"),
            (_, Some(angle)) if !is_angle(angle) => Err("diffraction must be an angle from 0 on"),
            _ => Ok(()),
        }
    }
}

/// Noise of some outputs of a loop.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "NoiseSpectrum")]
pub struct NoiseReport {
    /// Largest magnitude of a pole of the closed loop over a period.
    pub spectral_radius: f64,
    /// Period (s) after which the loop repeats.
    pub period_s: f64,
    /// Samples of the law in a period.
    pub samples: usize,
    /// Nyquist frequency of the law (Hz).
    pub nyquist_hz: f64,
    /// Sources of noise: keys of the scenario.
    pub sources: Vec<String>,
    /// Frequencies of the densities (Hz): up to the Nyquist frequency, and as far as broadband loads and lines of machines go.
    pub frequency_hz: Vec<f64>,
    /// Noise of each output.
    #[schemars(extend("x-key" = "output"))]
    pub outputs: Vec<OutputNoise>,
    /// Further factors of the contrast, if a pixel is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub image: Option<ImageFactors>,
    /// Circles of the energy of an image by noise and broadband loads, for each line of sight, if a pixel is given: over the exposures.
    #[schemars(extend("x-key" = "line"))]
    pub circles: Vec<EnergyCircle>,
    /// Contrasts of images that requirements ask for.
    #[schemars(extend("x-key" = "name"))]
    pub contrasts: Vec<RequiredContrast>,
    /// Lines of the imbalance of the wheels, if they have one.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<Json>", extend("x-type" = "WheelSpectrum | None"))]
    pub wheels: Option<WheelSpectrum>,
    /// Sensitivities of the fine mirrors of lines of sight, over frequency.
    #[schemars(extend("x-key" = "line"))]
    pub mirrors: Vec<MirrorSensitivity>,
}

/// Noise of an output, in its unit.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct OutputNoise {
    /// Name of the output.
    pub output: String,
    /// Unit of the output.
    pub unit: String,
    /// Rms over time.
    pub rms: f64,
    /// Rms at the samples of the law.
    pub sample_rms: f64,
    /// Rms over time from each source.
    #[schemars(extend("x-names" = "sources"))]
    pub rms_by_source: Vec<f64>,
    /// One-sided power spectral density (unit² per Hz): of noise at the samples, of broadband loads of the motion itself.
    pub density: Vec<f64>,
    /// Density from each source (unit² per Hz).
    #[schemars(extend("x-names" = "sources"))]
    pub density_by_source: Vec<Vec<f64>>,
    /// Rms up to each frequency.
    pub cumulative_rms: Vec<f64>,
    /// Indices over windows, if a window is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub window: Option<WindowRms>,
    /// Lines of machines, each at its worst frequency for the output; none without such machines.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-key" = "source"))]
    pub machines: Option<Vec<MachineLines>>,
    /// Modulation transfer of the noise at the Nyquist frequency of the pixels, if a pixel is given and the output is an angle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mtf: Option<f64>,
}

/// Lines of a machine at its worst frequency for an output, in the unit of the output.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[schemars(extend("x-dict" = true))]
pub struct MachineLines {
    /// Key of the machine.
    pub source: String,
    /// Frequency of the machine in its tolerance at which the rms, within windows if there are any, is largest (rad/s).
    pub frequency_rad_s: f64,
    /// Rms of all lines.
    pub rms: f64,
    /// Largest deviation over time, without what sampling makes of the lines.
    pub peak: f64,
}

impl NoiseReport {
    /// Computes the noise of a scenario's loop, and the lines of its wheels.
    ///
    /// # Errors
    /// See [`NoisyLoop::from_scenario`]; a loop without noise, and a request for an output, a window or speeds that there
    /// are not.
    pub fn from_scenario(scenario: &Scenario, request: &NoiseRequest) -> Result<Self, NoiseError> {
        request.check_image().map_err(|why| NoiseError::Request(why.to_owned()))?;
        let is_open = (0..3).any(|axis| matches!(scenario.law.about(axis), LawKind::Open(_)));
        if is_open && scenario.disturbance.iter().any(|own| own.density.is_some()) {
            let why = "leaves the body free, which answers a slow force with 1/f²: what a `density` does below its corner or its table decides \
                       how far it drifts; give a law that holds the body";
            return Err(NoiseError::Key(ConfigError::new("law.open", why)));
        }
        let noisy = NoisyLoop::from_scenario(scenario)?;
        let outputs = chosen(&noisy, &request.signals)?;
        let lines = LineLoop::from_scenario(scenario)?;
        let measure = |_: usize, lines: &[SpectralLine]| square_within(lines, request.window);
        let vibration = Vibration::new(&lines, &outputs, &measure, &noisy.frequency_grid())?;
        let wheels = wheel_spectrum(&lines, request.speeds.clone(), &outputs)?;
        let wheels = match request.window {
            Some(window) => wheels.map(|wheels| wheels.over_windows(window)),
            None => wheels,
        };
        if noisy.sources.is_empty() && vibration.sources.is_empty() && wheels.is_none() {
            let why =
                "has no noise: neither sensors nor `disturbance` have any, and no wheels have `imbalance`";
            return Err(NoiseError::Key(ConfigError::new("sensor", why)));
        }
        let mut report = Self::new(&noisy, &outputs, request.window).map_err(NoiseError::Request)?;
        report.wheels = wheels;
        if !vibration.sources.is_empty() {
            report.add_vibration(&noisy, &outputs, &vibration);
        }
        report.mirrors = MirrorSensitivity::all(scenario);
        report.contrasts = RequiredContrast::all(scenario)?;
        if let Some(pixel) = request.pixel {
            report.add_contrast(&noisy, (&outputs, &vibration), pixel).map_err(NoiseError::Request)?;
            let smear = request.smear.zip(request.window).map(|(rate, window)| rate * window.length);
            report.image = Some(ImageFactors::new(pixel, request.diffraction, smear));
            let exposure = request.window.map(|window| window.length);
            report.circles = EnergyCircle::all(&noisy, &lines, exposure)?;
        }
        Ok(report)
    }

    /// Adds the modulation transfer of the motion of an image at the Nyquist frequency of pixels of an angle (rad), during windows if
    /// there are any: of the noise, and of the noise and the lines of the wheels at each speed.
    fn add_contrast(
        &mut self,
        noisy: &NoisyLoop,
        (outputs, vibration): (&[usize], &Vibration),
        pixel: f64,
    ) -> Result<(), String> {
        if !(LEAST_PIXEL..=MOST_PIXEL).contains(&pixel) {
            let [least, most, got] =
                [LEAST_PIXEL, MOST_PIXEL, pixel].map(|angle| ReaderUnits::Engineering.quantity(angle, "rad"));
            return Err(format!("pixel must be {least} to {most}, got {got}"));
        }
        let nyquist = 0.5 / pixel;
        let fastest = self.wheels.as_ref().map_or(0.0, WheelSpectrum::highest_frequency);
        let mut over_speed = Vec::new();
        for (place, own) in self.outputs.iter_mut().enumerate().filter(|(_, own)| own.unit == "rad") {
            let exposure = own.window.map(|window| window.window_s);
            let blur = ImageBlur::new(noisy, vibration, outputs[place], (exposure, fastest))?;
            own.mtf = Some(blur.contrast(nyquist, &[]));
            over_speed.push((place, blur));
        }
        if over_speed.is_empty() {
            return Err("pixel needs an output that is an angle, such as a line of sight".to_owned());
        }
        if let Some(wheels) = &mut self.wheels {
            wheels.add_contrast(nyquist, &over_speed);
        }
        Ok(())
    }

    /// Adds the motion of the outputs under machines.
    fn add_vibration(&mut self, noisy: &NoisyLoop, outputs: &[usize], vibration: &Vibration) {
        let sampled = std::mem::replace(&mut self.frequency_hz, vibration.frequency_hz.clone());
        let within = self.frequency_hz.partition_point(|frequency| *frequency <= self.nyquist_hz);
        let densities = noisy.densities(outputs, &self.frequency_hz[..within]);
        self.sources.extend(vibration.sources.iter().cloned());
        for ((own, output), mut density) in self.outputs.iter_mut().zip(outputs).zip(densities) {
            let sources = vibration.outputs.get(output).map_or(&[][..], |sources| sources);
            let all_lines = || sources.iter().flat_map(|source| &source.lines);
            let variance = |rms: f64, of: fn(&SourceMotion) -> f64| {
                f64::sqrt(rms * rms + sources.iter().map(of).sum::<f64>())
            };
            own.rms = variance(own.rms, SourceMotion::variance);
            own.sample_rms = variance(own.sample_rms, |source| source.sample_variance);
            own.rms_by_source.extend(sources.iter().map(|source| source.variance().sqrt()));
            own.window = own.window.map(|window| window.with_lines(all_lines().copied()));
            let machine = |(source, motion): (&String, &SourceMotion)| {
                let worst = motion.worst?;
                Some(MachineLines {
                    source: source.clone(),
                    frequency_rad_s: worst.frequency,
                    rms: motion.variance().sqrt(),
                    peak: worst.peak,
                })
            };
            let machines: Vec<MachineLines> =
                vibration.sources.iter().zip(sources).filter_map(machine).collect();
            own.machines = Some(machines).filter(|machines| !machines.is_empty());
            let of_noise = |at: f64| {
                let next = sampled.partition_point(|frequency| *frequency <= at);
                next.checked_sub(1).map_or(0.0, |last| own.cumulative_rms[last] * own.cumulative_rms[last])
            };
            let mut lines: Vec<&SpectralLine> = all_lines().collect();
            lines.sort_by(|a, b| a.frequency_rad_s.total_cmp(&b.frequency_rad_s));
            let (mut lines, mut below) = (lines.into_iter().peekable(), 0.0);
            let cumulative = self.frequency_hz.iter().map(|frequency| {
                while let Some(line) = lines.next_if(|line| line.frequency_rad_s <= TAU * frequency) {
                    below += line.mean_square();
                }
                f64::sqrt(of_noise(*frequency) + below)
            });
            own.cumulative_rms = cumulative.collect();
            density.by_source.extend(sources.iter().map(|source| source.density.clone().unwrap_or_default()));
            density.by_source.iter_mut().for_each(|list| list.resize(self.frequency_hz.len(), 0.0));
            let at = |place: usize| density.by_source.iter().map(|list| list[place]).sum();
            own.density = (0..self.frequency_hz.len()).map(at).collect();
            own.density_by_source = density.by_source;
        }
    }

    /// Computes the noise of some outputs, with their indices over windows if there is a window.
    ///
    /// # Errors
    /// See [`NoisyLoop::window_variances`].
    pub fn new(noisy: &NoisyLoop, outputs: &[usize], window: Option<Window>) -> Result<Self, String> {
        let frequency_hz = noisy.frequency_grid();
        let densities = noisy.densities(outputs, &frequency_hz);
        let (mean, sampled) = (noisy.mean_variances(outputs), noisy.sample_variances(outputs));
        let mut found = Vec::with_capacity(outputs.len());
        for (place, density) in densities.into_iter().enumerate() {
            let output = &noisy.outputs[outputs[place]];
            let rms = |variances: &[f64]| f64::sqrt(variances.iter().sum());
            found.push(OutputNoise {
                output: output.name.clone(),
                unit: output.unit.clone(),
                rms: rms(&mean[place]),
                sample_rms: rms(&sampled[place]),
                rms_by_source: mean[place].iter().map(|variance| f64::sqrt(*variance)).collect(),
                cumulative_rms: cumulative_rms(&frequency_hz, &density.total),
                density: density.total,
                density_by_source: density.by_source,
                window: window.map(|window| WindowRms::new(noisy, outputs[place], window)).transpose()?,
                machines: None,
                mtf: None,
            });
        }
        Ok(Self {
            spectral_radius: noisy.spectral_radius,
            period_s: noisy.period,
            samples: noisy.samples,
            nyquist_hz: noisy.nyquist(),
            sources: noisy.sources.clone(),
            frequency_hz,
            outputs: found,
            image: None,
            circles: Vec::new(),
            contrasts: Vec::new(),
            wheels: None,
            mirrors: Vec::new(),
        })
    }
}

/// Returns the indices of the outputs of these names.
fn chosen(noisy: &NoisyLoop, names: &[String]) -> Result<Vec<usize>, NoiseError> {
    if names.is_empty() {
        return Ok(noisy.first_outputs());
    }
    if names.iter().any(|name| name == "all") {
        return Ok((0..noisy.outputs.len()).collect());
    }
    let index = |name: &String| output_index(&noisy.outputs, name).map_err(NoiseError::Request);
    names.iter().map(index).collect()
}

/// Returns the lines of a loop's wheels; `None` if they have no imbalance.
fn wheel_spectrum(
    lines: &LineLoop<'_>,
    speeds: Option<Vec<f64>>,
    outputs: &[usize],
) -> Result<Option<WheelSpectrum>, NoiseError> {
    let Some(source) = LineSource::of_wheels(lines.parts.scenario)? else {
        return match speeds {
            Some(_) => {
                let why = "speeds: the scenario has no `actuator.wheels.imbalance`";
                Err(NoiseError::Request(why.to_owned()))
            }
            None => Ok(None),
        };
    };
    if let Some(given) = &speeds {
        let wrong = given.iter().find(|speed| !(**speed > 0.0 && speed.is_finite()));
        if wrong.is_some() || given.is_empty() || given.len() > MOST_SPEEDS {
            let got = wrong.map_or_else(
                || format!("{} of them", given.len()),
                |speed| ReaderUnits::Engineering.rotor_speed().quantity(*speed),
            );
            let why = format!("speeds must be positive, and from 1 to {MOST_SPEEDS} of them, got {got}");
            return Err(NoiseError::Request(why));
        }
    }
    Ok(Some(match speeds {
        Some(speeds) => WheelSpectrum::new(&source, lines, &speeds, outputs)?,
        None => WheelSpectrum::refined(&source, lines, outputs)?,
    }))
}
