//! Input shapers: a command is convolved with a few impulses, which suppresses modes (\[SingerSeering90\]).

use flexsc_dynamics::axis_model::AxisMode;
use flexsc_dynamics::waveform::Waveform;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::Fraction;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::suppression::{Zero, index_error};

/// The kinds of shaper.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Shaper {
    /// Zero vibration: two impulses for each mode, half a damped period apart.
    Zv(ShapedModes),
    /// Zero vibration and derivative: three impulses.
    Zvd(ShapedModes),
    /// Zero vibration and two derivatives: four impulses.
    Zvdd(ShapedModes),
    /// Extra insensitive: three impulses that allow a little vibration at the mode's frequency, and stay near it over a wider
    /// band.
    Ei(ExtraInsensitive),
}

/// The modes that a shaper suppresses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Shaped")]
pub struct ShapedModes {
    /// Indices of the modes.
    #[serde(default = "first")]
    pub modes: Vec<usize>,
}

/// An extra-insensitive shaper.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExtraInsensitive {
    /// Indices of the modes.
    #[serde(default = "first")]
    pub modes: Vec<usize>,
    /// Residual vibration at the mode's frequency, relative to that of a single impulse.
    #[serde(default = "twentieth")]
    pub vibration: Fraction,
}

fn first() -> Vec<usize> {
    vec![0]
}

fn twentieth() -> Fraction {
    Fraction::new(0.05).expect("between 0 and 1")
}

/// Impulse of a shaper; the areas of a shaper's impulses add up to 1.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct ShaperImpulse {
    /// Delay of the impulse (s).
    pub delay: f64,
    /// Area of the impulse.
    pub area: f64,
}

impl Shaper {
    /// Returns the impulses for the shaper's modes of a body: one sequence for each mode, convolved. Those of a
    /// sequence are half a damped period apart.
    pub fn impulses(&self, modes: &[AxisMode]) -> Result<Vec<ShaperImpulse>, ConfigError> {
        let (name, indices, areas) = match self {
            Self::Zv(shaped) => ("zv", &shaped.modes, vec![1.0, 1.0]),
            Self::Zvd(shaped) => ("zvd", &shaped.modes, vec![1.0, 2.0, 1.0]),
            Self::Zvdd(shaped) => ("zvdd", &shaped.modes, vec![1.0, 3.0, 3.0, 1.0]),
            Self::Ei(ei) => {
                let v = ei.vibration.get();
                ("ei", &ei.modes, vec![1.0 + v, 2.0 - 2.0 * v, 1.0 + v])
            }
        };
        let key = format!("shaper.{name}.modes");
        if indices.is_empty() {
            return Err(ConfigError::new(key, "must hold the index of a mode, got none"));
        }
        let mut impulses = vec![ShaperImpulse { delay: 0.0, area: 1.0 }];
        for (place, &index) in indices.iter().enumerate() {
            let Some(mode) = modes.get(index) else {
                return Err(ConfigError::new(format!("{key}[{place}]"), index_error(index, modes)));
            };
            let own = sequence(&areas, &Zero::at_mode(mode));
            let later = |a: &ShaperImpulse, b: &ShaperImpulse| ShaperImpulse {
                delay: a.delay + b.delay,
                area: a.area * b.area,
            };
            impulses = impulses.iter().flat_map(|a| own.iter().map(move |b| later(a, b))).collect();
            if impulses.len() > 4096 {
                return Err(ConfigError::new(
                    key,
                    format!("must make at most 4096 impulses, got {} modes", indices.len()),
                ));
            }
        }
        Ok(impulses)
    }
}

/// Returns the impulses for one mode: each later one is reduced by the damping of the elapsed time.
fn sequence(areas: &[f64], mode: &Zero) -> Vec<ShaperImpulse> {
    let pole = mode.pole();
    let half = std::f64::consts::PI / pole.im;
    let decay = libm::exp(pole.re * half);
    let mut shrink = 1.0;
    let mut sequence = Vec::new();
    for (index, area) in areas.iter().enumerate() {
        sequence.push(ShaperImpulse { delay: index as f64 * half, area: area * shrink });
        shrink *= decay;
    }
    let sum: f64 = sequence.iter().map(|impulse| impulse.area).sum();
    for impulse in &mut sequence {
        impulse.area /= sum;
    }
    sequence
}

/// Returns a command convolved with impulses.
pub fn convolve(command: &Waveform, impulses: &[ShaperImpulse]) -> Waveform {
    let terms = impulses.iter().flat_map(|impulse| command.shifted(impulse.delay, impulse.area).terms);
    Waveform { terms: terms.collect() }
}
