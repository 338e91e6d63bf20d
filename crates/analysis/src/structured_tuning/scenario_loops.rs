//! Loops of a scenario: with values of its keys, for the nominal plant and the corners of its uncertain keys.

use flexsc_formats::document::{ConfigError, Document, key};
use toml::{Table, Value};

use super::loop_set::TunedPlant;
use super::scenario_measure::ScenarioMeasure;
use crate::open_loop::{LoopBreak, LoopParts, OpenLoop};
use flexsc_scenario::Scenario;
use flexsc_scenario::uncertain::{UncertainBox, UncertainKey};

/// Largest number of uncertain keys: a set has a plant for each corner.
pub const MOST_UNCERTAIN: usize = 10;

/// Loops of a scenario at one point at which they are cut open.
#[derive(Clone, Debug)]
pub struct ScenarioLoops {
    origin: String,
    table: Table,
    keys: Vec<String>,
    opened: LoopBreak,
    uncertain: Vec<UncertainKey>,
}

impl ScenarioLoops {
    /// Prepares the loops of a scenario with values of `keys`, for its nominal plant and, if `corners` is set, for the
    /// corners of `[uncertain]`: the limits of uniform distributions, three standard deviations of normal ones, and the
    /// least and the largest of several values.
    ///
    /// # Errors
    /// A key that is no number of the scenario, and more than [`MOST_UNCERTAIN`] uncertain keys.
    pub fn new(
        scenario: &Scenario,
        opened: LoopBreak,
        keys: Vec<String>,
        corners: bool,
    ) -> Result<Self, ConfigError> {
        let mut whole = scenario.self_contained();
        whole.write_frequency_factors(&keys);
        let mut table = whole.to_table();
        let all = UncertainBox::new(&scenario.uncertain, &table);
        table.remove("uncertain");
        table.remove("correlated");
        for name in &keys {
            let hint = if name.starts_with("mode[") && !table.contains_key("mode") {
                ": one mode acts throughout, and its law is `law`; conditions do not act"
            } else {
                ""
            };
            let why = || format!("is no number of this scenario{hint}");
            number(&table, name).ok_or_else(|| ConfigError::new(name, why()))?;
        }
        let uncertain = if corners { all.keys } else { Vec::new() };
        if let Some(tuned) = uncertain.iter().find(|own| keys.contains(&own.key)) {
            return Err(ConfigError::new(&tuned.key, "is uncertain: a tuned key has one value"));
        }
        if uncertain.len() > MOST_UNCERTAIN {
            let why = format!("has {} keys: at most {MOST_UNCERTAIN} have corners", uncertain.len());
            return Err(ConfigError::new("uncertain", why));
        }
        Ok(Self { origin: scenario.name.clone(), table, keys, opened, uncertain })
    }

    /// Returns the number of plants: the nominal one, and the corners.
    pub fn plants(&self) -> usize {
        if self.uncertain.is_empty() { 1 } else { 1 + (1 << self.uncertain.len()) }
    }

    /// Returns the uncertain keys with the limits of their values.
    pub fn uncertain(&self) -> &[UncertainKey] {
        &self.uncertain
    }

    /// Returns the values of the uncertain keys of a plant; none for the nominal one.
    pub fn plant(&self, index: usize) -> Vec<(&str, f64)> {
        let Some(corner) = index.checked_sub(1) else { return Vec::new() };
        let each = self.uncertain.iter().enumerate();
        each.map(|(place, uncertain)| (uncertain.key.as_str(), uncertain.limits()[(corner >> place) & 1]))
            .collect()
    }

    /// Returns the value of a key in the scenario.
    pub fn value(&self, name: &str) -> Option<f64> {
        number(&self.table, name)
    }

    /// Returns the scenario with values of the keys, for a plant.
    ///
    /// # Errors
    /// A value that the scenario does not accept.
    pub fn scenario(&self, values: &[f64], plant: usize) -> Result<Scenario, String> {
        let mut table = self.table.clone();
        let tuned = self.keys.iter().map(String::as_str).zip(values.iter().copied());
        for (name, value) in tuned.chain(self.plant(plant)) {
            let is_integer = matches!(key::get(&table, name), Some(Value::Integer(_)));
            let value =
                if is_integer { Value::Integer(libm::round(value) as i64) } else { Value::Float(value) };
            key::set(&mut table, name, value)?;
        }
        Scenario::from_document(&Document::from_table(&self.origin, table)).map_err(|error| error.to_string())
    }

    /// Returns the loop with values of the keys, for a plant.
    ///
    /// # Errors
    /// A value that the scenario does not accept, and a scenario without a linear loop.
    pub fn loop_at(&self, values: &[f64], plant: usize) -> Result<OpenLoop, String> {
        Ok(self.plant_at(values, plant, &[])?.opened)
    }

    /// Returns the loop of a plant with values of the keys, and its measures.
    ///
    /// # Errors
    /// A value that the scenario does not accept, and a scenario without a linear loop or without a measure.
    pub fn plant_at(
        &self,
        values: &[f64],
        plant: usize,
        measures: &[ScenarioMeasure],
    ) -> Result<TunedPlant, String> {
        let scenario = self.scenario(values, plant)?;
        let fault = |fault: ConfigError| format!("{}: `{}` {}", self.origin, fault.key, fault.why);
        let parts = LoopParts::from_scenario(&scenario, LoopBreak::Command).map_err(fault)?;
        let measures = measures.iter().map(|measure| measure.values(&parts)).collect::<Result<_, _>>()?;
        let opened = OpenLoop::from_parts(&parts.opened_at(self.opened)).map_err(fault)?;
        Ok(TunedPlant { opened, measures })
    }
}

/// Returns the number at a key.
fn number(table: &Table, name: &str) -> Option<f64> {
    match key::get(table, name)? {
        Value::Float(value) => Some(*value),
        Value::Integer(value) => Some(*value as f64),
        _ => None,
    }
}
