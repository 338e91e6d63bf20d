//! Custom parts of a scenario: set in addition to its text, which cannot contain them, and kept when keys change.

use std::sync::Arc;

use flexsc_control::actuator::{ActuatorSpec, AssignedActuator};
use flexsc_control::adaptation::AdaptationSpec;
use flexsc_control::custom::Custom;
use flexsc_control::estimator::EstimatorSpec;
use flexsc_control::law::LawSpec;
use flexsc_control::sensor::{SensorKind, SensorSpec};
use flexsc_formats::document::{ConfigError, Document, ScenarioError};
use flexsc_record::CustomTopic;
use flexsc_record::custom_topic::CustomTopics;
use toml::{Table, Value};

use super::{Scenario, ScenarioSpec};

/// Placeholders in a text for a custom sensor and for a custom actuator.
const SENSOR: &str = "continuous";
const ACTUATOR: &str = "ideal";

/// Custom parts of a scenario: at most one law, estimator and adaptation, and any number of sensors and actuators.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CustomParts {
    /// Custom law.
    pub law: Option<Custom<dyn LawSpec + Send + Sync>>,
    /// Custom sensors, each with its index among the sensors of the scenario.
    pub sensors: Vec<(usize, Custom<dyn SensorSpec>)>,
    /// Custom estimator.
    pub estimator: Option<Custom<dyn EstimatorSpec>>,
    /// Custom adaptation.
    pub adaptation: Option<Custom<dyn AdaptationSpec>>,
    /// Custom actuators, each with its index among the actuators of the scenario.
    pub actuators: Vec<(usize, Custom<dyn ActuatorSpec>)>,
}

impl Scenario {
    /// Returns the scenario with a change of its keys, such as a custom part `law: Law::Custom(..)`.
    ///
    /// # Errors
    /// Fails if the changed scenario is inconsistent.
    pub fn with(mut self, change: impl FnOnce(&mut ScenarioSpec)) -> Result<Self, ScenarioError> {
        change(&mut self.written);
        let origin = self.name.clone();
        let fault = |fault: ConfigError| ScenarioError::Key { origin, key: fault.key, why: fault.why };
        Self::fitted(self.written, self.model).map_err(fault)
    }

    /// Reads a scenario from a document with custom parts: for roles that the document leaves out, and for sensors and
    /// actuators with a placeholder.
    ///
    /// # Errors
    /// Fails if the document is invalid or inconsistent with the parts.
    pub fn from_document_with(document: &Document, own: &CustomParts) -> Result<Self, ScenarioError> {
        Self::solved(document, None, own)
    }

    /// Returns the scenario with the parts of `own` in place of those of the same role or index, and with its other
    /// custom parts.
    ///
    /// # Errors
    /// Fails if the parts are inconsistent with the others.
    pub fn with_custom_parts(&self, own: CustomParts) -> Result<Self, ScenarioError> {
        let mut all = self.custom_parts();
        all.sensors.retain(|(place, _)| own.sensors.iter().all(|(other, _)| other != place));
        all.sensors.extend(own.sensors);
        all.actuators.retain(|(place, _)| own.actuators.iter().all(|(other, _)| other != place));
        all.actuators.extend(own.actuators);
        all.law = own.law.or(all.law);
        all.estimator = own.estimator.or(all.estimator);
        all.adaptation = own.adaptation.or(all.adaptation);
        let mut table = self.table_without_custom_parts();
        for role in all.each().into_iter().filter(|role| !["sensor", "actuator"].contains(role)) {
            table.remove(role);
        }
        // Replaced sensors and actuators become placeholders.
        for (place, _) in &all.sensors {
            self.write_placeholder(&mut table, ("sensor", self.sensor.len()), *place, SENSOR)?;
        }
        for (place, _) in &all.actuators {
            self.write_placeholder(&mut table, ("actuator", self.actuator.len()), *place, ACTUATOR)?;
        }
        let document = Document::from_table(&self.name, table);
        Self::solved(&document, Some(self), &all)
    }
}

impl ScenarioSpec {
    /// Writes the placeholder `word` of a custom part into the table, at index `place` of `count` parts of a role. An
    /// actuator keeps its axes, share and unloading.
    fn write_placeholder(
        &self,
        table: &mut Table,
        (role, count): (&str, usize),
        place: usize,
        word: &str,
    ) -> Result<(), ScenarioError> {
        if place >= count {
            let why =
                format!("is not there: the scenario has {count} {role}{}", if count == 1 { "" } else { "s" });
            return Err(ScenarioError::Key {
                origin: self.name.clone(),
                key: format!("{role}[{place}]"),
                why,
            });
        }
        let there = match table.get_mut(role) {
            Some(Value::Array(parts)) => &mut parts[place],
            Some(part) => part,
            None => {
                table.insert(role.to_owned(), Value::String(word.to_owned()));
                return Ok(());
            }
        };
        let task = |(key, _): &(&String, &Value)| ["axes", "share", "unloads"].contains(&key.as_str());
        let kept: Table = there
            .as_table()
            .into_iter()
            .flatten()
            .filter(task)
            .map(|(k, v)| (k.clone(), v.clone()))
            .collect();
        *there = if kept.is_empty() {
            Value::String(word.to_owned())
        } else {
            Value::Table(kept.into_iter().chain([(word.to_owned(), Value::Table(Table::new()))]).collect())
        };
        Ok(())
    }

