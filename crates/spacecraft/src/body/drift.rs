//! Drift of natural frequencies: each is its initial value times a ratio that follows a profile.

use flexsc_dynamics::frequency_drift::{FrequencyDrift, RatioProfile};
use flexsc_numerics::quantity::{Finite, NonNegative, Positive, Time};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A profile of the ratio over time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "Profile")]
pub enum DriftProfile {
    /// A linear change from 1 to another ratio, which then stays constant.
    Ramp(Ramp),
    /// 1 + amplitude (cos(2 pi (t + phase)/period) - cos(2 pi phase/period)): panels that follow the Sun on an orbit.
    Sinusoid(Sinusoid),
    /// Linear interpolation between points, constant before the first and after the last.
    Table(Vec<ProfilePoint>),
}

/// A linear change of the ratio.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ramp {
    /// Start time (s).
    #[serde(default)]
    pub from: Time,
    /// Duration (s).
    pub time: Positive,
    /// The ratio afterwards.
    pub to: Positive,
}

/// A periodic change of the ratio.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sinusoid {
    /// Half the difference between the largest and the smallest ratio.
    pub amplitude: NonNegative,
    /// Period (s).
    pub period: Positive,
    /// Time shift of the cosine at the start of the run (s).
    #[serde(default)]
    pub phase: Finite,
}

/// A point of a profile.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Point")]
pub struct ProfilePoint {
    /// Time (s).
    pub time: Time,
    /// Ratio at that time.
    pub ratio: Positive,
}

/// How the frequencies of a body drift.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Drift {
    /// All frequencies have one ratio.
    Common(DriftProfile),
    /// Each frequency has its own ratio, in the order of the modes.
    Each(Vec<DriftProfile>),
}

impl From<&DriftProfile> for RatioProfile {
    fn from(profile: &DriftProfile) -> Self {
        match profile {
            DriftProfile::Ramp(ramp) => {
                Self::Ramp { from: ramp.from.get(), time: ramp.time.get(), to: ramp.to.get() }
            }
            DriftProfile::Sinusoid(s) => {
                Self::Sinusoid { amplitude: s.amplitude.get(), period: s.period.get(), phase: s.phase.get() }
            }
            DriftProfile::Table(points) => {
                Self::Table(points.iter().map(|point| [point.time.get(), point.ratio.get()]).collect())
            }
        }
    }
}

impl From<&Drift> for FrequencyDrift {
    fn from(drift: &Drift) -> Self {
        match drift {
            Drift::Common(profile) => Self::Common(profile.into()),
            Drift::Each(profiles) => Self::Each(profiles.iter().map(Into::into).collect()),
        }
    }
}
