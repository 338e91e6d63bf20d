//! Scenario of a log, of which only the rows are used: parts that a program has supplied are not started.

use std::collections::BTreeMap;
use std::sync::Arc;

use flexsc_control::adaptation::{AdaptationFacts, AdaptationSpec};
use flexsc_control::custom::Custom;
use flexsc_control::law::{LawFacts, LawSpec};
use flexsc_control::sensor::SensorKind;
use flexsc_formats::document::{Document, ScenarioError};
use flexsc_record::Log;
use serde::{Deserialize, Serialize};
use toml::{Table, Value};

use super::custom_parts::{ACTUATOR, SENSOR, is_own, open_law, stage_laws};
use super::{CustomParts, Scenario, ScenarioSpec};

/// Facts about the custom parts of a run that figures of its log show, and that its scenario cannot hold.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
struct CustomFacts {
    /// Facts about a law that acts throughout.
    #[serde(skip_serializing_if = "Option::is_none")]
    law: Option<LawFacts>,
    /// Facts about the laws of modes of operation by their names, or of stages by their numbers.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    stage_laws: BTreeMap<String, LawFacts>,
    /// Facts about sensors by their indices.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    sensors: BTreeMap<usize, SensorFacts>,
    /// Facts about the adaptation.
    #[serde(skip_serializing_if = "Option::is_none")]
    adaptation: Option<AdaptationFacts>,
}

/// Facts about a custom sensor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct SensorFacts {
    /// Period (s).
    period_s: f64,
    /// Standard deviation of the measured angle (rad).
    noise_rad: f64,
    /// Standard deviation of the measured rate (rad/s), if it measures rates.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    rate_noise_rad_s: Option<f64>,
}

impl ScenarioSpec {
    /// Returns the facts about the custom parts that a log keeps as JSON; `None` without such parts.
    pub fn custom_facts(&self) -> Option<String> {
        let own = self.custom_parts();
        if own.each().is_empty() {
            return None;
        }
        let sensor = |(place, _): &(usize, _)| {
            let kind: &SensorKind = &self.sensor[*place];
            let period_s = kind.period(None)?.seconds();
            let facts =
                SensorFacts { period_s, noise_rad: kind.angle_noise(), rate_noise_rad_s: kind.rate_noise(0) };
            Some((*place, facts))
        };
        let facts = CustomFacts {
            law: own.law.as_deref().map(LawFacts::from_law),
            stage_laws: own
                .stage_laws
                .iter()
                .map(|(stage, law)| (stage.clone(), LawFacts::from_law(&**law)))
                .collect(),
            sensors: own.sensors.iter().filter_map(sensor).collect(),
            adaptation: own.adaptation.as_deref().map(AdaptationFacts::from_adaptation),
        };
        serde_json::to_string(&facts).ok()
    }
}

impl CustomFacts {
    /// Reads the facts in a log; without facts, or with others, those that every part has.
    fn from_json(text: Option<&str>) -> Self {
        text.and_then(|text| serde_json::from_str(text).ok()).unwrap_or_default()
    }

    /// Returns a law that has these facts, and is not started.
    fn law(facts: Option<LawFacts>) -> Custom<dyn LawSpec> {
        Custom::new(Arc::new(facts.unwrap_or_default()))
    }

    /// Replaces the custom parts in the table of a scenario, and returns those that no text can hold.
    fn replace(mut self, table: &mut Table) -> CustomParts {
        let mut own = CustomParts::default();
        let names: Vec<Option<String>> = match table.get("mode") {
            Some(Value::Array(modes)) => {
                modes.iter().map(|mode| Some(mode.get("name")?.as_str()?.to_owned())).collect()
            }
            _ => Vec::new(),
        };
        for (index, law) in stage_laws(table).into_iter().enumerate().filter(|(_, law)| is_own(law)) {
            *law = open_law();
            let name = names.get(index).cloned().flatten().unwrap_or_else(|| index.to_string());
            let facts = self.stage_laws.remove(&name);
            own.stage_laws.push((name, Self::law(facts)));
        }
        if table.get("law").is_some_and(is_own) {
            table.remove("law");
            own.law = Some(Self::law(self.law.take()));
        }
        if table.get("estimator").is_some_and(is_own) {
            table.remove("estimator");
        }
        if table.get("adaptation").is_some_and(is_own) {
            table.remove("adaptation");
            let facts = self.adaptation.take();
            own.adaptation = facts.map(|facts| Custom::<dyn AdaptationSpec>::new(Arc::new(facts)));
        }
        for (role, word) in [("sensor", SENSOR), ("actuator", ACTUATOR)] {
            let parts = match table.get_mut(role) {
                Some(Value::Array(parts)) => parts.iter_mut().collect(),
                Some(part) => vec![part],
                None => Vec::new(),
            };
            for (index, part) in parts.into_iter().enumerate().filter(|(_, part)| is_own(part)) {
                let sampled = self.sensors.get(&index).filter(|_| role == "sensor");
                *part = sampled.map_or_else(|| Value::String(word.to_owned()), SensorFacts::sampled);
            }
        }
        own
    }
}

impl SensorFacts {
    /// Returns the table of a sampled sensor with the period and the noises.
    fn sampled(&self) -> Value {
        let keys = [
            ("period", Some(self.period_s)),
            ("noise", Some(self.noise_rad)),
            ("rate_noise", self.rate_noise_rad_s),
        ];
        let keys = keys.into_iter().filter_map(|(key, value)| Some((key.to_owned(), Value::Float(value?))));
        Value::Table(Table::from_iter([("sampled".to_owned(), Value::Table(keys.collect()))]))
    }
}

impl Scenario {
    /// Reads the scenario of a log, of which only the rows are used. A part that a program has supplied is not started: in its
    /// place is one that has the same facts and does nothing, so that the run of the scenario would be another one.
    ///
    /// # Errors
    /// Fails if the text is no scenario.
    pub fn parse_logged(origin: &str, text: &str, log: &Log) -> Result<Self, ScenarioError> {
        if log.own_parts().is_none() {
            return Self::parse(origin, text);
        }
        let mut table = Document::parse(origin, text.to_owned())?.table().clone();
        let own = CustomFacts::from_json(log.own_part_facts()).replace(&mut table);
        let document = Document::from_table(origin, table);
        let document = &*document.in_si::<super::ScenarioSpec>(super::units)?;
        let (written, model) = Self::assembled(document, None, &own)?;
        Self::resolved(written, model).and_then(Self::planned).map_err(|fault| document.at_key(&fault))
    }
}
