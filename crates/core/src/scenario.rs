//! The scenario: everything that a user writes about a study, and nothing that moves.

use std::collections::BTreeMap;
use std::path::Path;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use toml::Table;
use toml::value::Datetime;

use crate::adaptation::Adaptation;
use crate::body::{Body, Planar};
use crate::document::{Document, ScenarioError, key};
use crate::estimator::{Estimator, Form};
use crate::law::Law;
use crate::quantity::{Finite, Positive};
use crate::sensor::Sensor;
use crate::time::Span;
use crate::uncertain::Distribution;

/// A scenario.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// Name of the study; left out, the name of its file.
    #[serde(default)]
    pub name: String,
    /// What the study is about.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub about: String,
    /// Seed of all randomness.
    #[serde(default)]
    pub seed: u64,
    /// Simulated time (s).
    pub duration: Span,
    /// Date and time of the start; a log counts its time from here.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<String>")]
    pub epoch: Option<Datetime>,
    /// What is controlled.
    pub body: Body,
    /// The body with its modes, as it moves: solved from `body`.
    #[serde(skip)]
    pub model: Planar,
    /// How the angle is measured.
    #[serde(default)]
    pub sensor: Sensor,
    /// What is estimated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub estimator: Option<Estimator>,
    /// What is adapted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub adaptation: Option<Adaptation>,
    /// What commands the torque.
    pub law: Law,
    /// What a full log holds.
    #[serde(default)]
    pub log: Log,
    /// What the metrics compare with.
    #[serde(default, skip_serializing_if = "Reference::is_empty")]
    pub reference: Reference,
    /// Distributions of keys that a campaign draws anew for each run.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub uncertain: BTreeMap<String, Distribution>,
}

/// What a full log holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Log {
    /// Period at which a full log holds the motion (s).
    #[serde(default = "tenth")]
    pub period: Span,
}

fn tenth() -> Span {
    Span::from_seconds(0.1)
}

impl Default for Log {
    fn default() -> Self {
        Self { period: tenth() }
    }
}

/// Levels of other runs that the metrics compare with.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Reference {
    /// Mean envelope without adaptation (rad), for the metric `envelope_reduction`; left out, the mean over
    /// the run's own first window.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub envelope: Option<Positive>,
}

impl Reference {
    fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

impl Scenario {
    /// Reads a scenario file.
    pub fn load(path: &Path) -> Result<Self, ScenarioError> {
        Self::from_document(&Document::load(path)?)
    }

    /// Reads a scenario from a text. `origin` is what errors call it.
    pub fn parse(origin: &str, text: &str) -> Result<Self, ScenarioError> {
        Self::from_document(&Document::parse(origin, text.to_owned())?)
    }

    /// Reads a scenario from a document.
    pub fn from_document(document: &Document) -> Result<Self, ScenarioError> {
        Self::solved(document, None)
    }

    /// Reads a scenario from a document that differs from another scenario in some keys. If the body is not among them,
    /// its modes are taken over.
    pub fn from_document_like(document: &Document, parent: &Self) -> Result<Self, ScenarioError> {
        Self::solved(document, Some(parent))
    }

    fn solved(document: &Document, parent: Option<&Self>) -> Result<Self, ScenarioError> {
        let mut scenario: Self = document.read()?;
        if let Some(error) = document.unread(&scenario.to_table()) {
            return Err(error);
        }
        if scenario.name.is_empty() {
            let stem = Path::new(document.origin()).file_stem();
            scenario.name = stem.unwrap_or_default().to_string_lossy().into_owned();
        }
        scenario.body.locate(Path::new(document.origin()).parent().unwrap_or(Path::new("")));
        scenario.model = match parent.filter(|parent| parent.body == scenario.body) {
            Some(parent) => parent.model.clone(),
            None => scenario.body.solve().map_err(|(key, why)| {
                document.inconsistent(&format!("body.{}.{key}", scenario.body.kind()), &why)
            })?,
        };
        match scenario.inconsistency() {
            None => Ok(scenario),
            Some((key, why)) => Err(document.inconsistent(&key, &why)),
        }
    }

    /// The scenario with all its defaults, as a table.
    pub fn to_table(&self) -> Table {
        // A scenario holds nothing that TOML cannot express.
        Table::try_from(self).unwrap_or_default()
    }

    /// The scenario with all its defaults, as TOML.
    pub fn to_toml(&self) -> String {
        toml::to_string(self).unwrap_or_default()
    }

    /// The scenario without need of any file: the matrices of a structure give way to the modes that they came to.
    #[must_use]
    pub fn self_contained(&self) -> Self {
        let mut scenario = self.clone();
        if matches!(self.body, Body::Matrices(_)) {
            scenario.body = Body::Planar(self.model.clone());
            scenario.uncertain.retain(|key, _| !key.starts_with("body.matrices"));
        }
        scenario
    }

    /// The date of the start in nanoseconds since 1970 UTC; 0 without one.
    pub fn epoch_ns(&self) -> u64 {
        self.epoch.as_ref().and_then(nanoseconds_since_1970).unwrap_or(0)
    }

    /// The JSON Schema of scenarios.
    pub fn schema() -> serde_json::Value {
        schemars::schema_for!(Scenario).to_value()
    }

    /// A viewer layout for logs of this kind of scenario.
    pub fn layout(&self) -> Option<&'static str> {
        let Law::Relay(_) = &self.law;
        Some(include_str!("../../../scenarios/layouts/relay.json"))
    }

