//! Paths of keys, such as `law.relay.k_t` or `body.planar.modes[0].gain`, in tables and in texts.

use std::ops::Range;

use toml::de::{DeString, DeTable, DeValue};
use toml::{Spanned, Table, Value};

use super::nesting::{DEEPEST, WHY};
use super::suggestions::{american_spelling, british_spelling};

/// One step of a path: a key, or an index into an array.
#[derive(Clone, Debug, PartialEq)]
enum PathStep<'a> {
    Key(&'a str),
    Index(usize),
}

/// Splits a path into its steps. A key that contains a dot stands in quotes: `uncertain."law.relay.k_t"`.
fn steps(path: &str) -> Option<Vec<PathStep<'_>>> {
    let mut steps = Vec::new();
    let mut rest = path;
    loop {
        if let Some(quoted) = rest.strip_prefix('"') {
            let (key, after) = quoted.split_once('"')?;
            steps.push(PathStep::Key(key));
            rest = after;
        } else {
            let (key, after) = rest.split_at(rest.find(['.', '[']).unwrap_or(rest.len()));
            if key.is_empty() {
                return None;
            }
            steps.push(key.parse().map_or(PathStep::Key(british_spelling(key)), PathStep::Index));
            rest = after;
        }
        while let Some(indexed) = rest.strip_prefix('[') {
            let (index, after) = indexed.split_once(']')?;
            steps.push(PathStep::Index(index.parse().ok()?));
            rest = after;
        }
        if rest.is_empty() {
            return Some(steps);
        }
        rest = rest.strip_prefix('.')?;
    }
}

/// Renames the keys of a table to the spelling of scenarios: `center` becomes `centre`.
pub fn respell(table: &mut Table) {
    fn within(value: &mut Value) {
        match value {
            Value::Table(table) => respell(table),
            Value::Array(values) => values.iter_mut().for_each(within),
            _ => {}
        }
    }
    if table.keys().any(|key| british_spelling(key) != key && !table.contains_key(british_spelling(key))) {
        *table = std::mem::take(table)
            .into_iter()
            .map(|(key, value)| (british_spelling(&key).to_owned(), value))
            .collect();
    }
    table.iter_mut().for_each(|(_, value)| within(value));
}

/// Returns a key as it is written in a path, in quotes if necessary.
pub fn bare_or_quoted(key: &str) -> String {
    let bare = |c: char| c.is_alphanumeric() || c == '_' || c == '-';
    if !key.is_empty() && key.chars().all(bare) { key.to_owned() } else { format!("\"{key}\"") }
}

/// Returns the paths of the tables of this name within a table, in the order of the document.
pub fn tables_named(table: &Table, name: &str) -> Vec<String> {
    fn search(value: &Value, path: &str, name: &str, found: &mut Vec<String>) {
        match value {
            Value::Table(table) => {
                for (key, value) in table {
                    let path =
                        format!("{path}{}{}", if path.is_empty() { "" } else { "." }, bare_or_quoted(key));
                    if value.is_table() && key == name {
                        found.push(path.clone());
                    }
                    search(value, &path, name, found);
                }
            }
            Value::Array(values) => {
                for (index, value) in values.iter().enumerate() {
                    search(value, &format!("{path}[{index}]"), name, found);
                }
            }
            _ => {}
        }
    }
    let mut found = Vec::new();
    for (key, value) in table {
        search(value, &bare_or_quoted(key), name, &mut found);
    }
    found
}

/// Returns the value at a path.
pub fn get<'a>(table: &'a Table, path: &str) -> Option<&'a Value> {
    let mut steps = steps(path)?.into_iter();
    let Some(PathStep::Key(first)) = steps.next() else { return None };
    let first = table.get(first)?;
    steps.try_fold(first, |value, step| match step {
        PathStep::Key(key) => value.get(key),
        PathStep::Index(index) => value.get(index),
    })
}

/// Returns the places of the steps of a path in the tables of a document, by which keys are in its order. Keys that are not there
/// come last.
pub fn rank(table: &Table, path: &str) -> Vec<usize> {
    let (mut table, mut value) = (Some(table), None::<&Value>);
    let rank = |step: PathStep<'_>| {
        let (rank, inner) = match step {
            PathStep::Key(key) => {
                let place = table.and_then(|table| table.iter().position(|(name, _)| name == key));
                (place.unwrap_or(usize::MAX), table.and_then(|table| table.get(key)))
            }
            PathStep::Index(index) => (index, value.and_then(|value| value.get(index))),
        };
        (table, value) = (inner.and_then(Value::as_table), inner);
        rank
    };
    steps(path).unwrap_or_default().into_iter().map(rank).collect()
}

