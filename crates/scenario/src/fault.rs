//! Faults: failures that occur together, of which a run has one or none.

use flexsc_control::actuator::{ActuatorKind, Failure};
use flexsc_control::interval::Interval;
use flexsc_control::one_or_many::OneOrMany;
use flexsc_control::operation::index_of_kind;
use flexsc_control::sensor::{SensorFailure, SensorKind};
use flexsc_formats::document::{ConfigError, key};
use schemars::JsonSchema;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use toml::{Table, Value};

use super::ScenarioSpec;
use super::consistency::errors_in;

/// Value of `active_fault` without a fault.
pub const NO_FAULT: &str = "none";
/// Key that chooses the fault of a run.
pub const ACTIVE_FAULT: &str = "active_fault";

/// Failures that occur together, in the runs of which this is the `active_fault`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "RunFault")]
pub struct Fault {
    /// Name.
    pub name: String,
    /// Failures of a sensor, or a list of several sensors.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sensor: Option<OneOrMany<PartFailures<SensorFailure>>>,
    /// Failures of an actuator, or a list of several actuators.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub actuator: Option<OneOrMany<PartFailures<Failure>>>,
}

/// Failures of a part, besides its own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "PartWith{F}")]
pub struct PartFailures<F> {
    /// Part by its kind, or by its kind and its place among those of the kind, such as `star_tracker[1]`.
    pub part: String,
    /// Failures.
    pub faults: Vec<F>,
}

/// Failures of the active fault in the list of a part.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct AddedFailures {
    role: Role,
    index: usize,
    count: usize,
}

#[derive(Copy, Clone, Debug, PartialEq, Eq)]
enum Role {
    Sensor,
    Actuator,
}

impl Fault {
    fn sensors(&self) -> &[PartFailures<SensorFailure>] {
        self.sensor.as_deref().unwrap_or_default()
    }

    fn actuators(&self) -> &[PartFailures<Failure>] {
        self.actuator.as_deref().unwrap_or_default()
    }

    /// Iterates over the intervals of the failures.
    pub fn intervals(&self) -> impl Iterator<Item = Interval> {
        let of_sensors = self.sensors().iter().flat_map(|own| &own.faults).map(SensorFailure::interval);
        let of_actuators = self.actuators().iter().flat_map(|own| &own.faults);
        of_sensors.chain(of_actuators.map(|failure| failure.scope().interval))
    }
}

impl ScenarioSpec {
    /// Returns the fault of the run with its index among the faults; `None` without one.
    pub fn fault_of_run(&self) -> Option<(usize, &Fault)> {
        let name = self.active_fault.as_deref()?;
        self.fault.iter().enumerate().find(|(_, fault)| fault.name == name)
    }

    /// Adds the failures of the active fault to those of their parts, in place of those of a fault before.
    ///
    /// # Errors
    /// A fault that does not fit the parts, or an active one that there is not.
    pub(super) fn activate_fault(&mut self) -> Result<(), ConfigError> {
        for AddedFailures { role, index, count } in std::mem::take(&mut self.added_failures) {
            self.change_failures(role, index, |faults| faults.truncate(faults.len() - count));
        }
        if let Some(error) = self.fault_error() {
            return Err(error);
        }
        if self.fault.is_empty() {
            return Ok(());
        }
        let active = self.active_fault.get_or_insert_with(|| NO_FAULT.to_owned()).clone();
        let Some((_, fault)) = self.fault_of_run() else { return Ok(()) };
        let (sensors, actuators) = (fault.sensors().to_vec(), fault.actuators().to_vec());
        for PartFailures { part, faults } in &sensors {
            self.add_failures(Role::Sensor, part, faults, &active)?;
        }
        for PartFailures { part, faults } in &actuators {
            self.add_failures(Role::Actuator, part, faults, &active)?;
        }
        Ok(())
    }

    /// Returns a table of the scenario without the failures of the active fault among those of the parts.
    pub(super) fn without_added_failures(&self, mut table: Table) -> Table {
        for AddedFailures { role, index, count } in self.added_failures.iter().rev() {
            let list = format!("{}.faults", self.part_key(*role, *index));
            if let Some(Value::Array(faults)) = key::get(&table, &list).cloned() {
                let own = faults[..faults.len() - count].to_vec();
                // The list is there.
                let _ = key::set(&mut table, &list, Value::Array(own));
            }
        }
        table
    }

    fn part_key(&self, role: Role, index: usize) -> String {
        match role {
            Role::Sensor => self.sensor_key(index),
            Role::Actuator => {
                format!("{}.{}", self.actuator.key("actuator", index), self.actuator[index].kind.kind())
            }
        }
    }

