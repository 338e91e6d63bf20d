//! Errors in an engineer's words, pointed at the very value.

use std::ops::Range;

use toml::de::DeTable;

use super::key::{path_of, span_of, span_of_key};
use super::{ScenarioError, Wrong, deep};

/// Errors show no more of a line than this before and after the place that they are about (characters).
const SHOWN: usize = 80;

/// The parser's error, pointed at the place that it is about.
pub fn unparsed(origin: &str, text: &str, error: &toml::de::Error) -> ScenarioError {
    if let Some(span) = deep::place(text, error) {
        return ScenarioError::Invalid(point(origin, text, span.clone(), &deep::why(text, &span)));
    }
    let message = explained(error.message());
    let Some(span) = error.span() else { return ScenarioError::Invalid(format!("{origin}: {message}")) };
    let table = DeTable::parse(text).ok();
    let key = table.and_then(|table| path_of(table.get_ref(), &span));
    let message = key.map_or_else(|| message.clone(), |key| format!("`{}`: {message}", shortened(&key)));
    ScenarioError::Invalid(point(origin, text, span, &message))
}

/// What does not fit, pointed at its key or value where the text has it.
pub fn unfit(origin: &str, text: &str, wrong: &Wrong) -> String {
    let path = wrong.path();
    let table = DeTable::parse(text).ok();
    let span = table.and_then(|table| match wrong.key() {
        Some(key) => span_of_key(table.get_ref(), &path, key),
        // What is missing from the whole document has no place.
        None if path.is_empty() => Some(0..0),
        None => span_of(table.get_ref(), &path),
    });
    let from = span.as_ref().map_or("", |span| &text[span.start..]);
    let message = bracketed(&path, from, &wrong.to_string()).unwrap_or_else(|| told(wrong));
    match span {
        Some(span) => point(origin, text, span, &message),
        None => format!("{origin}: {message}"),
    }
}

/// What does not fit, with the path of the part that it is about.
pub fn told(wrong: &Wrong) -> String {
    match wrong.path() {
        path if path.is_empty() => wrong.to_string(),
        // A path without quotes is read as tables within tables.
        path if path.starts_with("uncertain.") && !path.contains('"') => {
            format!("`{path}`: {wrong}; the path of an uncertain key stands in quotes")
        }
        path => format!("`{}`: {wrong}", shortened(&path)),
    }
}

/// The parser's words, where they would puzzle, in words of a scenario.
fn explained(message: &str) -> String {
    let message = message.trim_end();
    if let Some(found) = message.strip_suffix(" as i128, expected any valid TOML value") {
        let found = found.trim_start_matches("invalid type: ");
        return format!("found {found}, which is too large; a number so large is written with a point");
    }
    let known = match message {
        _ if deep::is_limit(message) => deep::WHY,
        "string values must be quoted, expected literal string" => {
            "found no TOML value; a text stands in quotes"
        }
        "invalid float, expected nothing" => "found no valid TOML number",
        "u64 value was too large" => {
            "found a number that is too large, expected a whole number from 0 to 9223372036854775807"
        }
        "integer number overflowed" => "found no whole number that fits 64 bits",
        "floating-point number overflowed" => "found a number that is too large for a double",
        _ => message,
    };
    known.to_owned()
}

/// Says which brackets a header needs, if it has the wrong ones.
fn bracketed(key: &str, place: &str, why: &str) -> Option<String> {
    match why {
        "found an array, expected a table" if place.starts_with("[[") => {
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