/// Sets the value at a path. Missing tables are created; array elements must exist.
pub fn set(table: &mut Table, path: &str, value: Value) -> Result<(), String> {
    let not_a_path = || "not the path of a key, such as `law.relay.k_t` or `body.planar.modes[0].gain`";
    let steps = steps(path).ok_or_else(not_a_path)?;
    if steps.len() > DEEPEST {
        return Err(WHY.to_owned());
    }
    let Some((PathStep::Key(first), rest)) = steps.split_first() else {
        return Err(not_a_path().to_owned());
    };
    let mut place = table.entry(*first).or_insert_with(|| Value::Table(Table::new()));
    for step in rest {
        place = match (step, place) {
            (PathStep::Key(key), Value::Table(inner)) => {
                inner.entry(*key).or_insert_with(|| Value::Table(Table::new()))
            }
            (PathStep::Index(index), Value::Array(array)) => {
                let length = array.len();
                array
                    .get_mut(*index)
                    .ok_or_else(|| format!("there is no element {index}: the array has {length}"))?
            }
            (PathStep::Key(key), other) => {
                return Err(format!("there is no `{key}` in a value of type {}", other.type_str()));
            }
            (PathStep::Index(index), other) => {
                return Err(format!("there is no element {index} in a {}", other.type_str()));
            }
        };
    }
    *place = value;
    Ok(())
}

/// Returns the span in the text of the value at a path, or of the nearest table above it if it is not written.
pub fn span_of(table: &DeTable<'_>, path: &str) -> Option<Range<usize>> {
    nearest(table, path).map(Spanned::span)
}

/// Returns the span in the text of a key of the table at a path; an empty path is the whole document.
pub fn span_of_key(table: &DeTable<'_>, path: &str, key: &str) -> Option<Range<usize>> {
    let within = if path.is_empty() { table } else { nearest(table, path)?.get_ref().as_table()? };
    written(within, key).map(|(key, _)| key.span())
}

/// Returns a key as it is written in the text, in either spelling, with its value.
fn written<'a>(
    table: &'a DeTable<'a>,
    key: &str,
) -> Option<(&'a Spanned<DeString<'a>>, &'a Spanned<DeValue<'a>>)> {
    table.get_key_value(key).or_else(|| table.get_key_value(american_spelling(key)?))
}

/// Returns the value at a path, or the nearest table above it.
fn nearest<'a>(table: &'a DeTable<'a>, path: &str) -> Option<&'a Spanned<DeValue<'a>>> {
    let mut steps = steps(path)?.into_iter();
    let Some(PathStep::Key(first)) = steps.next() else { return None };
    let mut value = written(table, first)?.1;
    for step in steps {
        let inner = match (step, value.get_ref()) {
            (PathStep::Key(key), DeValue::Table(table)) => written(table, key).map(|(_, value)| value),
            (PathStep::Index(index), DeValue::Array(array)) => array.get(index),
            _ => None,
        };
        match inner {
            Some(inner) => value = inner,
            None => break,
        }
    }
    Some(value)
}

/// Returns the path of the innermost value that contains a place in the text.
pub fn path_of(table: &DeTable<'_>, place: &Range<usize>) -> Option<String> {
    table.iter().find_map(|(key, value)| path_in(bare_or_quoted(key.get_ref()), value, place))
}

fn path_in(path: String, value: &Spanned<DeValue<'_>>, place: &Range<usize>) -> Option<String> {
    let inner = match value.get_ref() {
        DeValue::Table(table) => table.iter().find_map(|(key, value)| {
            path_in(format!("{path}.{}", bare_or_quoted(key.get_ref())), value, place)
        }),
        DeValue::Array(array) => {
            let mut values = array.iter().enumerate();
            values.find_map(|(index, value)| path_in(format!("{path}[{index}]"), value, place))
        }
        _ => None,
    };
    inner.or_else(|| value.span().contains(&place.start).then_some(path))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_reach_into_tables_and_arrays() {
        let mut table: Table = "[a]\nb = [{c = 1}, {c = 2}]".parse().expect("valid");
        assert_eq!(get(&table, "a.b[1].c"), Some(&Value::Integer(2)));
        set(&mut table, "a.b[0].c", Value::Integer(7)).expect("there");
        assert_eq!(get(&table, "a.b[0].c"), Some(&Value::Integer(7)));
        set(&mut table, "x.y", Value::Boolean(true)).expect("made");
        assert_eq!(get(&table, "x.y"), Some(&Value::Boolean(true)));
        assert!(set(&mut table, "a.b[2].c", Value::Integer(7)).is_err());
        assert!(set(&mut table, "a.b.c", Value::Integer(7)).is_err());
        assert!(set(&mut table, "a..c", Value::Integer(7)).is_err());
        set(&mut table, "x.\"y.z\"[0]", Value::Integer(7)).expect_err("no array");
        set(&mut table, "x.\"y.z\"", Value::Integer(7)).expect("made");
        assert_eq!(get(&table, "x").and_then(|x| x.get("y.z")), Some(&Value::Integer(7)));
    }
}
