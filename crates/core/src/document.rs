//! A scenario's TOML text: keys addressed by their paths, and errors that point at the very value.

use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

use thiserror::Error;
use toml::de::{DeTable, DeValue};
use toml::{Spanned, Table, Value};

/// No scenario is longer (bytes).
const LONGEST: u64 = 4 << 20;

/// Errors show no more of a line than this before and after the place that they are about (characters).
const SHOWN: usize = 80;

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
    text: Option<String>,
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
        let table = text.parse::<Table>().map_err(|error| pointed(origin, &text, &error))?;
        Ok(Self { origin: origin.to_owned(), text: Some(text), table, changed: Vec::new() })
    }

    /// Takes a table that has no text, such as a Python dictionary.
    pub fn from_table(origin: &str, table: Table) -> Self {
        Self { origin: origin.to_owned(), text: None, table, changed: Vec::new() }
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
        if let (Some(text), true) = (&self.text, self.changed.is_empty()) {
            return toml::from_str(text).map_err(|error| pointed(&self.origin, text, &error));
        }
        Value::Table(self.table.clone()).try_into().map_err(|error: toml::de::Error| {
            // As a text, it shows which value is meant.
            let text = toml::to_string(&self.table).unwrap_or_default();
            let message = match toml::from_str::<T>(&text) {
                Err(error) => told(&text, &error).0,
                Ok(_) => explained(error.message(), None),
            };
            let set = match self.changed.as_slice() {
                [] => String::new(),
                changed => format!(" (with {} set)", changed.join(", ")),
            };
            ScenarioError::Invalid(format!("{}: {message}{set}", self.origin))
        })
    }

    /// An error at the first value of which a part was left unread: what was read of it is in `understood`.
    pub fn unread(&self, understood: &Table) -> Option<ScenarioError> {
        let mut pairs = self.table.iter().filter_map(|(key, value)| Some((key, value, understood.get(key)?)));
        let (key, why) = pairs.find_map(|(key, given, read)| unread(&bare_or_quoted(key), given, read))?;
        Some(self.inconsistent(&key, &why))
    }

    /// An error at a key, pointed at its value if the text has it.
    pub fn inconsistent(&self, key: &str, why: &str) -> ScenarioError {
        if let Some(text) = self.text.as_ref().filter(|_| !self.changed.iter().any(|k| k == key)) {
            let table = DeTable::parse(text).ok();
            if let Some(span) = table.and_then(|table| span_of(table.get_ref(), key)) {
                return ScenarioError::Invalid(point(&self.origin, text, span, &format!("`{key}` {why}")));
            }
        }
        ScenarioError::Invalid(format!("{}: `{key}` {why}", self.origin))
    }

    fn key_error(&self, key: &str, why: String) -> ScenarioError {
        ScenarioError::Key { origin: self.origin.clone(), key: key.to_owned(), why }
    }
}

/// The parser's error, pointed at the place that it is about.
fn pointed(origin: &str, text: &str, error: &toml::de::Error) -> ScenarioError {
    let (message, span) = told(text, error);
    ScenarioError::Invalid(match span {
        Some(span) => point(origin, text, span, &message),
        None => format!("{origin}: {message}"),
    })
}

/// The parser's error with the key that it is about, and the place.
fn told(text: &str, error: &toml::de::Error) -> (String, Option<Range<usize>>) {
    let span = error.span();
    let table = DeTable::parse(text).ok();
    // What is missing from the whole document has no place.
    let place =
        table.as_ref().zip(span.as_ref().filter(|span| !span.is_empty())).and_then(|(table, span)| {
            let (key, value) = place_of(table.get_ref(), span)?;
            Some((shortened(&key), value, &text[span.start..]))
        });
    let Some((key, value, from)) = place else { return (explained(error.message(), None), span) };
    let why = explained(error.message(), Some(value.type_str()));
    let why = bracketed(&key, from, &why).unwrap_or(why);
    let message = match value {
        DeValue::Table(kinds) if why.ends_with(MORE_THAN_ONE) => {
            let given: Vec<_> = kinds.keys().map(|kind| format!("`{}`", kind.get_ref())).collect();
            format!("`{key}`: {why}: {}", given.join(", "))
        }
        // A path without quotes is read as tables within tables.
        _ if key.starts_with("uncertain.") && !key.contains('"') => {
            format!("`{key}`: {why}; the path of an uncertain key stands in quotes")
        }
        _ => format!("`{key}`: {why}"),
    };
    (message, span)
}

const MORE_THAN_ONE: &str = "exactly one kind is accepted here, and more than one is given";

