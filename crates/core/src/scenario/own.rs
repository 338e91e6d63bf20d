//! Custom parts of a scenario: set in addition to its text, which cannot contain them, and kept when keys change.

use toml::{Table, Value};

use super::{Scenario, Written};
use crate::actuator::{Actuator, Assigned, Effector};
use crate::adaptation::{Adapt, Adaptation};
use crate::document::{Document, Fault, ScenarioError};
use crate::estimator::{Estimator, Observe};
use crate::law::{Law, Rule};
use crate::own::Own;
use crate::sensor::{Instrument, Sensor};

/// Placeholders in a text for a custom sensor and for a custom actuator.
const SENSOR: &str = "continuous";
const ACTUATOR: &str = "ideal";

/// Custom parts of a scenario: at most one law, estimator and adaptation, and any number of sensors and actuators.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OwnParts {
    /// Custom law.
    pub law: Option<Own<dyn Rule + Send + Sync>>,
    /// Custom sensors, each with its index among the sensors of the scenario.
    pub sensors: Vec<(usize, Own<dyn Instrument>)>,
    /// Custom estimator.
    pub estimator: Option<Own<dyn Observe>>,
    /// Custom adaptation.
    pub adaptation: Option<Own<dyn Adapt>>,
    /// Custom actuators, each with its index among the actuators of the scenario.
    pub actuators: Vec<(usize, Own<dyn Effector>)>,
}

impl Scenario {
    /// Returns the scenario with a change of its keys, such as a custom part `law: Law::Own(..)`.
    ///
    /// # Errors
    /// Fails if the changed scenario is inconsistent.
    pub fn with(mut self, change: impl FnOnce(&mut Written)) -> Result<Self, ScenarioError> {
        change(&mut self.written);
        let origin = self.name.clone();
        let fault = |fault: Fault| ScenarioError::Key { origin, key: fault.key, why: fault.why };
        Self::fitted(self.written, self.model).map_err(fault)
    }

    /// Reads a scenario from a document with custom parts: for roles that the document leaves out, and for sensors and
    /// actuators with a placeholder.
    ///
    /// # Errors
    /// Fails if the document is invalid or inconsistent with the parts.
    pub fn from_document_beside(document: &Document, own: &OwnParts) -> Result<Self, ScenarioError> {
        Self::solved(document, None, own, true)
    }

    /// Returns the scenario with the parts of `own` in place of those of the same role or index, and with its other
    /// custom parts.
    ///
    /// # Errors
    /// Fails if the parts are inconsistent with the others.
    pub fn bringing(&self, own: OwnParts) -> Result<Self, ScenarioError> {
        let mut all = self.own_parts();
        all.sensors.retain(|(place, _)| own.sensors.iter().all(|(other, _)| other != place));
        all.sensors.extend(own.sensors);
        all.actuators.retain(|(place, _)| own.actuators.iter().all(|(other, _)| other != place));
        all.actuators.extend(own.actuators);
        all.law = own.law.or(all.law);
        all.estimator = own.estimator.or(all.estimator);
        all.adaptation = own.adaptation.or(all.adaptation);
        let mut table = self.table_beside_own_parts();
        for role in all.each().into_iter().filter(|role| !["sensor", "actuator"].contains(role)) {
            table.remove(role);
        }
        // Replaced sensors and actuators become placeholders.
        for (place, _) in &all.sensors {
            self.give_up(&mut table, ("sensor", self.sensor.len()), *place, SENSOR)?;
        }
        for (place, _) in &all.actuators {
            self.give_up(&mut table, ("actuator", self.actuator.len()), *place, ACTUATOR)?;
        }
        let document = Document::from_table(&self.name, table);
        Self::solved(&document, Some(self), &all, true)
    }
}

impl Written {
    /// Writes the placeholder `word` of a custom part into the table, at index `place` of `count` parts of a role. An
    /// actuator keeps its axes, share and unloading.
    fn give_up(
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
    pub fn has_own_parts(&self) -> bool {
        !self.own_parts().each().is_empty()
    }

    /// Returns the custom parts of the scenario.
    pub fn own_parts(&self) -> OwnParts {
        let sensor = |(place, sensor): (usize, &Sensor)| match sensor {
            Sensor::Own(own) => Some((place, own.clone())),
            _ => None,
        };
        let actuator = |(place, assigned): (usize, &Assigned)| match &assigned.kind {
            Actuator::Own(own) => Some((place, own.clone())),
            _ => None,
        };
        OwnParts {
            law: if let Law::Own(own) = &self.law { Some(own.clone()) } else { None },
            sensors: self.sensor.iter().enumerate().filter_map(sensor).collect(),
            estimator: match &self.estimator {
                Some(Estimator::Own(own)) => Some(own.clone()),
                _ => None,
            },
            adaptation: match &self.adaptation {
                Some(Adaptation::Own(own)) => Some(own.clone()),
                _ => None,
            },
            actuators: self.actuator.iter().enumerate().filter_map(actuator).collect(),
        }
    }

    /// Returns the scenario with all its defaults, as a table with placeholders for custom sensors and actuators, and
    /// without other custom parts.
    pub fn table_beside_own_parts(&self) -> Table {
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

    /// Sets the custom parts for roles that the document leaves out, and for sensors and actuators with a placeholder.
    pub(super) fn take_own_parts(&mut self, own: &OwnParts, document: &Document) {
        let OwnParts { law, sensors, estimator, adaptation, actuators } = own;
        if let Some(law) = law.as_ref().filter(|_| !document.has("law")) {
            self.law = Law::Own(law.clone());
        }
        for (place, sensor) in sensors {
            if let Some(there) = self.sensor.get_mut(*place).filter(|there| there.is_continuous()) {
                *there = Sensor::Own(sensor.clone());
            }
        }
        if let Some(estimator) = estimator.as_ref().filter(|_| !document.has("estimator")) {
            self.estimator = Some(Estimator::Own(estimator.clone()));
        }
        if let Some(adaptation) = adaptation.as_ref().filter(|_| !document.has("adaptation")) {
            self.adaptation = Some(Adaptation::Own(adaptation.clone()));
        }
        for (place, actuator) in actuators {
            let ideal = |kind: &Actuator| matches!(kind, Actuator::Ideal(ideal) if ideal.faults.is_empty());
            if let Some(there) = self.actuator.get_mut(*place).filter(|there| ideal(&there.kind)) {
                there.kind = Actuator::Own(actuator.clone());
            }
        }
    }
}

impl OwnParts {
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
