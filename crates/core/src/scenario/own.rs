//! Parts of a program's own in a scenario: put in place beside its text, which cannot hold them, and taken over where keys change.

use toml::{Table, Value};

use super::{Scenario, Written};
use crate::actuator::{Actuator, Assigned, Effector};
use crate::adaptation::{Adapt, Adaptation};
use crate::document::{Document, Fault, ScenarioError};
use crate::estimator::{Estimator, Observe};
use crate::law::{Law, Rule};
use crate::own::Own;
use crate::sensor::{Instrument, Sensor};

/// What stands in a text for a sensor and for an actuator of a program's own.
const SENSOR: &str = "continuous";
const ACTUATOR: &str = "ideal";

/// Parts of a program's own, one of each role at most, and sensors and actuators.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OwnParts {
    /// The law.
    pub law: Option<Own<dyn Rule + Send + Sync>>,
    /// Sensors, each with its place among those of the scenario.
    pub sensors: Vec<(usize, Own<dyn Instrument>)>,
    /// The estimator.
    pub estimator: Option<Own<dyn Observe>>,
    /// The adaptation.
    pub adaptation: Option<Own<dyn Adapt>>,
    /// Actuators, each with its place among those of the scenario.
    pub actuators: Vec<(usize, Own<dyn Effector>)>,
}

impl Scenario {
    /// The scenario with a part of a program's own, such as `law: Law::Own(..)`, in place of what was read.
    ///
    /// # Errors
    /// The part does not fit the others.
    pub fn with(mut self, change: impl FnOnce(&mut Written)) -> Result<Self, ScenarioError> {
        change(&mut self.written);
        let origin = self.name.clone();
        let fault = |fault: Fault| ScenarioError::Key { origin, key: fault.key, why: fault.why };
        Self::fitted(self.written, self.model).map_err(fault)
    }

    /// Reads a scenario from a document beside which these parts stand, in place of what it says of their roles.
    ///
    /// # Errors
    /// The document is not accepted, or the parts do not fit the others.
    pub fn from_document_beside(document: &Document, own: &OwnParts) -> Result<Self, ScenarioError> {
        Self::solved(document, None, own, true)
    }

    /// The scenario with these parts in place of its own, and beside those that it has of a program.
    ///
    /// # Errors
    /// The parts do not fit the others.
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
        // A sensor or an actuator that is replaced gives its place up.
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
    /// Lets a part of a program's own have a place in the text among so many, with the word that stands there for it. An actuator
    /// keeps what it is for.
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

    /// Whether it has a part of a program's own, which no text can hold.
    pub fn has_own_parts(&self) -> bool {
        !self.own_parts().each().is_empty()
    }

    /// Its parts of a program's own.
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

    /// The scenario with all its defaults, as a table without its parts of a program's own.
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

    /// Takes over parts of a program's own where the document says nothing else.
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
    /// The roles of which there is one, by their keys.
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