/// serde's words, where they would puzzle, in words of a scenario. `found` is the type of what was found.
fn explained(message: &str, found: Option<&str>) -> String {
    let message = message.trim_end();
    let what = match found {
        Some("datetime") => "a date",
        Some("array") => "an array",
        Some("integer" | "float") => "a number",
        Some("boolean") => "true or false",
        Some("string") => "a string",
        _ => "a table",
    };
    if message.starts_with("wanted exactly 1 element, more than 1") {
        return MORE_THAN_ONE.to_owned();
    }
    if message.starts_with("wanted exactly 1 element") {
        return "exactly one kind is needed here, and none is given".to_owned();
    }
    if message == "wanted string or table" {
        return format!("found {what}, expected the name of a kind or a table");
    }
    if message.contains("unit variant, expected") {
        return "found only the name of a kind that needs values of its own: a table".to_owned();
    }
    if message == "u64 value was too large" {
        return format!("found a number that is too large, expected {}", expected("u64"));
    }
    if let Some(found) = message.strip_suffix(" as i128, expected any valid TOML value") {
        let found = found.trim_start_matches("invalid type: ");
        return format!("found {found}, which is too large; a number so large is written with a point");
    }
    if let Some(missing) = message.strip_prefix("missing field ") {
        return format!("missing key {missing}");
    }
    if let Some((unknown, known)) = message.strip_prefix("unknown field ").and_then(|m| m.split_once(", ")) {
        return format!("unknown key {}, {known}", shortened(unknown));
    }
    if let Some((unknown, known)) = message.strip_prefix("unknown variant ").and_then(|m| m.split_once(", "))
    {
        return format!("{} is not known here, {known}", shortened(unknown));
    }
    for invalid in ["invalid type: ", "invalid value: ", "invalid length "] {
        let parts = message.strip_prefix(invalid).and_then(|rest| rest.rsplit_once(", expected "));
        if let Some((got, wanted)) = parts {
            let got = match got {
                "map" => what.to_owned(),
                "sequence" => "an array".to_owned(),
                _ if invalid == "invalid length " => format!("an array of length {got}"),
                _ => shortened(&got.replacen("floating point", "number", 1)),
            };
            return format!("found {got}, expected {}", expected(wanted));
        }
    }
    match message {
        "string values must be quoted, expected literal string" => {
            "found no TOML value; a text stands in quotes".to_owned()
        }
        "invalid float, expected nothing" => "found no number that TOML knows".to_owned(),
        "integer number overflowed" => "found no whole number that fits 64 bits".to_owned(),
        "floating-point number overflowed" => "found a number that is too large for a double".to_owned(),
        _ => message.to_owned(),
    }
}

/// What serde expected, in words of a scenario.
fn expected(wanted: &str) -> &str {
    match wanted {
        "f64" => "a number",
        "u32" => "a whole number from 0 to 4294967295",
        "u64" => "a whole number from 0 to 9223372036854775807",
        "a sequence" => "an array",
        "a map" => "a table",
        "a boolean" => "true or false",
        "a TOML datetime" => "a date and time without quotes, such as 2026-03-20T14:46:00Z",
        _ if wanted.starts_with("struct ") => "a table",
        _ => wanted,
    }
}

/// Says which brackets a header needs, if it has the wrong ones.
fn bracketed(key: &str, place: &str, why: &str) -> Option<String> {
    let double = place.starts_with("[[");
    let key = if double { key.rsplit_once('[')?.0 } else { key };
    match why {
        // An array can stand for a table: its first element is then read as the first key.
        "found a table, expected a number" | "found an array, expected a table" if double => {
            Some(format!("there is only one: expected `[{key}]`, found `[[{key}]]`"))
        }
        "found a table, expected an array" if place.starts_with('[') => {
            Some(format!("there can be several: expected `[[{key}]]`, found `[{key}]`"))
        }
        _ => None,
    }
}

