//! TOML text of a scenario: keys addressed by their paths, and errors that point at the value.

mod fault;
pub mod key;
mod messages;
mod mismatch;
mod mistake;
mod mistakes;
mod nesting;
mod quantity;
mod reader;
mod suggestions;
mod units;

use std::borrow::Cow;
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

use thiserror::Error;
use toml::de::DeTable;
use toml::{Table, Value};

pub use fault::ConfigError;
pub use mismatch::Mismatch;
pub use mistake::{Diagnostic, TextPlace};
pub use quantity::{is_number, number_in, unit_at, unit_of_text, units_ratio, unknown_unit};
pub use reader::{DATE, read_value};
pub use suggestions::nearest_name as nearest;

use key::{bare_or_quoted, span_of};
use messages::{diagnostic, mismatch, mismatch_at, parse_error};
use mistake::shortened;

use crate::read_files;

/// Depth of an array that no key accepts.
const UNFIT_DEPTH: usize = 4;

/// Largest length of a scenario (bytes).
pub const LONGEST: u64 = 4 << 20;

/// Error of an invalid scenario. Its text names file, line, key, the found value and the accepted values.
#[derive(Debug, Error)]
pub enum ScenarioError {
    /// Unreadable file.
    #[error("{}: {why}", path.display())]
    Unreadable {
        /// Path of the file.
        path: PathBuf,
        /// Reason.
        why: String,
    },
    /// Document with errors.
    #[error("{}", join_diagnostics(.0))]
    Invalid(Vec<Diagnostic>),
    /// Key set in addition to the document that is not accepted.
    #[error("{origin}: {key}: {why}")]
    Key {
        /// Name of the document's source.
        origin: String,
        /// Path of the key.
        key: String,
        /// Error message.
        why: String,
    },
}