    fn part_index(&self, role: Role, part: &str) -> Result<usize, ConfigError> {
        let kinds: Vec<&str> = match role {
            Role::Sensor => self.sensor.iter().map(SensorKind::kind).collect(),
            Role::Actuator => self.actuator.iter().map(|own| own.kind.kind()).collect(),
        };
        index_of_kind(part, &kinds).ok_or_else(|| {
            let why = format!("must name one of the parts, `{}`, got `{part}`", kinds.join("`, `"));
            ConfigError::new("part", why)
        })
    }

    fn add_failures<F: Serialize>(
        &mut self,
        role: Role,
        part: &str,
        faults: &[F],
        active: &str,
    ) -> Result<(), ConfigError> {
        let index = self.part_index(role, part)?;
        let added = faults.iter().map(Value::try_from).collect::<Result<Vec<Value>, _>>();
        let added = added.ok().filter(|added| {
            self.change_failures(role, index, |faults| faults.extend(added.iter().cloned())).is_some()
        });
        if added.is_none() {
            let why = format!("has the fault `{active}`, and a part of this kind has no `faults`");
            return Err(ConfigError::new(self.part_key(role, index), why));
        }
        self.added_failures.push(AddedFailures { role, index, count: faults.len() });
        Ok(())
    }

    fn change_failures(
        &mut self,
        role: Role,
        index: usize,
        change: impl FnOnce(&mut Vec<Value>),
    ) -> Option<()> {
        match role {
            Role::Sensor => {
                let part = self.sensor.get_mut(index)?;
                let kind = part.kind();
                change_failures(part, kind, change)
            }
            Role::Actuator => {
                let part = self.actuator.get_mut(index)?;
                let kind = part.kind.kind();
                change_failures(part, kind, change)
            }
        }
    }

    /// Returns the first error of the faults and of the choice of one.
    fn fault_error(&self) -> Option<ConfigError> {
        let error_of = |(index, fault): (usize, &Fault)| {
            let names = self.fault[..index].iter().map(|other| other.name.as_str());
            let is_taken = fault.name.is_empty()
                || fault.name.contains(['(', ')', ','])
                || names.chain([NO_FAULT]).any(|name| name == fault.name);
            if is_taken {
                let why = format!(
                    "must be a name of its own without brackets and commas, and not `{NO_FAULT}`, got `{}`",
                    fault.name
                );
                return Some(ConfigError::new("name", why));
            }
            if fault.intervals().next().is_none() {
                return Some(ConfigError::new("", "needs failures of a `sensor` or an `actuator`"));
            }
            self.failures_error("sensor", fault.sensor.as_ref(), Role::Sensor, |_, faults| {
                errors_in("faults", faults, SensorFailure::validate).next()
            })
            .or_else(|| {
                self.failures_error("actuator", fault.actuator.as_ref(), Role::Actuator, |index, faults| {
                    ActuatorKind::validate_failures(&self.actuator[index].kind, faults, self.axis_count())
                })
            })
        };
        let mut all = self.fault.iter().enumerate();
        let of_faults = all.find_map(|own| Some(error_of(own)?.within(&format!("fault[{}]", own.0))));
        of_faults.or_else(|| {
            let active = self.active_fault.as_deref().filter(|name| *name != NO_FAULT)?;
            let names: Vec<&str> = self.fault.iter().map(|fault| fault.name.as_str()).collect();
            let why = format!(
                "must be `{NO_FAULT}` or the name of a `[[fault]]`, `{}`, got `{active}`",
                names.join("`, `")
            );
            (!names.contains(&active)).then(|| ConfigError::new(ACTIVE_FAULT, why))
        })
    }

    fn failures_error<F>(
        &self,
        name: &str,
        parts: Option<&OneOrMany<PartFailures<F>>>,
        role: Role,
        validate: impl Fn(usize, &[F]) -> Option<ConfigError>,
    ) -> Option<ConfigError> {
        let parts = parts?;
        let error_of = |own: &PartFailures<F>| match self.part_index(role, &own.part) {
            Ok(index) => validate(index, &own.faults),
            Err(error) => Some(error),
        };
        let mut all = parts.iter().enumerate();
        all.find_map(|(index, own)| Some(error_of(own)?.within(&parts.key(name, index))))
    }
}

/// Changes the list `faults` of a part; `None` if its kind has none.
fn change_failures<P: Serialize + DeserializeOwned>(
    part: &mut P,
    kind: &str,
    change: impl FnOnce(&mut Vec<Value>),
) -> Option<()> {
    let mut value = Value::try_from(&*part).ok()?;
    if value.is_str() {
        // A kind without keys is written as its name.
        value = Value::Table(Table::from_iter([(kind.to_owned(), Value::Table(Table::new()))]));
    }
    let list =
        value.get_mut(kind)?.as_table_mut()?.entry("faults").or_insert_with(|| Value::Array(Vec::new()));
    change(list.as_array_mut()?);
    *part = value.try_into().ok()?;
    Some(())
}