/// A text that fits a message.
fn shortened(text: &str) -> String {
    match text.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

/// The first part of a value that is not in what was read of it: the key, and why.
fn unread(key: &str, given: &Value, read: &Value) -> Option<(String, String)> {
    match (given, read) {
        (Value::Table(given), Value::Table(read)) => given.iter().find_map(|(name, value)| {
            unread(&format!("{key}.{}", bare_or_quoted(name)), value, read.get(name)?)
        }),
        (Value::Array(given), Value::Array(read)) if given.len() > read.len() => {
            let why = format!("has {} values, expected {}", given.len(), read.len());
            Some((key.to_owned(), why))
        }
        (Value::Array(given), Value::Array(read)) => given
            .iter()
            .zip(read)
            .enumerate()
            .find_map(|(index, (given, read))| unread(&format!("{key}[{index}]"), given, read)),
        (Value::Array(_), Value::Table(_)) => {
            Some((key.to_owned(), "is an array, expected a table".to_owned()))
        }
        _ => None,
    }
}

/// The message with the line that it is about and a caret under the place.
fn point(origin: &str, text: &str, span: Range<usize>, message: &str) -> String {
    let start = span.start.min(text.len());
    let before = &text[..start];
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    let line_number = before.matches('\n').count() + 1;
    let column = text[line_start..start].chars().count();
    let line = text[line_start..].lines().next().unwrap_or_default();
    let marked = text[start..span.end.min(text.len()).max(start)].lines().next().unwrap_or_default();
    // A line may be as long as the file, and hold what a terminal obeys.
    let hidden = column.saturating_sub(SHOWN);
    let printable = |c: char| if c.is_control() { ' ' } else { c };
    let line: String = line.chars().skip(hidden).take(2 * SHOWN).map(printable).collect();
    let width = marked.chars().count().clamp(1, SHOWN);
    let (number, gutter) = (line_number.to_string(), " ".repeat(line_number.to_string().len()));
    let (indent, carets) = (" ".repeat(column - hidden), "^".repeat(width));
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

/// The steps of a path. A key that holds a dot stands in quotes: `uncertain."law.relay.k_t"`.
fn steps(path: &str) -> Option<Vec<Step<'_>>> {
    let mut steps = Vec::new();
    let mut rest = path;
    loop {
        if let Some(quoted) = rest.strip_prefix('"') {
            let (key, after) = quoted.split_once('"')?;
            steps.push(Step::Key(key));
            rest = after;
        } else {
            let (key, after) = rest.split_at(rest.find(['.', '[']).unwrap_or(rest.len()));
            if key.is_empty() {
                return None;
            }
            steps.push(key.parse().map_or(Step::Key(key), Step::Index));
            rest = after;
        }
        while let Some(indexed) = rest.strip_prefix('[') {
            let (index, after) = indexed.split_once(']')?;
            steps.push(Step::Index(index.parse().ok()?));
            rest = after;
        }
        if rest.is_empty() {
            return Some(steps);
        }
        rest = rest.strip_prefix('.')?;
    }
}

/// A key as it stands in a path.
fn bare_or_quoted(key: &str) -> String {
    let bare = |c: char| c.is_alphanumeric() || c == '_' || c == '-';
    if !key.is_empty() && key.chars().all(bare) { key.to_owned() } else { format!("\"{key}\"") }
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

/// The path and the value of a place in the text: of the value that stands there exactly, or else of the innermost
/// one around it.
fn place_of<'a>(table: &'a DeTable<'a>, span: &Range<usize>) -> Option<(String, &'a DeValue<'a>)> {
    let mut around = None;
    for (key, value) in table {
        let found = place_in(bare_or_quoted(key.get_ref()), value, span);
        match found {
            Some((true, path, value)) => return Some((path, value)),
            Some((false, path, value)) => around = around.or(Some((path, value))),
            None => {}
        }
    }
    around
}

/// The same within one value, and whether the place is exact.
fn place_in<'a>(
    path: String,
    value: &'a Spanned<DeValue<'a>>,
    span: &Range<usize>,
) -> Option<(bool, String, &'a DeValue<'a>)> {
    // The first table of an array of tables stands where the array does.
    let first = value.get_ref().as_array().and_then(|array| array.first());
    if value.span() == *span && first.is_none_or(|first| first.span() != *span) {
        return Some((true, path, value.get_ref()));
    }
    let parts: Vec<(String, &Spanned<DeValue<'_>>)> = match value.get_ref() {
        DeValue::Table(table) => {
            let path_of = |key: &str| format!("{path}.{}", bare_or_quoted(key));
            table.iter().map(|(key, value)| (path_of(key.get_ref()), value)).collect()
        }
        DeValue::Array(array) => {
            array.iter().enumerate().map(|(index, value)| (format!("{path}[{index}]"), value)).collect()
        }
        _ => Vec::new(),
    };
    let mut inner = None;
    for (path, part) in parts {
        match place_in(path, part, span) {
            Some(found @ (true, ..)) => return Some(found),
            found => inner = inner.or(found),
        }
    }
    let around = value.span().contains(&span.start);
    inner.or_else(|| around.then(|| (false, path, value.get_ref())))
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