/// Joins the messages of several errors, one on each line.
fn join_diagnostics(mistakes: &[Diagnostic]) -> String {
    mistakes.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

impl ScenarioError {
    /// Creates the error of keys that are not those of a text.
    pub fn without_places(origin: &str, errors: Vec<ConfigError>) -> Self {
        let diagnostic =
            |ConfigError { key, why, .. }| Diagnostic::new(origin, format!("{key}: {why}")).about(key);
        Self::Invalid(errors.into_iter().map(diagnostic).collect())
    }

    /// Returns all errors.
    pub fn mistakes(&self) -> Vec<Diagnostic> {
        match self {
            Self::Unreadable { path, why } => vec![Diagnostic::new(&path.display().to_string(), why)],
            Self::Invalid(mistakes) => mistakes.clone(),
            Self::Key { origin, key, why } => {
                vec![Diagnostic::new(origin, format!("{key}: {why}")).about(key)]
            }
        }
    }
}

impl Diagnostic {
    /// Returns the scenario error that consists of this error alone.
    fn single_error(self) -> ScenarioError {
        ScenarioError::Invalid(vec![self])
    }
}

/// Scenario as written: its text, and the keys that were set afterwards.
#[derive(Clone, Debug)]
pub struct Document {
    /// Name of the document's source, for messages.
    origin: String,
    text: Option<String>,
    table: Table,
    changed: Vec<String>,
}

impl Document {
    /// Reads a document from a file.
    pub fn load(path: &Path) -> Result<Self, ScenarioError> {
        let unreadable = |why: String| ScenarioError::Unreadable { path: path.to_owned(), why };
        let metadata = fs::metadata(path).map_err(|error| unreadable(error.to_string()))?;
        if !metadata.is_file() {
            return Err(unreadable("not a file".to_owned()));
        }
        if metadata.len() > LONGEST {
            return Err(unreadable(too_long(metadata.len())));
        }
        let bytes = fs::read(path).map_err(|error| unreadable(error.to_string()))?;
        read_files::add(path);
        Self::read_bytes(path, bytes)
    }

    /// Parses the contents of a file that messages call `path`.
    pub fn read_bytes(path: &Path, bytes: Vec<u8>) -> Result<Self, ScenarioError> {
        let unreadable = |why: String| ScenarioError::Unreadable { path: path.to_owned(), why };
        if bytes.len() as u64 > LONGEST {
            return Err(unreadable(too_long(bytes.len() as u64)));
        }
        let text = String::from_utf8(bytes).map_err(|error| {
            let valid = &error.as_bytes()[..error.utf8_error().valid_up_to()];
            let line = 1 + valid.iter().filter(|byte| **byte == b'\n').count();
            unreadable(format!("line {line} is not UTF-8 text"))
        })?;
        Self::parse(&path.display().to_string(), text)
    }

    /// Parses a text that messages call `origin`.
    pub fn parse(origin: &str, text: String) -> Result<Self, ScenarioError> {
        let mut table =
            text.parse::<Table>().map_err(|error| parse_error(origin, &text, &error).single_error())?;
        key::respell(&mut table);
        Ok(Self { origin: origin.to_owned(), text: Some(text), table, changed: Vec::new() })
    }

    /// Creates a document from a table without a text, such as a Python dictionary.
    pub fn from_table(origin: &str, mut table: Table) -> Self {
        key::respell(&mut table);
        Self { origin: origin.to_owned(), text: None, table, changed: Vec::new() }
    }

    /// Returns the name of the document's source.
    pub fn origin(&self) -> &str {
        &self.origin
    }

    /// Returns the text that the document was parsed from; `None` of a table.
    pub fn source_text(&self) -> Option<&str> {
        self.text.as_deref()
    }

    /// Returns the table with all keys.
    pub fn table(&self) -> &Table {
        &self.table
    }

    /// Returns true if the document has a key, such as `log.period`.
    pub fn has(&self, key: &str) -> bool {
        let (tables, last) = key.rsplit_once('.').unwrap_or(("", key));
        let mut tables = tables.split('.').filter(|name| !name.is_empty());
        let within = tables.try_fold(&self.table, |table, name| table.get(name)?.as_table());
        within.is_some_and(|table| table.contains_key(last))
    }

    /// Returns the text of a top-level key, if its value is a string.
    pub fn text_of(&self, key: &str) -> Option<&str> {
        self.table.get(key).and_then(Value::as_str)
    }

    /// Returns the error of a missing top-level key.
    pub fn missing(&self, key: &str) -> ScenarioError {
        let message = format!("missing key `{key}`");
        let mistake = Diagnostic::new(&self.origin, message).about(key);
        match &self.text {
            Some(text) => mistake.at(text, &(0..0)).single_error(),
            None => mistake.single_error(),
        }
    }

    /// Sets a key, given by its path, such as `law.relay.k_t` or `body.planar.modes[0].frequency`.
    pub fn set(&mut self, key: &str, value: Value) -> Result<(), ScenarioError> {
        key::set(&mut self.table, key, value).map_err(|why| self.key_error(key, why))?;
        self.changed.push(key.to_owned());
        Ok(())
    }

    /// Sets a key to a value written as in TOML, such as `0.34` or `"dynamic"`; a bare word is a string.
    pub fn set_text(&mut self, key: &str, text: &str) -> Result<(), ScenarioError> {
        let value = format!("value = {text}").parse::<Table>().ok().and_then(|t| t.get("value").cloned());
        self.set(key, value.unwrap_or_else(|| Value::String(text.to_owned())))
    }

    /// Returns the document with numbers with units, such as `"2 deg"`, converted to SI; `schema` gives the units of
    /// keys.
    ///
    /// # Errors
    /// An unknown unit, or one that does not fit its key, with all other errors of the document as a value of type `T`.
    pub fn in_si<T: serde::de::DeserializeOwned>(
        &self,
        schema: impl FnOnce() -> &'static serde_json::Value,
    ) -> Result<Cow<'_, Self>, ScenarioError> {
        if !quantity::any(&self.table) {
            return Ok(Cow::Borrowed(self));
        }
        let mut converted = self.clone();
        let faults = quantity::to_si(&mut converted.table, schema());
        if faults.is_empty() {
            return Ok(Cow::Owned(converted));
        }
        let mut all = self.diagnostics(&faults);
        if let Err(wrong) = reader::read::<T>(&converted.table) {
            let is_known = |wrong: &Mismatch| faults.iter().any(|fault| fault.key == wrong.path());
            let others = mistakes::all::<T>(&converted.table, wrong).into_iter();
            all.extend(others.filter(|wrong| !is_known(wrong)).map(|wrong| self.unfit(&wrong)));
            all.sort_by_key(|diagnostic| diagnostic.place.as_ref().map_or(usize::MAX, |place| place.line));
        }
        Err(ScenarioError::Invalid(all))
    }

    /// Returns the text with numbers of keys in place of theirs, in the units in which they are written; each number with its key
    /// is in an SI unit. `None` if the text does not have all of them as numbers.
    pub fn text_with_numbers<'a>(
        &self,
        numbers: impl Iterator<Item = (&'a str, f64, &'a str)>,
    ) -> Option<String> {
        let text = self.text.as_deref().filter(|_| self.changed.is_empty())?;
        let table = DeTable::parse(text).ok()?;
        let mut places = Vec::new();
        for (key, number, unit) in numbers {
            let written = key::get(&self.table, key)?;
            let new = match written.as_str() {
                Some(old) => {
                    let own = unit_of_text(old)?;
                    let size = quantity::number_in(&format!("1 {own}"), unit).ok()?;
                    format!("\"{} {own}\"", number / size)
                }
                None if written.is_float() || written.is_integer() => format!("{number:?}"),
                None => return None,
            };
            places.push((span_of(table.get_ref(), key)?, new));
        }
        places.sort_by_key(|(span, _)| span.start);
        let mut changed = text.to_owned();
        for (span, new) in places.into_iter().rev() {
            changed.replace_range(span, &new);
        }
        Some(changed)
    }

    /// Reads the document as a value of type `T`.
    pub fn read<T: serde::de::DeserializeOwned>(&self) -> Result<T, ScenarioError> {
        let wrong = match reader::read(&self.table) {
            Ok(part) => return Ok(part),
            Err(wrong) => wrong,
        };
        let all = mistakes::all::<T>(&self.table, wrong);
        Err(ScenarioError::Invalid(all.iter().map(|wrong| self.unfit(wrong)).collect()))
    }

    /// Returns true if type `T` has a key beside the kinds that the document names: of a value that no key accepts,
    /// the type is then the only error.
    pub fn knows<T: serde::de::DeserializeOwned>(&self, key: &str) -> bool {
        let mut table = self.table.clone();
        let unfit = (0..UNFIT_DEPTH).fold(Value::Array(Vec::new()), |inner, _| Value::Array(vec![inner]));
        key::set(&mut table, key, unfit).is_ok()
            && reader::read::<T>(&table).err().is_none_or(|wrong| !wrong.is_of_names())
    }

    /// Returns the error of a mismatch, with its place if the text has it.
    fn unfit(&self, wrong: &Mismatch) -> Diagnostic {
        let message = match (&self.text, self.changed.as_slice()) {
            (Some(text), []) => return mismatch(&self.origin, text, wrong),
            (_, []) => mismatch_at(wrong),
            (_, changed) => match meant_of(wrong, changed, &self.table) {
                Some((key, meant)) => {
                    return diagnostic(
                        &self.origin,
                        wrong,
                        format!("there is no key `{key}`; did you mean `{meant}`?"),
                    );
                }
                None => format!("{} (with {} set)", mismatch_at(wrong), changed.join(", ")),
            },
        };
        diagnostic(&self.origin, wrong, message)
    }

    /// Returns the error of a fault, with the place of its value if the text has it.
    pub fn at_key(&self, fault: &ConfigError) -> ScenarioError {
        self.at_keys(std::slice::from_ref(fault))
    }

    /// Returns the error of faults, in the order of the text and with the places of their values; those without a place
    /// stand at the end, in the order of the keys.
    pub fn at_keys(&self, faults: &[ConfigError]) -> ScenarioError {
        ScenarioError::Invalid(self.diagnostics(faults))
    }

    /// Returns the diagnostics of faults in the order of [`Self::at_keys`].
    fn diagnostics(&self, faults: &[ConfigError]) -> Vec<Diagnostic> {
        let text = self.text.as_deref().unwrap_or_default();
        let table = DeTable::parse(text).ok();
        let place = |fault: &ConfigError| {
            let written = table.as_ref().filter(|_| !self.changed.contains(&fault.key))?;
            Some(fault.span_in(text, span_of(written.get_ref(), &fault.key)?))
        };
        let mut placed: Vec<_> = faults.iter().map(|fault| (place(fault), fault)).collect();
        let start = |place: &Option<Range<usize>>| place.as_ref().map_or(usize::MAX, |span| span.start);
        placed.sort_by_key(|(place, fault)| (start(place), key::rank(&self.table, &fault.key)));
        let diagnostic = |(place, fault): (Option<Range<usize>>, &ConfigError)| {
            let diagnostic = Diagnostic::new(&self.origin, fault.to_string()).about(&fault.key);
            match place {
                Some(span) => diagnostic.at(text, &span),
                None => diagnostic,
            }
        };
        placed.into_iter().map(diagnostic).collect()
    }

    fn key_error(&self, key: &str, why: String) -> ScenarioError {
        ScenarioError::Key { origin: self.origin.clone(), key: shortened(key), why }
    }
}