    /// What single values cannot show to be wrong: the key, and what is wrong with it.
    fn inconsistency(&self) -> Option<(String, String)> {
        let at = |key: &str, why: String| Some((key.to_owned(), why));
        if self.name.contains(['/', '\\']) || self.name.contains(char::is_control) || self.name.len() > 200 {
            let why = "names files: it has at most 200 bytes, no slash and no control character";
            return at("name", why.to_owned());
        }
        if self.epoch.is_some_and(|epoch| nanoseconds_since_1970(&epoch).is_none()) {
            let example = "2026-03-20T14:46:00Z";
            return at("epoch", format!("must be a date and time from 1970 to 2500, such as {example}"));
        }
        // The first day of 2554 is the last whose nanoseconds fit 64 bits.
        let longest = (u64::MAX - self.epoch_ns()) as f64 / 1e9;
        if self.duration.seconds() >= longest {
            let why = format!(
                "must be below {longest:.4e} s, so that the log can count its nanoseconds from 1970, got {:e}",
                self.duration.seconds()
            );
            return at("duration", why);
        }
        let Law::Relay(relay) = &self.law;
        let (eps, gamma) = (relay.dead_zone.get(), relay.hysteresis.get());
        if gamma >= 2.0 * eps {
            return at(
                "law.relay.hysteresis",
                format!("must be less than the dead zone's width of {}, got {gamma}", 2.0 * eps),
            );
        }
        self.estimator_inconsistency().or_else(|| self.adaptation_inconsistency()).or_else(|| {
            let mut table = self.to_table();
            table.remove("uncertain");
            self.uncertain.iter().find_map(|(key, distribution)| {
                let why = distribution.problem(key::get(&table, key))?;
                Some((format!("uncertain.\"{key}\""), why))
            })
        })
    }

    fn estimator_inconsistency(&self) -> Option<(String, String)> {
        let Some(Estimator::Envelope(envelope)) = &self.estimator else { return None };
        if envelope.form == Form::Truth && envelope.modes.is_some() {
            let why = "of its own have no use for the form `truth`, which reads the body's".to_owned();
            return Some(("estimator.envelope.modes".to_owned(), why));
        }
        let own = envelope.modes.as_ref().map(|modes| ("estimator.envelope", modes.as_slice()));
        let (place, modes) = own.unwrap_or(("body.planar", &self.model.modes));
        modes.iter().enumerate().find(|(_, mode)| mode.damping.get() >= 1.0).map(|(index, mode)| {
            let why = format!("must be below 1 for a mode to have an envelope, got {}", mode.damping.get());
            match (&self.body, own) {
                (Body::Matrices(_) | Body::Panels(_), None) => {
                    (format!("body.{}.damping", self.body.kind()), why)
                }
                _ => (format!("{place}.modes[{index}].damping"), why),
            }
        })
    }

    fn adaptation_inconsistency(&self) -> Option<(String, String)> {
        let Some(Adaptation::RandomSearch(search)) = &self.adaptation else { return None };
        let [low, high] = search.bounds.map(Finite::get);
        let gain = self.law.gain();
        let bounds = "adaptation.random_search.bounds".to_owned();
        if self.estimator.is_none() {
            let why = "needs the window means of an `[estimator.envelope]`, and there is none";
            return Some(("adaptation.random_search".to_owned(), why.to_owned()));
        }
        if low >= high {
            return Some((bounds, format!("must be [low, high] in this order, got [{low}, {high}]")));
        }
        if low <= 0.0 || high >= 1.0 {
            let why = format!("must lie between 0 and 1, as k_t itself, got [{low}, {high}]");
            return Some((bounds, why));
        }
        if !(low..=high).contains(&gain) {
            let why = format!("must lie within the adaptation's bounds [{low}, {high}], got {gain}");
            return Some(("law.relay.k_t".to_owned(), why));
        }
        None
    }
}

/// Nanoseconds from 1970 to a date and time, which is UTC unless it has an offset; within 1970 to 2500.
fn nanoseconds_since_1970(epoch: &Datetime) -> Option<u64> {
    let (date, time) = (epoch.date?, epoch.time?);
    // Days from the civil calendar, in years that begin in March, so that a leap day comes last.
    let (year, month) = (i64::from(date.year), i64::from(date.month));
    let (year, month) = if month > 2 { (year, month - 3) } else { (year - 1, month + 9) };
    let days = 365 * year + year.div_euclid(4) - year.div_euclid(100)
        + year.div_euclid(400)
        + (153 * month + 2) / 5
        + i64::from(date.day)
        - 719_469;
    let offset = match epoch.offset {
        Some(toml::value::Offset::Custom { minutes }) => i64::from(minutes) * 60,
        _ => 0,
    };
    let clock =
        i64::from(time.hour) * 3600 + i64::from(time.minute) * 60 + i64::from(time.second.unwrap_or(0));
    let seconds = u64::try_from(days * 86_400 + clock - offset).ok()?;
    let nanoseconds = u64::from(time.nanosecond.unwrap_or(0));
    (date.year < 2500).then(|| seconds * 1_000_000_000 + nanoseconds)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn epochs_count_from_1970() {
        let at = |text: &str| nanoseconds_since_1970(&text.parse().expect("a date"));
        assert_eq!(at("1970-01-01T00:00:00Z"), Some(0));
        // date --utc --date=2026-03-20T14:46:00Z +%s
        assert_eq!(at("2026-03-20T14:46:00Z"), Some(1_774_017_960_000_000_000));
        assert_eq!(at("2024-02-29T23:59:59.5+01:00"), Some(1_709_247_599_500_000_000));
        assert_eq!(at("1969-12-31T23:00:00Z"), None);
        assert_eq!(at("2026-03-20"), None);
    }
}