    /// Returns true if the scenario has a custom part, which no text can contain.
    pub fn has_custom_parts(&self) -> bool {
        !self.custom_parts().each().is_empty()
    }

    /// Returns the custom parts of the scenario.
    pub fn custom_parts(&self) -> CustomParts {
        let sensor = |(place, sensor): (usize, &SensorKind)| Some((place, sensor.custom()?.clone()));
        let actuator =
            |(place, assigned): (usize, &AssignedActuator)| Some((place, assigned.kind.custom()?.clone()));
        CustomParts {
            law: self.law.custom().cloned(),
            sensors: self.sensor.iter().enumerate().filter_map(sensor).collect(),
            estimator: self.estimator.as_ref().and_then(|estimator| estimator.custom().cloned()),
            adaptation: self.adaptation.as_ref().and_then(|adaptation| adaptation.custom().cloned()),
            actuators: self.actuator.iter().enumerate().filter_map(actuator).collect(),
        }
    }

    /// Returns the scenario with all its defaults, as a table with placeholders for custom sensors and actuators, and
    /// without other custom parts.
    pub fn table_without_custom_parts(&self) -> Table {
        let mut table = self.to_table();
        let is_own = |part: &Value| part.get("own").is_some();
        for (role, word) in [("sensor", SENSOR), ("actuator", ACTUATOR)] {
            if let Some(Value::Array(parts)) = table.get_mut(role) {
                let own = parts.iter_mut().filter(|part| is_own(part));
                own.for_each(|part| *part = Value::String(word.to_owned()));
            }
        }
        table.retain(|_, part| !is_own(part));
        table
    }

    /// Returns the topics that the parts declare beyond those of the engine, each with the role of the part.
    fn declared_topics(&self) -> Vec<(&'static str, Arc<CustomTopic>)> {
        let CustomParts { sensors, estimator, adaptation, actuators, .. } = self.custom_parts();
        let sensors = sensors.iter().flat_map(|(_, sensor)| sensor.topics().to_vec());
        let estimator = estimator.iter().flat_map(|estimator| estimator.topics().to_vec());
        let adaptation = adaptation.iter().flat_map(|adaptation| adaptation.topics().to_vec());
        let actuators = actuators.iter().flat_map(|(_, actuator)| actuator.topics().to_vec());
        let law = self.law.custom_topics().into_iter().map(|topic| ("law", topic));
        law.chain(sensors.map(|topic| ("sensor", topic)))
            .chain(estimator.map(|topic| ("estimator", topic)))
            .chain(adaptation.map(|topic| ("adaptation", topic)))
            .chain(actuators.map(|topic| ("actuator", topic)))
            .collect()
    }

    /// Returns the topics that the parts declare beyond those of the engine, without repetitions.
    pub fn custom_topics(&self) -> Vec<Arc<CustomTopic>> {
        let mut topics = CustomTopics::default();
        // Parts with topics that conflict are refused before.
        self.declared_topics().iter().for_each(|(_, topic)| drop(topics.index(topic)));
        topics.iter().cloned().collect()
    }

    /// Checks that the topics of the parts can be in one log; returns the role of the first part whose topics cannot.
    pub(super) fn topic_conflict(&self) -> Option<ConfigError> {
        let mut topics = CustomTopics::default();
        self.declared_topics().into_iter().find_map(|(role, topic)| {
            topics.index(&topic).err().map(|error| ConfigError::new(role, error.to_string()))
        })
    }

    /// Sets the custom parts for roles that the document leaves out, and for sensors and actuators with a placeholder.
    pub(super) fn inherit_custom_parts(&mut self, own: &CustomParts, document: &Document) {
        let CustomParts { law, sensors, estimator, adaptation, actuators } = own;
        if let Some(law) = law.as_ref().filter(|_| !document.has("law")) {
            self.law = law.clone().into();
        }
        for (place, sensor) in sensors {
            if let Some(there) = self.sensor.get_mut(*place).filter(|there| there.is_continuous()) {
                *there = sensor.clone().into();
            }
        }
        if let Some(estimator) = estimator.as_ref().filter(|_| !document.has("estimator")) {
            self.estimator = Some(estimator.clone().into());
        }
        if let Some(adaptation) = adaptation.as_ref().filter(|_| !document.has("adaptation")) {
            self.adaptation = Some(adaptation.clone().into());
        }
        for (place, actuator) in actuators {
            if let Some(there) = self.actuator.get_mut(*place).filter(|there| there.kind.is_ideal()) {
                there.kind = actuator.clone().into();
            }
        }
    }
}

impl CustomParts {
    /// Returns the keys of the roles that have a custom part.
    pub fn each(&self) -> Vec<&'static str> {
        let all = [
            ("law", self.law.is_some()),
            ("sensor", !self.sensors.is_empty()),
            ("estimator", self.estimator.is_some()),
            ("adaptation", self.adaptation.is_some()),
            ("actuator", !self.actuators.is_empty()),
        ];
        all.into_iter().filter_map(|(role, is_own)| is_own.then_some(role)).collect()
    }
}
