//! Contrast of an image that a requirement asks for: its value in the loop of a scenario, and what each source takes of it.

use flexsc_formats::document::ConfigError;
use flexsc_scenario::{ContrastRequirement, Scenario};
use schemars::JsonSchema;
use serde::Serialize;

use super::image_contrast::ImageBlur;
use super::line_source::LineSource;
use super::lines::LineLoop;
use super::noisy_loop::{NoiseError, NoisyLoop};
use super::spectral_line::SpectralLine;
use super::vibration::Vibration;
use super::wheel_spectrum::WheelSpectrum;
use crate::open_loop::{LoopBreak, LoopParts};

/// Key of the imbalance of the wheels, as a source.
const WHEELS: &str = "actuator.wheels.imbalance";
/// Spatial frequencies of the curve, and the largest relative to the required one.
const CURVE: u32 = 80;
const FARTHEST: f64 = 2.0;

/// Contrast of an image that a requirement asks for, at the worst axis of its line of sight and at the worst speed of the wheels.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct RequiredContrast {
    /// Name of the requirement.
    pub name: String,
    /// Output that moves the image: the line of sight about its worst axis.
    pub output: String,
    /// Spatial frequency (cycles/rad).
    pub spatial_frequency: f64,
    /// Length of the exposures (s); none for a long one.
    pub exposure_s: Option<f64>,
    /// Least accepted contrast.
    pub least: f64,
    /// Contrast (MTF) that the motion leaves.
    pub mtf: f64,
    /// True if the contrast is at least the accepted one.
    pub met: bool,
    /// Speed of the wheels at which it is least (rad/s), if they have imbalance.
    pub speed_rad_s: Option<f64>,
    /// Sources, that which costs most first.
    #[schemars(extend("x-key" = "source"))]
    pub costs: Vec<ContrastCost>,
    /// Contrast over the spatial frequency.
    pub curve: Vec<ContrastPoint>,
}

/// Contrast at a spatial frequency.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct ContrastPoint {
    /// Spatial frequency (cycles/rad).
    pub spatial_frequency: f64,
    /// Contrast (MTF).
    pub mtf: f64,
}

/// Contrast of an image with and without a source.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[schemars(extend("x-dict" = true))]
pub struct ContrastCost {
    /// Key of the source.
    pub source: String,
    /// Contrast with this source alone.
    pub alone: f64,
    /// Contrast with all other sources.
    pub without: f64,
}

/// Blur of one output, with the lines of the wheels at their worst speed.
struct WorstBlur {
    blur: ImageBlur,
    wheels: Vec<SpectralLine>,
    speed: Option<f64>,
    output: usize,
    mtf: f64,
}

impl RequiredContrast {
    /// Returns the contrast of each requirement of a scenario on the contrast of an image.
    ///
    /// # Errors
    /// See [`Self::from_scenario`].
    pub fn all(scenario: &Scenario) -> Result<Vec<Self>, NoiseError> {
        scenario.study.contrasts.iter().map(|own| Self::from_scenario(scenario, own)).collect()
    }

    /// Returns the contrast of a requirement in the loop of a scenario.
    ///
    /// # Errors
    /// See [`NoisyLoop::from_scenario`]; an axis along the line of sight, and an exposure that is too long for the loop.
    pub fn from_scenario(scenario: &Scenario, required: &ContrastRequirement) -> Result<Self, NoiseError> {
        Self::from_parts(&LoopParts::from_scenario(scenario, LoopBreak::Command)?, required)
    }

