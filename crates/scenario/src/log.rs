//! Table `[log]`: sampling period of the motion in a full log, and options of the scene.

use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::Positive;
use flexsc_numerics::time::Span;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Shortest default period of the frames (s), because viewers show no more.
const SHORTEST_PERIOD: f64 = 0.04;

/// Largest default number of samples in a full log, because viewers take minutes to load more.
const MOST_INSTANTS: f64 = 1e4;

/// Largest magnification: anything larger is outside every picture, and its square soon overflows.
const LARGEST_FACTOR: f64 = 1e9;

/// Contents of a full log.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Log")]
pub struct LogSpec {
    /// Sampling period of the motion in a full log (s); default: the first of 0.1, 0.2, 0.5, 1, 2, 5 and so on that gives at
    /// most 10 000 samples.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub period: Option<Span>,
    /// How the scene of a log is drawn.
    #[serde(default, skip_serializing_if = "SceneSpec::is_default")]
    pub scene: SceneSpec,
}

fn tenth() -> Span {
    Span::from_seconds(0.1)
}

impl LogSpec {
    /// Returns the sampling period for runs of this duration.
    pub fn period_for(&self, duration: Span) -> Span {
        if let Some(period) = self.period {
            return period;
        }
        let least = duration.seconds() / MOST_INSTANTS;
        let decades = (-1..).map(|exponent| libm::pow(10.0, f64::from(exponent)));
        let mut periods = decades.flat_map(|decade| [1.0, 2.0, 5.0].map(|step| step * decade));
        periods.find(|period| *period >= least).map_or_else(tenth, Span::from_seconds)
    }
}

/// How the scene of a run is drawn.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SceneSpec {
    /// Period of the frames (s); default: that of the log, and at least 0.04 s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub period: Option<Span>,
    /// Magnification of the elastic motion; default: chosen so that the motion excited by the actuator or the initial state is
    /// visible.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bending: Option<Positive>,
    /// Magnification of the body's rotation; default: chosen so that it is visible.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub turning: Option<Positive>,
}

impl SceneSpec {
    /// Returns true if no option is given.
    pub fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// Checks that the magnifications are not too large; returns the error at the key.
    pub fn validate(&self) -> Option<ConfigError> {
        let factors = [("bending", self.bending), ("turning", self.turning)];
        let (key, factor) = factors.into_iter().find(|(_, f)| f.is_some_and(|f| f.get() > LARGEST_FACTOR))?;
        Some(ConfigError::new(
            key,
            format!("must be at most {LARGEST_FACTOR:e}, got {:e}", factor.map_or(0.0, Positive::get)),
        ))
    }

    /// Returns the period of the frames, for a log with period `log`.
    pub fn period(&self, log: Span) -> Span {
        self.period.unwrap_or_else(|| log.max(Span::from_seconds(SHORTEST_PERIOD)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_log_has_at_most_ten_thousand_instants() {
        for (duration, period) in [
            (1e-3, 0.1),
            (600.0, 0.1),
            (1000.0, 0.1),
            (1000.1, 0.2),
            (1500.0, 0.2),
            (20_000.0, 2.0),
            (40_000.0, 5.0),
            (86_400.0, 10.0),
            (1e6, 100.0),
        ] {
            let own = LogSpec::default().period_for(Span::from_seconds(duration));
            assert_eq!(own, Span::from_seconds(period), "{duration}: {own:?}");
        }
    }
}
