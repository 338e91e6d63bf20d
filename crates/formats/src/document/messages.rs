//! Error messages in an engineer's words, with their place in the text.

use toml::de::DeTable;

use super::key::{bare_or_quoted, path_of, span_of, span_of_key};
use super::mistake::{Diagnostic, shortened};
use super::{Mismatch, nesting};

/// Returns the error of the parser, with its key and place.
pub fn parse_error(origin: &str, text: &str, error: &toml::de::Error) -> Diagnostic {
    if let Some(span) = nesting::place(text, error) {
        return Diagnostic::new(origin, nesting::why(text, &span)).at(text, &span);
    }
    let message = explained(error.message());
    let Some(span) = error.span() else { return Diagnostic::new(origin, message) };
    let message = foreign_syntax(text, span.start).unwrap_or(message);
    let table = DeTable::parse(text).ok();
    match table.and_then(|table| path_of(table.get_ref(), &span)) {
        None => Diagnostic::new(origin, message).at(text, &span),
        Some(key) => {
            Diagnostic::new(origin, format!("`{}`: {message}", shortened(&key))).about(key).at(text, &span)
        }
    }
}

/// Returns the error of a mismatch, with the place of its key or value in the text.
pub fn mismatch(origin: &str, text: &str, wrong: &Mismatch) -> Diagnostic {
    let path = wrong.path();
    let table = DeTable::parse(text).ok();
    let span = table.and_then(|table| match wrong.key() {
        Some(key) => span_of_key(table.get_ref(), &path, key),
        // A key missing from the whole document has no place.
        None if path.is_empty() => Some(0..0),
        None => span_of(table.get_ref(), &path),
    });
    let from = span.as_ref().map_or("", |span| &text[span.start..]);
    let message = bracketed(&path, from, &wrong.to_string()).unwrap_or_else(|| mismatch_at(wrong));
    let mistake = diagnostic(origin, wrong, message);
    match span {
        Some(span) => mistake.at(text, &span),
        None => mistake,
    }
}

/// Returns the error of a mismatch, with its key and suggestion.
pub fn diagnostic(origin: &str, wrong: &Mismatch, message: String) -> Diagnostic {
    let mistake = Diagnostic { suggestion: wrong.meant(), ..Diagnostic::new(origin, message) };
    match (wrong.path(), wrong.key().or(wrong.missing()).map(bare_or_quoted)) {
        (path, None) if path.is_empty() => mistake,
        (path, None) => mistake.about(path),
        (path, Some(key)) if path.is_empty() => mistake.about(key),
        (path, Some(key)) => mistake.about(format!("{path}.{key}")),
    }
}

/// Returns the message of a mismatch, with the path of its part.
pub fn mismatch_at(wrong: &Mismatch) -> String {
    match wrong.path() {
        path if path.is_empty() => wrong.to_string(),
        // A path without quotes is parsed as nested tables.
        path if path.starts_with("uncertain.") && !path.contains('"') => {
            format!("`{path}`: {wrong}; the path of an uncertain key must be in quotes")
        }
        path if path.starts_with("uncertain.") => {
            format!("`{}`: {wrong}{DISTRIBUTIONS}", shortened(&path))
        }
        path => format!("`{}`: {wrong}", shortened(&path)),
    }
}

/// How a distribution is written.
const DISTRIBUTIONS: &str = "; a distribution is a table such as `{ normal = { mean = 0.25, sd = 0.01 } }`, \
                             `{ relative_normal = 0.1 }` or `{ uniform = [0.2, 0.3] }`";

/// Returns a message about syntax of another language at a place that the parser does not understand.
fn foreign_syntax(text: &str, place: usize) -> Option<String> {
    let (before, after) = text.split_at_checked(place)?;
    let line = before.rsplit('\n').next().unwrap_or(before);
    let rest = after.lines().next().unwrap_or_default();
    let comment = ["//", "%", "--", "/*"].into_iter().find(|begin| rest.trim_start().starts_with(begin));
    if rest.contains(" //") {
        return Some("found `//`; a comment begins with `#`".to_owned());
    }
    if let Some(begin) = comment.filter(|_| !line.trim_end().ends_with('=')) {
        return Some(format!("found `{begin}`; a comment begins with `#`"));
    }
    // A value behind a value, within brackets.
    let value = |c: char| c.is_ascii_alphanumeric() || "\"'.]}".contains(c);
    let next = |c: char| c.is_ascii_alphanumeric() || "\"'+-.[{".contains(c);
    let open = before.matches('[').count() > before.matches(']').count()
        || before.matches('{').count() > before.matches('}').count();
    (open && line.trim_end().ends_with(value) && !line.contains('#') && rest.trim_start().starts_with(next))
        .then(|| "found a value right behind another; a comma is missing between them".to_owned())
}

/// Translates messages of the parser that would puzzle a user.
fn explained(message: &str) -> String {
    let message = message.trim_end();
    if let Some(found) = message.strip_suffix(" as i128, expected any valid TOML value") {
        let found = found.trim_start_matches("invalid type: ");
        return format!("found {found}, which is too large; write a number this large with a decimal point");
    }
    let known = match message {
        _ if nesting::is_limit(message) => nesting::WHY,
        "string values must be quoted, expected literal string" => {
            "found no TOML value; a text must be in quotes"
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

/// Returns a message about the brackets of a header, if it has the wrong ones.
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
