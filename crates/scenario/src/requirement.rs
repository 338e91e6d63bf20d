//! Table `[[requirement]]`: a limit on a pointing index or on a metric, or an expression over time, and how it is judged.

use std::fmt;

use flexsc_formats::document::number_in;
use flexsc_numerics::attitude::AXES;
use flexsc_numerics::quantity::{Finite, Fraction, Positive, Share, Time};
use flexsc_numerics::time::Span;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Requirement: the largest accepted value of a quantity, or what holds over time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Requirement {
    /// Name of the requirement.
    pub name: String,
    /// Expression that holds over time, such as `"always[60 s, 300 s] pointing_error < 0.1 deg"`, in place of `quantity` and `limit`;
    /// without an operator over time, always.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub holds: Option<String>,
    /// Event from which on `holds` counts, each time: `"mode enters fine"`, or a condition that becomes true.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub after: Option<String>,
    /// Longest time (s) after the event, or after the start, at which `holds` begins to hold.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub within: Option<Time>,
    /// Time (s) for which `holds` then holds.
    #[serde(default, rename = "for", skip_serializing_if = "Option::is_none")]
    pub held: Option<Time>,
    /// Mode of operation in which the requirement counts; default: all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mode: Option<String>,
    /// Condition during which the requirement counts, such as `"truth.sunlight < 0.5"` or `"blinded(star_tracker)"`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub during: Option<String>,
    /// Required quantity: `pointing_error`, `rate_error`, `line_of_sight`, the contrast `mtf` of an image, or a metric, such as
    /// `fuel_kg` or `fuel_axes_kg[2]`; of a list without an index, its largest element.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub quantity: Option<String>,
    /// Point of the line of sight, which is a `[[line_of_sight]]` of the scenario.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub point: Option<String>,
    /// Component of the error about an axis of the body; default: the norm of all components, for `mtf` the worst.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<ErrorAxis>,
    /// Pointing index of an error (ECSS-E-ST-60-10C); default: APE. A metric has none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub index: Option<PointingIndex>,
    /// Length of the index' window (s), a whole number of sampling periods; all indices but APE have one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub window: Option<Positive>,
    /// Position of the instant in its window, for RPE.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub convention: Option<WindowConvention>,
    /// Time from the start of one window to that of the other (s), at least the window, for PDE and PRE.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shift: Option<Positive>,
    /// Sampling period of the error (s). Default: the period of the law, else of the sensor, else 1 s. A line of sight
    /// is sampled with its own period.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub period: Option<Span>,
    /// Start of the part of the run that counts (s); default: 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<Time>,
    /// End of the part of the run that counts (s); default: the end of the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<Time>,
    /// Largest accepted value, in SI units or as a text with a unit that fits the quantity, such as "2 arcsec".
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limit: Option<Limit>,
    /// Spatial frequency (cycles/rad) across the image at which `mtf` is required, such as "0.5 cycles/arcsec".
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spatial_frequency: Option<Positive>,
    /// Length of the exposures (s) of the image for `mtf`; default: a long exposure, over all time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub exposure: Option<Positive>,
    /// Least accepted `mtf`, in place of a `limit`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub least: Option<Share>,
    /// Probability at which the value is at most the limit; default: 1, always and in every run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub level: Option<Share>,
    /// Statistical interpretation of the level; an error with a level below 1 needs one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub interpretation: Option<Interpretation>,
    /// Confidence at which a campaign shows the level, for the ensemble interpretation; default: none is asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub confidence: Option<Fraction>,
}

