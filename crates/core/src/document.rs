//! A scenario's TOML text: keys addressed by their paths, and errors that point at the very value.

use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

use thiserror::Error;
use toml::de::{DeTable, DeValue};
use toml::{Table, Value};

/// No scenario is longer (bytes).
const LONGEST: u64 = 4 << 20;

/// A scenario that cannot be used. Its text names file, line, key, what was found and what is accepted.
#[derive(Debug, Error)]
pub enum ScenarioError {
    /// The file cannot be read.
    #[error("{}: {why}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        why: String,
    },
    /// The document says something that is not accepted.
    #[error("{0}")]
    Invalid(String),
    /// A key given beside the document is not accepted.
    #[error("{origin}: {key}: {why}")]
    Key {
        /// Where the document comes from.
        origin: String,
        /// The key.
        key: String,
        /// What is wrong.
        why: String,
    },
}

/// A scenario as written: its text, and the keys that were set since.
#[derive(Clone, Debug)]
pub struct Document {
    /// Where it comes from, for errors.
    origin: String,
    text: String,
    table: Table,
    changed: Vec<String>,
}

impl Document {
    /// Reads a file.
    pub fn load(path: &Path) -> Result<Self, ScenarioError> {
        let unreadable = |why: String| ScenarioError::Unreadable { path: path.to_owned(), why };
        let metadata = fs::metadata(path).map_err(|error| unreadable(error.to_string()))?;
        if !metadata.is_file() {
            return Err(unreadable("not a file".to_owned()));
        }
        if metadata.len() > LONGEST {
            return Err(unreadable(format!(
                "a scenario has at most {LONGEST} bytes, this file has {}",
                metadata.len()
            )));
        }
        let bytes = fs::read(path).map_err(|error| unreadable(error.to_string()))?;
        let text = String::from_utf8(bytes).map_err(|error| {
            let valid = &error.as_bytes()[..error.utf8_error().valid_up_to()];
            let line = 1 + valid.iter().filter(|byte| **byte == b'\n').count();
            unreadable(format!("line {line} is not UTF-8 text"))
        })?;
        Self::parse(&path.display().to_string(), text)
    }

    /// Takes a text. `origin` is what errors call it.
    pub fn parse(origin: &str, text: String) -> Result<Self, ScenarioError> {
        let table = text.parse::<Table>().map_err(|error| Self::pointed(origin, &text, &error))?;
        Ok(Self { origin: origin.to_owned(), text, table, changed: Vec::new() })
    }

    /// Takes a table that has no text, such as a Python dictionary.
    pub fn from_table(origin: &str, table: Table) -> Self {
        Self { origin: origin.to_owned(), text: String::new(), table, changed: Vec::new() }
    }

    /// Where the document comes from.
    pub fn origin(&self) -> &str {
        &self.origin
    }

    /// Sets a key, given by its path: `law.relay.k_t`, `body.planar.modes[0].frequency`.
    pub fn set(&mut self, key: &str, value: Value) -> Result<(), ScenarioError> {
        set(&mut self.table, key, value).map_err(|why| self.key_error(key, why))?;
        self.changed.push(key.to_owned());
        Ok(())
    }

    /// Sets a key to a value written as in TOML, such as `0.34` or `"dynamic"`; a bare word is a string.
    pub fn set_text(&mut self, key: &str, text: &str) -> Result<(), ScenarioError> {
        let value = format!("value = {text}").parse::<Table>().ok().and_then(|t| t.get("value").cloned());
        self.set(key, value.unwrap_or_else(|| Value::String(text.to_owned())))
    }

    /// The document as the type that it describes.
    pub fn read<T: serde::de::DeserializeOwned>(&self) -> Result<T, ScenarioError> {
        if self.changed.is_empty() && !self.text.is_empty() {
            return toml::from_str(&self.text)
                .map_err(|error| Self::pointed(&self.origin, &self.text, &error));
        }
        Value::Table(self.table.clone()).try_into().map_err(|error: toml::de::Error| {
            let text = error.to_string();
            let text = text.trim_end();
            let (why, key) = text.rsplit_once("\nin `").unwrap_or((text, ""));
            let set = if self.changed.is_empty() {
                String::new()
            } else {
                format!(" (with {} set)", self.changed.join(", "))
            };
            self.key_error(&format!("`{}`{set}", key.trim_end_matches('`')), explained(why))
        })
    }

    /// An error at a key, pointed at its value if the text has it.
    pub fn inconsistent(&self, key: &str, why: &str) -> ScenarioError {
        let found = DeTable::parse(&self.text).ok().and_then(|table| span_of(table.get_ref(), key));
        match found {
            Some(span) if !self.changed.iter().any(|k| k == key) => {
                let message = format!("`{key}` {why}");
                ScenarioError::Invalid(point(&self.origin, &self.text, span, &message))
            }
            _ => self.key_error(&format!("`{key}`"), why.to_owned()),
        }
    }

    fn key_error(&self, key: &str, why: String) -> ScenarioError {
        ScenarioError::Key { origin: self.origin.clone(), key: key.to_owned(), why }
    }

    fn pointed(origin: &str, text: &str, error: &toml::de::Error) -> ScenarioError {
        let why = explained(error.message());
        ScenarioError::Invalid(match error.span() {
            Some(span) => {
                let table = DeTable::parse(text).ok();
                let key = table.and_then(|table| key_at(table.get_ref(), span.start));
                let message = key.map_or(why.clone(), |key| format!("`{key}`: {why}"));
                point(origin, text, span, &message)
            }
            None => format!("{origin}: {why}"),
        })
    }
}

