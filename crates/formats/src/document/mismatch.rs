//! Mismatch between a value and the type that is read: the key, and the reason in an engineer's words.

use std::fmt;

use serde::de::{Error, Expected, Unexpected};
use toml::{Table, Value};

use super::key::bare_or_quoted;
use super::mistake::shortened;
use super::suggestions::{hint, nearest_name};

/// Mismatch of a value with the type that is read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mismatch {
    /// Path to the value, innermost step first, each as written in a path.
    steps: Vec<String>,
    /// Key within that value, if the key itself is wrong.
    key: Option<String>,
    why: String,
    /// Name that was probably meant.
    meant: Option<&'static str>,
    /// Missing key.
    missing: Option<&'static str>,
    /// True if names are wrong: an unknown one, or several kinds in the place of one.
    of_names: bool,
}

impl Mismatch {
    fn because(why: impl Into<String>) -> Self {
        Self { steps: Vec::new(), key: None, why: why.into(), meant: None, missing: None, of_names: false }
    }

    /// Returns the mismatch of a value that is not a kind.
    pub fn no_kind(value: &Value) -> Self {
        let found = match value {
            Value::Datetime(_) => "a date",
            Value::Array(_) => "an array",
            Value::Integer(_) | Value::Float(_) => "a number",
            Value::Boolean(_) => "true or false",
            Value::String(_) => "a string",
            Value::Table(_) => "a table",
        };
        Self::because(format!("found {found}, expected the name of a kind or a table"))
    }

    /// Several kinds in the place of one, of those that are known: the first that is not is the mistake.
    pub fn several_kinds(kinds: &Table, known: &'static [&'static str]) -> Self {
        let unknown = kinds.keys().find(|kind| !known.is_empty() && !known.contains(&kind.as_str()));
        if let Some(kind) = unknown.filter(|kind| nearest_name(kind, known).is_some()) {
            return Self::unknown_variant(kind, known).at_key(kind);
        }
        let accepted: Vec<_> = kinds.keys().map(|kind| format!("`{kind}`")).collect();
        let accepted = accepted.join(", ");
        let why = format!("exactly one kind is accepted here, and more than one is given: {accepted}");
        Self { of_names: true, ..Self::because(why) }
    }

    /// Returns the mismatch of an array with more values than are read.
    pub fn too_many_values(found: usize, expected: usize) -> Self {
        Self::because(format!("has {found} values, expected {expected}"))
    }

    /// Returns the mismatch of a name whose kind needs a table.
    pub fn only_a_name() -> Self {
        Self::because("found only the name of a kind that needs values of its own: a table")
    }

    /// Returns the mismatch of a name that is not among the known ones.
    fn unknown(name: &str, accepted: &str, known: &'static [&'static str], none: &str) -> Self {
        let hint = hint(accepted, known).map_or_else(String::new, |hint| format!("; {hint}"));
        let why = format!("{name}, {}{hint}", accepted_names(known, none));
        Self { meant: nearest_name(accepted, known), of_names: true, ..Self::because(why) }
    }

    /// Sets the key that is itself wrong.
    #[must_use]
    pub fn at_key(self, key: &str) -> Self {
        Self { key: Some(key.to_owned()), ..self }
    }

    /// Returns the mismatch as one within the value of `key`.
    #[must_use]
    pub fn in_key(mut self, key: &str) -> Self {
        self.steps.push(bare_or_quoted(key));
        self
    }

    /// Returns the mismatch as one within an element of an array.
    #[must_use]
    pub fn in_element(mut self, index: usize) -> Self {
        self.steps.push(format!("[{index}]"));
        self
    }

    /// Returns the path of the value.
    pub fn path(&self) -> String {
        let mut path = String::new();
        for step in self.steps.iter().rev() {
            if !path.is_empty() && !step.starts_with('[') {
                path.push('.');
            }
            path.push_str(step);
        }
        path
    }

    /// Returns the missing key, if that is the mismatch.
    pub fn missing(&self) -> Option<&'static str> {
        self.missing
    }

    /// Returns true if names are wrong, and not a value.
    pub fn is_of_names(&self) -> bool {
        self.of_names
    }

    /// Returns the name that was probably meant.
    pub fn meant(&self) -> Option<&'static str> {
        self.meant
    }

    /// Returns the wrong key within the value, if the key and not the value is wrong.
    pub fn key(&self) -> Option<&str> {
        self.key.as_deref()
    }
}

impl fmt::Display for Mismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.why)
    }
}

impl std::error::Error for Mismatch {}

impl Error for Mismatch {
    fn custom<T: fmt::Display>(message: T) -> Self {
        Self::because(message.to_string())
    }

    fn invalid_type(found: Unexpected, expected: &dyn Expected) -> Self {
        let found = match found {
            Unexpected::UnitVariant | Unexpected::NewtypeVariant | Unexpected::StructVariant => {
                return Self::only_a_name();
            }
            Unexpected::Map => "a table".to_owned(),
            Unexpected::Seq => "an array".to_owned(),
            found => shortened(&found.to_string().replacen("floating point", "number", 1)),
        };
        Self::because(format!("found {found}, expected {}", wanted(expected)))
    }

    fn invalid_value(found: Unexpected, expected: &dyn Expected) -> Self {
        Self::invalid_type(found, expected)
    }

    fn invalid_length(length: usize, expected: &dyn Expected) -> Self {
        Self::because(format!("found an array of length {length}, expected {}", wanted(expected)))
    }

    fn unknown_variant(name: &str, known: &'static [&'static str]) -> Self {
        Self::unknown(
            &format!("`{}` is not known here", shortened(name)),
            name,
            known,
            "there are no kinds here",
        )
    }

    fn unknown_field(name: &str, known: &'static [&'static str]) -> Self {
        Self::unknown(&format!("unknown key `{}`", shortened(name)), name, known, "there are no keys here")
    }

    fn missing_field(name: &'static str) -> Self {
        Self { missing: Some(name), ..Self::because(format!("missing key `{name}`")) }
    }

    fn duplicate_field(name: &'static str) -> Self {
        Self::because(format!("`{name}` is given twice"))
    }
}

/// Returns the part of a message that lists the accepted names.
fn accepted_names(known: &[&str], none: &str) -> String {
    match known {
        [] => none.to_owned(),
        [one] => format!("expected `{one}`"),
        [one, other] => format!("expected `{one}` or `{other}`"),
        _ => format!(
            "expected one of {}",
            known.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
        ),
    }
}

/// Translates serde's description of an expected type.
fn wanted(expected: &dyn Expected) -> String {
    let wanted = expected.to_string();
    let known = match wanted.as_str() {
        "f64" => "a number",
        "u32" => "a whole number from 0 to 4294967295",
        "a nonzero u32" => "a whole number from 1 to 4294967295",
        "u64" | "usize" => "a whole number from 0 to 9223372036854775807",
        "a sequence" => "an array",
        "a map" => "a table",
        "a boolean" => "true or false",
        _ if wanted.starts_with("struct ") => "a table",
        _ => return wanted,
    };
    known.to_owned()
}
