//! Custom parts of a scenario: set in addition to its text, which cannot contain them, and kept when keys change.

use std::sync::Arc;

use flexsc_control::actuator::{ActuatorSpec, AssignedActuator};
use flexsc_control::adaptation::AdaptationSpec;
use flexsc_control::custom::Custom;
use flexsc_control::disturbance::DisturbanceSpec;
use flexsc_control::estimator::EstimatorSpec;
use flexsc_control::guidance::GuidanceSpec;
use flexsc_control::law::{LawKind, LawSpec, Stage};
use flexsc_control::sensor::{SensorKind, SensorSpec};
use flexsc_formats::document::{ConfigError, Document, ScenarioError, nearest};
use flexsc_record::CustomTopic;
use flexsc_record::custom_topic::CustomTopics;
use toml::{Table, Value};

use super::{Scenario, ScenarioSpec};

/// Placeholders in a text for a custom sensor, for a custom actuator, and for a custom law of a mode or a stage.
pub(super) const SENSOR: &str = "continuous";
pub(super) const ACTUATOR: &str = "ideal";
const STAGE_LAW: &str = "open";

/// Law of another crate.
pub type CustomLaw = Custom<dyn LawSpec>;

/// Custom parts of a scenario: at most one estimator and adaptation, one law or several of modes or stages, the same of
/// guidance, and any number of sensors, actuators and disturbances.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CustomParts {
    /// Custom law that acts throughout.
    pub law: Option<CustomLaw>,
    /// Custom laws of modes of operation, each with the name of its mode, or of stages of the law, each with its number.
    pub stage_laws: Vec<(String, CustomLaw)>,
    /// Custom sensors, each with its index among the sensors of the scenario.
    pub sensors: Vec<(usize, Custom<dyn SensorSpec>)>,
    /// Custom estimator.
    pub estimator: Option<Custom<dyn EstimatorSpec>>,
    /// Custom adaptation.
    pub adaptation: Option<Custom<dyn AdaptationSpec>>,
    /// Custom actuators, each with its index among the actuators of the scenario.
    pub actuators: Vec<(usize, Custom<dyn ActuatorSpec>)>,
    /// Custom disturbances in addition to those of the scenario, each with its index among them.
    pub disturbances: Vec<(usize, Custom<dyn DisturbanceSpec>)>,
    /// Custom guidance, each with the name of its mode of operation; empty for the whole run.
    pub guidance: Vec<(String, Custom<dyn GuidanceSpec>)>,
}