/// serde's words, where they would puzzle, in words of a scenario.
fn explained(message: &str) -> String {
    let message = message.trim_end();
    if message.starts_with("wanted exactly 1 element, more than 1") {
        return "exactly one kind is accepted here, and more than one is given".to_owned();
    }
    if message.starts_with("wanted exactly 1 element") {
        return "exactly one kind is needed here, and none is given".to_owned();
    }
    message.replace("invalid type: ", "found ").replace("expected f64", "expected a number")
}

/// The message with the line that it is about and a caret under the place.
fn point(origin: &str, text: &str, span: Range<usize>, message: &str) -> String {
    let start = span.start.min(text.len());
    let before = &text[..start];
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    let line_number = before.matches('\n').count() + 1;
    let column = text[line_start..start].chars().count();
    let line = text[line_start..].lines().next().unwrap_or_default();
    let width = text[start..span.end.min(text.len()).max(start)]
        .lines()
        .next()
        .map_or(1, |marked| marked.chars().count().max(1));
    let (number, gutter) = (line_number.to_string(), " ".repeat(line_number.to_string().len()));
    let (indent, carets) = (" ".repeat(column), "^".repeat(width));
    format!(
        "{origin}:{line_number}:{}: {message}\n{gutter} |\n{number} | {line}\n{gutter} | {indent}{carets}",
        column + 1,
    )
}

/// One step of a path: a key, or a place in an array.
#[derive(Clone, Debug, PartialEq)]
enum Step<'a> {
    Key(&'a str),
    Index(usize),
}

fn steps(path: &str) -> Option<Vec<Step<'_>>> {
    let mut steps = Vec::new();
    for part in path.split('.') {
        let mut pieces = part.split('[');
        let key = pieces.next().filter(|key| !key.is_empty())?;
        steps.push(key.parse().map_or(Step::Key(key), Step::Index));
        for piece in pieces {
            steps.push(Step::Index(piece.strip_suffix(']')?.parse().ok()?));
        }
    }
    Some(steps)
}

/// The value at a path.
pub fn get<'a>(table: &'a Table, path: &str) -> Option<&'a Value> {
    let mut steps = steps(path)?.into_iter();
    let Some(Step::Key(first)) = steps.next() else { return None };
    let first = table.get(first)?;
    steps.try_fold(first, |value, step| match step {
        Step::Key(key) => value.get(key),
        Step::Index(index) => value.get(index),
    })
}

/// Puts a value at a path. Tables on the way are made, places in arrays must be there.
pub fn set(table: &mut Table, path: &str, value: Value) -> Result<(), String> {
    let not_a_path = || "not the path of a key, such as `law.relay.k_t` or `body.planar.modes[0].gain`";
    let steps = steps(path).ok_or_else(not_a_path)?;
    let Some((Step::Key(first), rest)) = steps.split_first() else {
        return Err(not_a_path().to_owned());
    };
    let mut place = table.entry(*first).or_insert_with(|| Value::Table(Table::new()));
    for step in rest {
        place = match (step, place) {
            (Step::Key(key), Value::Table(inner)) => {
                inner.entry(*key).or_insert_with(|| Value::Table(Table::new()))
            }
            (Step::Index(index), Value::Array(array)) => {
                let length = array.len();
                array
                    .get_mut(*index)
                    .ok_or_else(|| format!("there is no element {index}: the array has {length}"))?
            }
            (Step::Key(key), other) => {
                return Err(format!("there is no `{key}` in a value of type {}", other.type_str()));
            }
            (Step::Index(index), other) => {
                return Err(format!("there is no element {index} in a {}", other.type_str()));
            }
        };
    }
    *place = value;
    Ok(())
}

/// Where the value at a path stands in the text; the nearest table above it if it is not written.
fn span_of(table: &DeTable<'_>, path: &str) -> Option<Range<usize>> {
    let mut steps = steps(path)?.into_iter();
    let Some(Step::Key(first)) = steps.next() else { return None };
    let mut value = table.get(first)?;
    for step in steps {
        let inner = match (step, value.get_ref()) {
            (Step::Key(key), DeValue::Table(table)) => table.get(key),
            (Step::Index(index), DeValue::Array(array)) => array.get(index),
            _ => None,
        };
        match inner {
            Some(inner) => value = inner,
            None => break,
        }
    }
    Some(value.span())
}

/// The path of the innermost key whose value stands at a place in the text.
fn key_at(table: &DeTable<'_>, offset: usize) -> Option<String> {
    let mut found = None;
    for (key, value) in table {
        let within = match value.get_ref() {
            DeValue::Table(inner) => key_at(inner, offset),
            DeValue::Array(array) => array.iter().enumerate().find_map(|(index, element)| {
                let inner = match element.get_ref() {
                    DeValue::Table(table) => key_at(table, offset).map(|k| format!("[{index}].{k}")),
                    _ => None,
                };
                let here = || element.span().contains(&offset).then(|| format!("[{index}]"));
                inner.or_else(here)
            }),
            _ => None,
        };
        if let Some(inner) = within {
            let joint = if inner.starts_with('[') { "" } else { "." };
            found = Some(format!("{}{joint}{inner}", key.get_ref()));
        } else if value.span().contains(&offset) && found.is_none() {
            found = Some(key.get_ref().to_string());
        }
    }
    found
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
    }
}
