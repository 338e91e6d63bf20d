//! Keys in which two scenarios differ, with their values in the reader's units.

use std::collections::BTreeMap;

use flexsc_formats::reader_units::{ReaderUnit, ReaderUnits};
use flexsc_scenario::Scenario;
use serde::Serialize;
use toml::Value;

/// Key that two scenarios do not have with one value.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct KeyDifference {
    /// Path of the key, such as `law.pd.k_d`.
    pub key: String,
    /// SI unit of the values; absent for numbers without a unit and for words.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit: Option<&'static str>,
    /// Value in each scenario, in SI; null in a scenario that lacks the key.
    pub values: [Option<Value>; 2],
    /// Values in the unit in which the key is written, or else in the reader's; empty in a scenario that lacks the key.
    pub texts: [String; 2],
}

/// Keys that name a scenario and do not change its run.
const NAMES: [&str; 2] = ["name", "about"];

impl KeyDifference {
    /// Returns the keys in which two scenarios differ, defaults included, in the order of their paths.
    pub fn between(scenarios: [&Scenario; 2], units: ReaderUnits) -> Vec<Self> {
        let [first, second] = scenarios.map(|scenario| {
            let mut leaves = BTreeMap::new();
            collect(String::new(), Value::Table(scenario.self_contained().to_table()), &mut leaves);
            for name in NAMES {
                leaves.remove(name);
            }
            leaves
        });
        let keys = first.keys().chain(second.keys().filter(|key| !first.contains_key(*key)));
        let mut keys: Vec<&String> = keys.filter(|key| first.get(*key) != second.get(*key)).collect();
        keys.sort();
        let difference = |key: &String| {
            let values = [&first, &second].map(|leaves| leaves.get(key).cloned());
            let unit = scenarios.iter().find_map(|scenario| scenario.unit_of(key));
            let written = scenarios.iter().find_map(|scenario| scenario.written_unit(key));
            let largest =
                values.iter().flatten().filter_map(number).fold(0.0, |most: f64, own| most.max(own.abs()));
            let fitting = units.for_key(key, written, largest, unit.unwrap_or(""));
            Self { texts: texts(&values, &fitting), key: key.clone(), unit, values }
        };
        keys.into_iter().map(difference).collect()
    }
}

/// Collects the values that are neither tables nor lists by their paths.
fn collect(path: String, value: Value, leaves: &mut BTreeMap<String, Value>) {
    match value {
        Value::Table(table) => {
            for (key, value) in table {
                collect(if path.is_empty() { key } else { format!("{path}.{key}") }, value, leaves);
            }
        }
        Value::Array(list) => {
            for (index, value) in list.into_iter().enumerate() {
                collect(format!("{path}[{index}]"), value, leaves);
            }
        }
        value => {
            leaves.insert(path, value);
        }
    }
}

/// Returns two values as texts, of numbers with as many digits as show that they differ.
fn texts(values: &[Option<Value>; 2], fitting: &ReaderUnit) -> [String; 2] {
    let numbers = values.each_ref().map(|value| value.as_ref().and_then(number));
    [0, 1].map(|place| match (&values[place], numbers[place]) {
        (None, _) => String::new(),
        (Some(_), Some(number)) => {
            let text = match numbers[1 - place] {
                Some(other) => fitting.number_against(number, other),
                None => fitting.number(number),
            };
            format!("{text} {}", fitting.name).trim_end().to_owned()
        }
        (Some(Value::String(text)), None) => text.clone(),
        (Some(value), None) => value.to_string(),
    })
}

fn number(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|integer| integer as f64))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scenario(k_t: &str, more: &str) -> Scenario {
        let text = format!(
            "duration = 10\n{more}[body.planar]\nangle = 1e-3\n[law.relay]\ndead_zone = 5e-4\nhysteresis = 1e-4\n\
             strong = 4e-5\nweak = 1e-6\nk_t = {k_t}\n"
        );
        Scenario::parse("test", &text).expect("a scenario")
    }

    fn differences(first: &Scenario, second: &Scenario) -> Vec<(String, [String; 2])> {
        let all = KeyDifference::between([first, second], ReaderUnits::Engineering);
        all.into_iter().map(|own| (own.key, own.texts)).collect()
    }

    #[test]
    fn keys_that_differ_have_both_values() {
        let (nominal, other) = (scenario("0.31", ""), scenario("0.310001", "reference.band = \"2 deg\"\n"));
        let texts = |first: &str, second: &str| [first.to_owned(), second.to_owned()];
        // Digits are added until the numbers differ.
        let expected = [
            ("law.relay.k_t".to_owned(), texts("0.310", "0.310001")),
            ("reference.band".to_owned(), texts("", "2 deg")),
        ];
        assert_eq!(differences(&nominal, &other), expected);
        assert_eq!(differences(&nominal, &nominal), []);
    }
}