    /// Returns the contrast of a requirement in the loop of these parts, which are cut open at the command.
    ///
    /// # Errors
    /// See [`Self::from_scenario`].
    pub(crate) fn from_parts(
        parts: &LoopParts<'_>,
        required: &ContrastRequirement,
    ) -> Result<Self, NoiseError> {
        let noisy = NoisyLoop::from_parts(parts)?;
        let lines = LineLoop::from_parts(parts.clone())?;
        let outputs: Vec<usize> = required.outputs().iter().filter_map(|name| noisy.output(name)).collect();
        if outputs.is_empty() {
            let why = "is along the line of sight, whose rotation moves no image of it";
            return Err(ConfigError::new("axis", why).within(&required.key).into());
        }
        let frequency = required.spatial_frequency;
        let loss = |_: usize, lines: &[SpectralLine]| {
            1.0 - ImageBlur::by_lines(required.exposure, lines.to_vec()).contrast(frequency, &[])
        };
        let vibration = Vibration::new(&lines, &outputs, &loss, &[])?;
        let wheels = match LineSource::of_wheels(parts.scenario)? {
            Some(source) => Some(WheelSpectrum::refined(&source, &lines, &outputs)?),
            None => None,
        };
        let fastest = wheels.as_ref().map_or(0.0, WheelSpectrum::highest_frequency);
        let mut worst: Option<WorstBlur> = None;
        for (place, output) in outputs.iter().enumerate() {
            let blur = ImageBlur::new(&noisy, &vibration, *output, (required.exposure, fastest));
            let blur = blur.map_err(|why| too_long(required, &why))?;
            let own = WorstBlur::new(blur, (*output, place), wheels.as_ref(), frequency);
            if worst.as_ref().is_none_or(|worst| own.mtf < worst.mtf) {
                worst = Some(own);
            }
        }
        let worst = worst.ok_or_else(NoiseError::without_speed)?;
        let mut sources = [&noisy.sources[..], &vibration.sources].concat();
        sources.extend(wheels.map(|_| WHEELS.to_owned()));
        Ok(worst.judged(required, noisy.outputs[worst.output].name.clone(), &sources))
    }

    /// Returns the margin: the contrast less the accepted one.
    pub fn margin(&self) -> f64 {
        self.mtf - self.least
    }
}

impl WorstBlur {
    /// Returns the blur of an output, by its index and its place in a spectrum of wheels, at the speed at which the contrast is least.
    fn new(
        blur: ImageBlur,
        (output, place): (usize, usize),
        wheels: Option<&WheelSpectrum>,
        frequency: f64,
    ) -> Self {
        let mut worst = Self { mtf: f64::INFINITY, speed: None, wheels: Vec::new(), blur, output };
        let Some(spectrum) = wheels else {
            worst.mtf = worst.blur.contrast(frequency, &[]);
            return worst;
        };
        for (speed, lines) in spectrum.over_speed(place) {
            let mtf = worst.blur.contrast(frequency, &lines);
            if mtf < worst.mtf {
                (worst.mtf, worst.speed, worst.wheels) = (mtf, Some(speed), lines);
            }
        }
        worst
    }

    /// Returns the contrast with what each source takes of it; the wheels are the last source, if they have lines.
    fn judged(&self, required: &ContrastRequirement, output: String, sources: &[String]) -> RequiredContrast {
        let contrast = |frequency: f64, counts: &dyn Fn(usize) -> bool| {
            let wheels = if counts(sources.len() - 1) { &self.wheels[..] } else { &[] };
            self.blur.contrast_of(frequency, wheels, counts)
        };
        let frequency = required.spatial_frequency;
        let cost = |(index, source): (usize, &String)| ContrastCost {
            source: source.clone(),
            alone: contrast(frequency, &|own| own == index),
            without: contrast(frequency, &|own| own != index),
        };
        let mut costs: Vec<ContrastCost> = sources.iter().enumerate().map(cost).collect();
        costs.sort_by(|a, b| b.without.total_cmp(&a.without));
        let point = |step: u32| {
            let spatial_frequency = FARTHEST * frequency * f64::from(step) / f64::from(CURVE);
            ContrastPoint { spatial_frequency, mtf: self.blur.contrast(spatial_frequency, &self.wheels) }
        };
        RequiredContrast {
            name: required.name.clone(),
            output,
            spatial_frequency: frequency,
            exposure_s: required.exposure,
            least: required.least,
            mtf: self.mtf,
            met: self.mtf >= required.least,
            speed_rad_s: self.speed,
            costs,
            curve: (0..=CURVE).map(point).collect(),
        }
    }
}

/// Returns the fault of an exposure for which the loop has too many periods.
fn too_long(required: &ContrastRequirement, why: &str) -> NoiseError {
    let why = why.strip_prefix("window ").unwrap_or(why);
    ConfigError::new("exposure", why.to_owned()).within(&required.key).into()
}