/// Key that was set within a table of a wrong name, and the one that was probably meant: in a table of nearly this name,
/// or in a table of this name elsewhere in the document.
fn meant_of(wrong: &Mismatch, changed: &[String], table: &Table) -> Option<(String, String)> {
    let (path, name) = (wrong.path(), bare_or_quoted(wrong.key()?));
    let within = |name: &str| if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") };
    let wrong_path = within(&name);
    let (key, rest) = changed.iter().find_map(|key| Some((key, key.strip_prefix(&wrong_path)?)))?;
    let elsewhere = || key::tables_named(table, &name).into_iter().find(|place| *place != wrong_path);
    let place = wrong.meant().map(within).or_else(elsewhere)?;
    rest.starts_with(['.', '[']).then(|| (shortened(key), shortened(&format!("{place}{rest}"))))
}

fn too_long(length: u64) -> String {
    format!("a scenario has at most {LONGEST} bytes, this file has {length}")
}

/// Reads a part of a scenario, such as one law, from a TOML text of its own, for unit tests.
pub fn from_text<T: serde::de::DeserializeOwned>(text: &str) -> Result<T, ScenarioError> {
    let table = text.parse().map_err(|error| parse_error("text", text, &error).single_error())?;
    read_value(&Value::Table(table)).map_err(|wrong| mismatch("text", text, &wrong).single_error())
}