impl Requirement {
    /// Returns the keys of the pointing index of a sampled error, each with whether it is given.
    pub(super) fn index_keys(&self) -> [(&'static str, bool); 9] {
        [
            ("point", self.point.is_some()),
            ("axis", self.axis.is_some()),
            ("index", self.index.is_some()),
            ("window", self.window.is_some()),
            ("convention", self.convention.is_some()),
            ("shift", self.shift.is_some()),
            ("period", self.period.is_some()),
            ("from", self.from.is_some()),
            ("to", self.to.is_some()),
        ]
    }

    /// Returns the keys that limit a requirement to a mode or a condition, each with whether it is given.
    pub(super) fn scope_keys(&self) -> [(&'static str, bool); 2] {
        [("mode", self.mode.is_some()), ("during", self.during.is_some())]
    }

    /// Returns the keys of the event and the times of `holds`, each with whether it is given.
    pub(super) fn time_keys(&self) -> [(&'static str, bool); 3] {
        [("after", self.after.is_some()), ("within", self.within.is_some()), ("for", self.held.is_some())]
    }
}

/// Returns the first of some keys that is given.
pub(super) fn given(keys: &[(&'static str, bool)]) -> Option<&'static str> {
    keys.iter().find(|(_, is_given)| *is_given).map(|(key, _)| *key)
}

/// Component of an error about an axis of the body.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ErrorAxis {
    /// About x, or the only axis.
    X,
    /// About y.
    Y,
    /// About z.
    Z,
}

impl ErrorAxis {
    /// Returns the letter of the axis.
    pub fn letter(self) -> &'static str {
        ["x", "y", "z"][self as usize]
    }

    /// Returns the name of the axis.
    pub fn name(self) -> &'static str {
        AXES[self as usize]
    }
}

/// Pointing index of an error e(t), as ECSS-E-ST-60-10C names it.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum PointingIndex {
    /// Absolute performance error: the error itself.
    #[serde(rename = "APE")]
    Absolute,
    /// Mean performance error: the mean error over a window.
    #[serde(rename = "MPE")]
    Mean,
    /// Relative performance error: the error less its mean over a window.
    #[serde(rename = "RPE")]
    Relative,
    /// Performance drift error: the difference of the mean errors over two windows of one observation.
    #[serde(rename = "PDE")]
    Drift,
    /// Performance reproducibility error: the difference of the mean errors over windows of two observations.
    #[serde(rename = "PRE")]
    Reproducibility,
}

impl fmt::Display for PointingIndex {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Absolute => "APE",
            Self::Mean => "MPE",
            Self::Relative => "RPE",
            Self::Drift => "PDE",
            Self::Reproducibility => "PRE",
        })
    }
}

/// Position of the instant of a relative performance error in its window.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WindowConvention {
    /// Any instant of the window; consecutive windows cover the time.
    Uniform,
    /// The last sample of a window that slides.
    End,
    /// The middle sample of a window that slides; of an even number the later one of the middle two.
    Middle,
}

impl WindowConvention {
    /// Returns the word of the key.
    pub fn word(self) -> &'static str {
        match self {
            Self::Uniform => "uniform",
            Self::End => "end",
            Self::Middle => "middle",
        }
    }

    /// Returns the place of the instant in a window of a number of samples; `None` for every place of it.
    pub fn place(self, window: u64) -> Option<u64> {
        match self {
            Self::Uniform => None,
            Self::End => Some(window - 1),
            Self::Middle => Some(window / 2),
        }
    }
}

/// Statistical interpretation of a level over time and over the ensemble of runs.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Interpretation {
    /// The level is a fraction of the time, in the worst run.
    Temporal,
    /// The level is a fraction of the runs, at the worst time of each.
    #[default]
    Ensemble,
    /// The level is a fraction of the times of all runs.
    Mixed,
}

impl Interpretation {
    /// Returns the word of the key.
    pub fn word(self) -> &'static str {
        match self {
            Self::Temporal => "temporal",
            Self::Ensemble => "ensemble",
            Self::Mixed => "mixed",
        }
    }
}

/// Limit as written: a number in SI units, or a text with a unit.
#[derive(Clone, Debug, PartialEq)]
pub enum Limit {
    /// Number in the unit of the quantity.
    Number(Finite),
    /// Number with a unit.
    Text(String),
}

impl Limit {
    /// Returns the limit in a unit.
    ///
    /// # Errors
    /// A text without a number, and a unit that is unknown or does not fit.
    pub fn in_unit(&self, unit: &str) -> Result<f64, String> {
        match self {
            Self::Number(number) => Ok(number.get()),
            Self::Text(text) => number_in(text, unit),
        }
    }
}

impl Serialize for Limit {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Number(number) => number.serialize(serializer),
            Self::Text(text) => text.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for Limit {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        use serde::de::Error;
        let value = toml::Value::deserialize(deserializer)?;
        let number = value.as_float().or_else(|| Some(value.as_integer()? as f64)).and_then(Finite::new);
        match (number, value) {
            (Some(number), _) => Ok(Self::Number(number)),
            (None, toml::Value::String(text)) => Ok(Self::Text(text)),
            (None, other) => Err(D::Error::custom(format!(
                "must be a finite number, or a number with a unit, got {other}"
            ))),
        }
    }
}

impl JsonSchema for Limit {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Limit".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A number in SI units, or a text with a unit",
            "anyOf": [{"type": "number"}, {"type": "string"}]
        })
    }
}
