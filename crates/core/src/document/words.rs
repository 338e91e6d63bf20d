//! Errors in an engineer's words, pointed at the very value.

use std::ops::Range;

use toml::de::{DeTable, DeValue};

use super::key::place_of;
use super::{ScenarioError, deep};

/// Errors show no more of a line than this before and after the place that they are about (characters).
const SHOWN: usize = 80;

/// The parser's error, pointed at the place that it is about.
pub fn pointed(origin: &str, text: &str, error: &toml::de::Error) -> ScenarioError {
    if let Some(span) = deep::place(text, error) {
        return ScenarioError::Invalid(point(origin, text, span.clone(), &deep::why(text, &span)));
    }
    let (message, span) = told(text, error);
    ScenarioError::Invalid(match span {
        Some(span) => point(origin, text, span, &message),
        None => format!("{origin}: {message}"),
    })
}

/// The parser's error with the key that it is about, and the place.
pub fn told(text: &str, error: &toml::de::Error) -> (String, Option<Range<usize>>) {
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
pub fn explained(message: &str, found: Option<&str>) -> String {
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
    if deep::is_limit(message) {
        return deep::WHY.to_owned();
    }
    match message {
        "string values must be quoted, expected literal string" => {
            "found no TOML value; a text stands in quotes".to_owned()
        }
        "invalid float, expected nothing" => "found no valid TOML number".to_owned(),
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
        "u64" | "usize" => "a whole number from 0 to 9223372036854775807",
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
pub fn shortened(text: &str) -> String {
    match text.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

/// The message with the line that it is about and a caret under the place.
pub fn point(origin: &str, text: &str, span: Range<usize>, message: &str) -> String {
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
