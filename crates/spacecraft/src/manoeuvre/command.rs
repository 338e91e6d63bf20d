//! Kinds of command that turn a body.

use flexsc_dynamics::axis_model::AxisMode;
use flexsc_dynamics::waveform::Waveform;
use flexsc_formats::document::ConfigError;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::series::{self, SeriesCoefficients, SeriesFamily};
use super::suppression::{self, Suppression, Zero};
use super::task::RestToRestTask;
use super::{bang_bang, minimum_energy, minimum_peak, polynomial};

/// The kinds of command.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "Command")]
pub enum ManoeuvreCommand {
    /// A series of sines (\[Rotation\], equations (19) to (24)).
    Sine(Suppression),
    /// A series of cosines (\[Rotation\], equations (25) to (30)).
    Cosine(Suppression),
    /// Full torque one way, then full torque the other way: the smallest peak that turns the rigid body.
    BangBang(BangBang),
    /// The command with the smallest integral of its square.
    MinimumEnergy(Suppression),
    /// The command with the smallest peak.
    MinimumPeak(MinimumPeak),
    /// A polynomial for the angle.
    Polynomial(PolynomialCommand),
}

/// A bang-bang command; it has no parameters.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BangBang {}

/// The command with the smallest peak that leaves modes at rest.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MinimumPeak {
    /// Number of modes left at rest, lowest frequencies first.
    #[serde(default)]
    pub suppress: usize,
}

/// A polynomial for the angle.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Polynomial")]
pub struct PolynomialCommand {
    /// Degree of the polynomial: 3, 5, 7, 9, 11 or 13.
    pub degree: u32,
}

impl ManoeuvreCommand {
    /// Returns the key of the command's table under `[manoeuvre.command]`.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Sine(_) => "sine",
            Self::Cosine(_) => "cosine",
            Self::BangBang(_) => "bang_bang",
            Self::MinimumEnergy(_) => "minimum_energy",
            Self::MinimumPeak(_) => "minimum_peak",
            Self::Polynomial(_) => "polynomial",
        }
    }

    /// Returns the zeros of the command for a body's modes, or an error in its parameters.
    pub fn zeros(&self, modes: &[AxisMode]) -> Result<Vec<Zero>, ConfigError> {
        let place = format!("command.{}", self.kind());
        match self {
            Self::Sine(own) | Self::Cosine(own) | Self::MinimumEnergy(own) => own.zeros(modes, &place),
            Self::MinimumPeak(own) => suppression::lowest(own.suppress, modes, &place),
            Self::BangBang(_) => Ok(Vec::new()),
            Self::Polynomial(own) if polynomial::DEGREES.contains(&own.degree) => Ok(Vec::new()),
            Self::Polynomial(own) => {
                let why = format!("must be 3, 5, 7, 9, 11 or 13, got {}", own.degree);
                Err(ConfigError::new(format!("{place}.degree"), why))
            }
        }
    }

    /// Plans the command that performs a task and has the given zeros; also returns its amplitudes if it is a series.
    pub fn waveform(
        &self,
        task: &RestToRestTask,
        zeros: &[Zero],
    ) -> Result<(Waveform, Option<SeriesCoefficients>), ConfigError> {
        let series = |family| {
            let (waveform, coefficients) = series::plan(family, task, zeros);
            Ok((waveform, Some(coefficients)))
        };
        match self {
            Self::Sine(_) => series(SeriesFamily::Sine),
            Self::Cosine(_) => series(SeriesFamily::Cosine),
            Self::BangBang(_) => Ok((bang_bang::plan(task), None)),
            Self::MinimumEnergy(_) => Ok((minimum_energy::plan(task, zeros)?, None)),
            Self::MinimumPeak(_) => Ok((minimum_peak::plan(task, zeros)?, None)),
            Self::Polynomial(own) => Ok((polynomial::plan(task, own.degree), None)),
        }
    }
}
