//! Keys of a scenario that an importer can set before the start.

use toml::{Table, Value};

/// Keys at the root of a scenario whose numbers do not change the motion, or have a meaning of their own in an FMU.
const LEFT_OUT: [&str; 9] =
    ["log", "uncertain", "correlated", "bound", "requirement", "reference", "duration", "seed", "metrics"];
/// Largest number of elements of an array of tables whose keys are parameters.
const MOST_ELEMENTS: usize = 32;

/// Key with a number.
#[derive(Clone, Debug, PartialEq)]
pub struct NumericKey {
    /// Path, as `--set` takes it.
    pub path: String,
    /// Value in the scenario.
    pub value: f64,
}

/// Returns the keys of a scenario's table that hold a number, apart from the elements of arrays of numbers.
pub fn numeric_keys(table: &Table) -> Vec<NumericKey> {
    let mut found = Vec::new();
    for (key, value) in table.iter().filter(|(key, _)| !LEFT_OUT.contains(&key.as_str())) {
        collect(key.clone(), value, &mut found);
    }
    found
}

fn collect(path: String, value: &Value, found: &mut Vec<NumericKey>) {
    match value {
        Value::Float(value) if value.is_finite() => found.push(NumericKey { path, value: *value }),
        Value::Table(table) => {
            for (key, value) in table.iter().filter(|(key, _)| is_plain(key)) {
                collect(format!("{path}.{key}"), value, found);
            }
        }
        Value::Array(values) if values.len() <= MOST_ELEMENTS && values.iter().all(Value::is_table) => {
            for (index, value) in values.iter().enumerate() {
                collect(format!("{path}[{index}]"), value, found);
            }
        }
        _ => {}
    }
}

/// True if a key needs no quotes in a path, nor in the name of a variable.
fn is_plain(key: &str) -> bool {
    let mut letters = key.chars();
    letters.next().is_some_and(|first| first.is_ascii_alphabetic() || first == '_')
        && letters.all(|letter| letter.is_ascii_alphanumeric() || letter == '_')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_paths_of_their_keys() {
        let text = "duration = 9.0\nseed = 3\n[law.pd]\nk_p = 2.0\nname = \"x\"\n[[body.planar.modes]]\nfrequency = 0.4\n\
            [body.planar]\nrates = [1.0, 2.0]\n[uncertain]\n\"law.pd.k_p\" = { low = 1.0 }\n[law.\"a b\"]\nc = 1.0\n";
        let text = text.replace("[body.planar]\nrates = [1.0, 2.0]\n", "");
        let paths: Vec<String> =
            numeric_keys(&text.parse().expect("TOML")).into_iter().map(|key| key.path).collect();
        assert_eq!(paths, ["law.pd.k_p", "body.planar.modes[0].frequency"]);
    }
}
