//! Units in which the numbers of a scenario are written, for those who read them again.

use std::collections::BTreeMap;
use std::sync::Arc;

use flexsc_formats::document::key::bare_or_quoted;
use flexsc_formats::document::unit_of_text;
use toml::{Table, Value};

/// Units in which numbers are written, by the paths of their keys. They change no value, so that any two are equal.
#[derive(Clone, Debug, Default)]
pub struct WrittenUnits(Arc<BTreeMap<String, String>>);

impl PartialEq for WrittenUnits {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl WrittenUnits {
    /// Returns the units of the texts in a table.
    pub fn from_table(table: &Table) -> Self {
        let mut units = BTreeMap::new();
        table.iter().for_each(|(key, value)| collect(value, bare_or_quoted(key), &mut units));
        Self(Arc::new(units))
    }

    /// Returns the unit of a key.
    pub fn get(&self, key: &str) -> Option<&str> {
        self.0.get(key).map(String::as_str)
    }
}

fn collect(value: &Value, path: String, units: &mut BTreeMap<String, String>) {
    match value {
        Value::Table(table) => {
            for (key, value) in table {
                collect(value, format!("{path}.{}", bare_or_quoted(key)), units);
            }
        }
        Value::Array(values) => {
            for (index, value) in values.iter().enumerate() {
                collect(value, format!("{path}[{index}]"), units);
            }
        }
        value => units.extend(value.as_str().and_then(unit_of_text).map(|unit| (path, unit.to_owned()))),
    }
}
