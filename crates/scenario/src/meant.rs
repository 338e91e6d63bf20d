//! Keys of numbers that were probably meant by those that there are not.

use flexsc_formats::document::{key, nearest};
use toml::{Table, Value};

/// Largest number of paths that are compared with a misspelt key: elements of a large matrix are not meant.
const MOST_PATHS: usize = 20_000;

/// The key of a number that was probably meant by one that there is not.
pub fn number(table: &Table, key: &str) -> Option<String> {
    let mut paths = Vec::new();
    for (name, value) in table {
        numbers(value, key::bare_or_quoted(name), &mut paths);
    }
    let known: Vec<&str> = paths.iter().map(String::as_str).collect();
    nearest(key, &known).map(str::to_owned)
}

fn numbers(value: &Value, path: String, paths: &mut Vec<String>) {
    match value {
        _ if paths.len() == MOST_PATHS => {}
        Value::Integer(_) | Value::Float(_) => paths.push(path),
        Value::Array(values) => {
            values
                .iter()
                .enumerate()
                .for_each(|(index, value)| numbers(value, format!("{path}[{index}]"), paths));
        }
        Value::Table(table) => {
            for (name, value) in table {
                numbers(value, format!("{path}.{}", key::bare_or_quoted(name)), paths);
            }
        }
        _ => {}
    }
}
