//! Parts of a program's own in a scenario: put in place beside its text, which cannot hold them, and taken over where keys change.

use toml::{Table, Value};

use super::Scenario;
use crate::actuator::{Actuator, Effector};
use crate::adaptation::{Adapt, Adaptation};
use crate::document::{Document, Fault, ScenarioError};
use crate::estimator::{Estimator, Observe};
use crate::law::{Law, Rule};
use crate::own::Own;
use crate::sensor::{Instrument, Sensor};

/// What stands in a text for a sensor of a program's own.
const IN_ITS_PLACE: &str = "continuous";

/// Parts of a program's own, one of each role at most, and sensors.
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
    /// The actuator.
    pub actuator: Option<Own<dyn Effector>>,
}

impl Scenario {
    /// The scenario with a part of a program's own, such as `law: Law::Own(..)`, in place of what was read.
    ///
    /// # Errors
    /// The part does not fit the others.
    pub fn with(mut self, change: impl FnOnce(&mut Self)) -> Result<Self, ScenarioError> {
        change(&mut self);
        let origin = self.name.clone();
        let fault = |fault: Fault| ScenarioError::Key { origin, key: fault.key, why: fault.why };
        self.fit().and_then(|()| self.inconsistency().map_or(Ok(()), Err)).map_err(fault)?;
        Ok(self)
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
        all.law = own.law.or(all.law);
        all.estimator = own.estimator.or(all.estimator);
        all.adaptation = own.adaptation.or(all.adaptation);
        all.actuator = own.actuator.or(all.actuator);
        let mut table = self.table_beside_own_parts();
        for role in all.each().into_iter().filter(|role| *role != "sensor") {
            table.remove(role);
        }
        // A sensor that is replaced gives its place up.
        for (place, _) in &all.sensors {
            let count = self.sensor.len();
            if *place >= count {
                let why = format!(
                    "is not there: the scenario has {count} sensor{}",
                    if count == 1 { "" } else { "s" }
                );
                return Err(ScenarioError::Key {
                    origin: self.name.clone(),
                    key: format!("sensor[{place}]"),
                    why,
                });
            }
            let itself = Value::String(IN_ITS_PLACE.to_owned());
            match table.get_mut("sensor") {
                Some(Value::Array(sensors)) => sensors[*place] = itself,
                _ => drop(table.insert("sensor".to_owned(), itself)),
            }
        }
        let document = Document::from_table(&self.name, table);
        Self::solved(&document, Some(self), &all, true)
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
            actuator: if let Actuator::Own(own) = &self.actuator { Some(own.clone()) } else { None },
        }
    }

    /// The scenario with all its defaults, as a table without its parts of a program's own.
    pub fn table_beside_own_parts(&self) -> Table {
        let mut table = self.to_table();
        let is_own = |part: &Value| part.get("own").is_some();
        if let Some(Value::Array(sensors)) = table.get_mut("sensor") {
            let own = sensors.iter_mut().filter(|sensor| is_own(sensor));
            own.for_each(|sensor| *sensor = Value::String(IN_ITS_PLACE.to_owned()));
        }
        table.retain(|_, part| !is_own(part));
        table
    }

    /// Takes over parts of a program's own where the document says nothing else.
    pub(super) fn take_own_parts(&mut self, own: &OwnParts, document: &Document) {
        let OwnParts { law, sensors, estimator, adaptation, actuator } = own;
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
        if let Some(actuator) = actuator.as_ref().filter(|_| !document.has("actuator")) {
            self.actuator = Actuator::Own(actuator.clone());
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
            ("actuator", self.actuator.is_some()),
        ];
        all.into_iter().filter_map(|(role, is_own)| is_own.then_some(role)).collect()
    }
}
