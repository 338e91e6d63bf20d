//! Drift of natural frequencies: each is its initial value times a ratio that follows a profile.

use flexsc_numerics::quantity::{Finite, NonNegative, Positive, Time};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Number of terms of a Taylor series.
pub const SERIES: usize = 21;

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

impl DriftProfile {
    /// Returns the ratio at a time (s).
    pub fn ratio(&self, t: f64) -> f64 {
        match self {
            Self::Ramp(ramp) => {
                let part = ((t - ramp.from.get()) / ramp.time.get()).clamp(0.0, 1.0);
                1.0 + (ramp.to.get() - 1.0) * part
            }
            Self::Sinusoid(s) => {
                let cosine_at =
                    |t: f64| libm::cos(std::f64::consts::TAU * (t + s.phase.get()) / s.period.get());
                1.0 + s.amplitude.get() * (cosine_at(t) - cosine_at(0.0))
            }
            Self::Table(points) => {
                let after = points.iter().position(|point| point.time.get() > t);
                match (after, points.as_slice()) {
                    (_, []) => 1.0,
                    (Some(0), [first, ..]) => first.ratio.get(),
                    (None, [.., last]) => last.ratio.get(),
                    (Some(after), _) => {
                        let (a, b) = (points[after - 1], points[after]);
                        let part = (t - a.time.get()) / (b.time.get() - a.time.get());
                        a.ratio.get() + part * (b.ratio.get() - a.ratio.get())
                    }
                }
            }
        }
    }

    /// Returns the derivative of the ratio with time (1/s); at a kink, the right-hand derivative.
    pub fn slope(&self, t: f64) -> f64 {
        match self {
            Self::Ramp(ramp) => {
                let during = (ramp.from.get()..ramp.from.get() + ramp.time.get()).contains(&t);
                if during { (ramp.to.get() - 1.0) / ramp.time.get() } else { 0.0 }
            }
            Self::Sinusoid(s) => {
                let rate = std::f64::consts::TAU / s.period.get();
                -s.amplitude.get() * rate * libm::sin(rate * (t + s.phase.get()))
            }
            Self::Table(points) => {
                let pair = points.windows(2).find(|pair| pair[0].time.get() <= t && t < pair[1].time.get());
                pair.map_or(0.0, |pair| {
                    (pair[1].ratio.get() - pair[0].ratio.get()) / (pair[1].time.get() - pair[0].time.get())
                })
            }
        }
    }

    /// Writes the Taylor series of the ratio at a time (s), at a kink from the right, and returns the number of leading
    /// terms that can differ from 0.
    pub fn series(&self, t: f64, terms: &mut [f64; SERIES]) -> usize {
        // By rounding, a kink may be a last bit later than `t`.
        let after = t * (1.0 + 4.0 * f64::EPSILON) + 1e-14;
        (terms[0], terms[1]) = (self.ratio(t), self.slope(after));
        let Self::Sinusoid(s) = self else { return if terms[1] == 0.0 { 1 } else { 2 } };
        let rate = std::f64::consts::TAU / s.period.get();
        let (sin, cos) = libm::sincos(rate * (t + s.phase.get()));
        // The derivatives of the cosine repeat after four.
        let round = [cos, -sin, -cos, sin];
        let mut scale = s.amplitude.get();
        for (n, term) in terms.iter_mut().enumerate().skip(1) {
            scale *= rate / n as f64;
            *term = scale * round[n % 4];
        }
        SERIES
    }

    /// Returns the times (s) at which the slope jumps.
    pub fn kinks(&self) -> Vec<f64> {
        match self {
            Self::Ramp(ramp) => vec![ramp.from.get(), ramp.from.get() + ramp.time.get()],
            Self::Sinusoid(_) => Vec::new(),
            Self::Table(points) => points.iter().map(|point| point.time.get()).collect(),
        }
    }
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

impl Drift {
    /// Returns the ratio of a mode at a time (s).
    pub fn ratio(&self, mode: usize, t: f64) -> f64 {
        match self {
            Self::Common(profile) => profile.ratio(t),
            Self::Each(profiles) => profiles.get(mode).map_or(1.0, |profile| profile.ratio(t)),
        }
    }

    /// Returns the derivative of a mode's ratio with time (1/s); at a kink, the right-hand derivative.
    pub fn slope(&self, mode: usize, t: f64) -> f64 {
        match self {
            Self::Common(profile) => profile.slope(t),
            Self::Each(profiles) => profiles.get(mode).map_or(0.0, |profile| profile.slope(t)),
        }
    }

    /// Writes the Taylor series of a mode's ratio at a time (s), and returns the number of leading terms that can
    /// differ from 0.
    pub fn series(&self, mode: usize, t: f64, terms: &mut [f64; SERIES]) -> usize {
        match self {
            Self::Common(profile) => profile.series(t, terms),
            Self::Each(profiles) => profiles.get(mode).map_or(1, |profile| profile.series(t, terms)),
        }
    }

    /// Returns the number of profiles: one common to all modes, or one for each mode.
    pub fn count(&self) -> usize {
        match self {
            Self::Common(_) => 1,
            Self::Each(profiles) => profiles.len(),
        }
    }

    /// Returns the times (s) at which a slope jumps.
    pub fn kinks(&self) -> Vec<f64> {
        match self {
            Self::Common(profile) => profile.kinks(),
            Self::Each(profiles) => profiles.iter().flat_map(DriftProfile::kinks).collect(),
        }
    }
}