impl Scenario {
    /// Returns the scenario with a change of its keys, such as a custom part `law: Law::Custom(..)`.
    ///
    /// # Errors
    /// Fails if the changed scenario is inconsistent.
    pub fn with(mut self, change: impl FnOnce(&mut ScenarioSpec)) -> Result<Self, ScenarioError> {
        change(&mut self.written);
        let origin = self.name.clone();
        let fitted = Self::fitted(self.written, self.model)
            .map_err(|errors| ScenarioError::without_places(&origin, errors))?;
        Ok(Self { units: self.units, ..fitted })
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
        replace(&mut all.sensors, own.sensors);
        replace(&mut all.actuators, own.actuators);
        replace(&mut all.disturbances, own.disturbances);
        all.disturbances.sort_by_key(|(place, _)| *place);
        replace(&mut all.guidance, own.guidance);
        if own.law.is_some()
            && let Some(why) = self.stage_choice()
        {
            return Err(self.law_fault(why));
        }
        replace(&mut all.stage_laws, own.stage_laws);
        all.law = own.law.or(all.law);
        all.estimator = own.estimator.or(all.estimator);
        all.adaptation = own.adaptation.or(all.adaptation);
        let mut table = self.table_without_custom_parts();
        let replaced = [
            ("law", all.law.is_some()),
            ("estimator", all.estimator.is_some()),
            ("adaptation", all.adaptation.is_some()),
            ("target", all.guidance.iter().any(|(mode, _)| mode.is_empty())),
        ];
        for (role, _) in replaced.into_iter().filter(|(_, is_own)| *is_own) {
            table.remove(role);
        }
        // Replaced laws of modes and stages, sensors and actuators become placeholders.
        for (stage, _) in &all.stage_laws {
            let index = self.stage_index(stage).map_err(|why| self.law_fault(why))?;
            if let Some(law) = stage_laws(&mut table).into_iter().nth(index) {
                *law = open_law();
            }
        }
        for (mode, _) in all.guidance.iter().filter(|(mode, _)| !mode.is_empty()) {
            self.remove_mode_target(&mut table, mode)?;
        }
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

/// Puts custom parts in the place of those with the same key, and after the others.
fn replace<K: PartialEq, T>(all: &mut Vec<(K, T)>, own: Vec<(K, T)>) {
    all.retain(|(key, _)| own.iter().all(|(other, _)| other != key));
    all.extend(own);
}

/// Returns the laws of the modes in a table, or of the stages of its law; empty without any.
pub(super) fn stage_laws(table: &mut Table) -> Vec<&mut Value> {
    let stages = if table.contains_key("mode") {
        table.get_mut("mode")
    } else {
        table.get_mut("law").and_then(|law| law.get_mut("stages"))
    };
    let Some(Value::Array(stages)) = stages else { return Vec::new() };
    stages.iter_mut().filter_map(|stage| stage.get_mut("law")).collect()
}

/// Returns the placeholder of a custom law of a mode or a stage.
pub(super) fn open_law() -> Value {
    Value::Table(Table::from_iter([(STAGE_LAW.to_owned(), Value::Table(Table::new()))]))
}

/// Returns true if a part in a table is a custom one.
pub(super) fn is_own(part: &Value) -> bool {
    part.get("own").is_some()
}

impl ScenarioSpec {
    /// Returns the error of a custom law that has no place in the scenario.
    fn law_fault(&self, why: String) -> ScenarioError {
        ScenarioError::Key { origin: self.name.clone(), key: "law".to_owned(), why }
    }

    /// Returns why a custom law cannot act throughout, with the names by which a mode or a stage gets it; `None` for a scenario
    /// with one law.
    pub(super) fn stage_choice(&self) -> Option<String> {
        let names: Vec<String> = (0..self.law.stages().len()).map(|index| self.stage_name(index)).collect();
        let last = names.last()?;
        Some(if self.mode.is_empty() {
            format!(
                "has stages, each with a law of its own: give yours to one by its number, in Python `law={{{last}: ...}}`; the \
                 stages are {}",
                self.listed_stages()
            )
        } else {
            let modes: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
            format!(
                "must be left out with `[[mode]]`, where each mode has a law of its own: give yours to one by its name, in \
                 Python `law={{\"{last}\": ...}}`; the modes are {}",
                modes.join(", ")
            )
        })
    }

    /// Returns the name of a mode of operation, or the number of a stage of the law.
    fn stage_name(&self, index: usize) -> String {
        self.mode.get(index).map_or_else(|| index.to_string(), |mode| mode.name.clone())
    }

    /// Returns the index of the mode of operation of this name, or of the stage of the law with this number.
    ///
    /// # Errors
    /// The reason why there is none.
    pub(super) fn stage_index(&self, name: &str) -> Result<usize, String> {
        if self.mode.is_empty() {
            let count = self.law.stages().len();
            let known = name.parse().ok().filter(|index| *index < count);
            return known.ok_or_else(|| match count {
                0 => format!("has no modes of operation, got `{name}`"),
                _ => {
                    format!("must be the index of a stage of the law, from 0 to {}, got `{name}`", count - 1)
                }
            });
        }
        self.mode.iter().position(|mode| mode.name == name).ok_or_else(|| {
            let names: Vec<&str> = self.mode.iter().map(|mode| mode.name.as_str()).collect();
            let near =
                nearest(name, &names).map_or(String::new(), |near| format!("; did you mean `{near}`?"));
            let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
            format!("must be one of {}, got `{name}`{near}", quoted.join(", "))
        })
    }

    /// Removes the target of a mode of operation, which has custom guidance.
    fn remove_mode_target(&self, table: &mut Table, mode: &str) -> Result<(), ScenarioError> {
        let fault = |why| ScenarioError::Key { origin: self.name.clone(), key: "guidance".to_owned(), why };
        if self.mode.is_empty() {
            return Err(fault(format!("has no modes of operation, got `{mode}`")));
        }
        let index = self.stage_index(mode).map_err(fault)?;
        if let Some(Value::Array(modes)) = table.get_mut("mode")
            && let Some(Value::Table(there)) = modes.get_mut(index)
        {
            there.remove("target");
        }
        Ok(())
    }

    /// Returns the law of a mode of operation or of a stage.
    fn stage_law_mut(&mut self, name: &str) -> Option<&mut LawKind> {
        let index = self.stage_index(name).ok()?;
        match self.mode.get_mut(index) {
            Some(mode) => Some(&mut mode.law),
            None => self.law.stage_law_mut(index),
        }
    }

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
        let law =
            |(index, stage): (usize, &Stage)| Some((self.stage_name(index), stage.law.custom()?.clone()));
        let sensor = |(place, sensor): (usize, &SensorKind)| Some((place, sensor.custom()?.clone()));
        let actuator =
            |(place, assigned): (usize, &AssignedActuator)| Some((place, assigned.kind.custom()?.clone()));
        CustomParts {
            law: self.law.custom().cloned(),
            stage_laws: self.law.stages().iter().enumerate().filter_map(law).collect(),
            sensors: self.sensor.iter().enumerate().filter_map(sensor).collect(),
            estimator: self.estimator.as_ref().and_then(|estimator| estimator.custom().cloned()),
            adaptation: self.adaptation.as_ref().and_then(|adaptation| adaptation.custom().cloned()),
            actuators: self.actuator.iter().enumerate().filter_map(actuator).collect(),
            disturbances: self.own_disturbances.clone(),
            guidance: self.own_guidance.clone(),
        }
    }

    /// Returns the scenario with all its defaults, as a table with placeholders for custom sensors and actuators and for
    /// custom laws of modes and stages, and without other custom parts.
    pub fn table_without_custom_parts(&self) -> Table {
        let mut table = self.to_table();
        stage_laws(&mut table).into_iter().filter(|law| is_own(law)).for_each(|law| *law = open_law());
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
        let CustomParts { sensors, estimator, adaptation, actuators, disturbances, guidance, .. } =
            self.custom_parts();
        let sensors = sensors.iter().flat_map(|(_, sensor)| sensor.topics().to_vec());
        let estimator = estimator.iter().flat_map(|estimator| estimator.topics().to_vec());
        let adaptation = adaptation.iter().flat_map(|adaptation| adaptation.topics().to_vec());
        let actuators = actuators.iter().flat_map(|(_, actuator)| actuator.topics().to_vec());
        let disturbances = disturbances.iter().flat_map(|(_, own)| own.topics().to_vec());
        let guidance = guidance.iter().flat_map(|(_, own)| own.topics().to_vec());
        let law = self.law.custom_topics().into_iter().map(|topic| ("law", topic));
        law.chain(sensors.map(|topic| ("sensor", topic)))
            .chain(estimator.map(|topic| ("estimator", topic)))
            .chain(adaptation.map(|topic| ("adaptation", topic)))
            .chain(actuators.map(|topic| ("actuator", topic)))
            .chain(disturbances.map(|topic| ("disturbance", topic)))
            .chain(guidance.map(|topic| ("guidance", topic)))
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
        let CustomParts {
            law,
            stage_laws,
            sensors,
            estimator,
            adaptation,
            actuators,
            disturbances,
            guidance,
        } = own;
        self.own_disturbances.clone_from(disturbances);
        let targeted = |mode: &str| match self.mode.iter().find(|own| own.name == mode) {
            Some(own) => own.target.is_some(),
            None => !self.target.is_empty(),
        };
        // That of a mode which is no more has nothing to aim.
        let exists = |mode: &str| mode.is_empty() || self.mode.iter().any(|own| own.name == mode);
        let stays = |mode: &str| exists(mode) && !targeted(mode);
        self.own_guidance = guidance.iter().filter(|(mode, _)| stays(mode)).cloned().collect();
        if let Some(law) = law.as_ref().filter(|_| !document.has("law")) {
            self.law = law.clone().into();
        }
        for (stage, law) in stage_laws {
            if let Some(there) = self.stage_law_mut(stage).filter(|there| there.kind() == STAGE_LAW) {
                *there = law.clone().into();
            }
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
            ("law", self.law.is_some() || !self.stage_laws.is_empty()),
            ("sensor", !self.sensors.is_empty()),
            ("estimator", self.estimator.is_some()),
            ("adaptation", self.adaptation.is_some()),
            ("actuator", !self.actuators.is_empty()),
            ("disturbance", !self.disturbances.is_empty()),
            ("guidance", !self.guidance.is_empty()),
        ];
        all.into_iter().filter_map(|(role, is_own)| is_own.then_some(role)).collect()
    }
}
