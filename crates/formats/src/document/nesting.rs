//! Errors about tables and arrays that are nested too deep: the line, and the key.

use std::ops::Range;

use toml::Table;

use super::mistake::shortened;

/// Largest number of levels in the path of a key; the parser has a limit of its own, of 80.
pub const DEEPEST: usize = 60;

/// Message for a key that is nested too deep.
pub const WHY: &str = "is nested too deep: a scenario has a few levels of tables and arrays";

/// Returns true if the parser's message is about its nesting limit.
pub fn is_limit(message: &str) -> bool {
    message.contains("recursion limit") || message.contains("max recursion depth")
}

/// Returns the span of the line that is nested too deep, if the error is about nesting.
pub fn place(text: &str, error: &toml::de::Error) -> Option<Range<usize>> {
    if !is_limit(error.message()) {
        return None;
    }
    let position = error.span().map_or_else(|| first_deep(text), |span| span.start.min(text.len()));
    let start = text[..position].rfind('\n').map_or(0, |newline| newline + 1);
    let line = text[start..].lines().next().unwrap_or_default();
    let blank = line.len() - line.trim_start().len();
    let key = line.find('=').unwrap_or(line.len());
    Some(start + blank..start + line[..key].trim_end().len().max(blank))
}

/// Returns the message about nesting, with the key of the line at `place`.
pub fn why(text: &str, place: &Range<usize>) -> String {
    let line = &text[place.clone()];
    let header = |line: &str| line.trim().trim_matches(['[', ']']).trim().to_owned();
    if line.starts_with('[') {
        return format!("`{}` {WHY}", shortened(&header(line)));
    }
    let mut above = text[..place.start].lines().rev().map(str::trim);
    let table = above.find(|line| line.starts_with('[') && line.ends_with(']')).map(header);
    let key = table.map_or_else(|| line.to_owned(), |table| format!("{table}.{line}"));
    format!("`{}` {WHY}", shortened(&key))
}

/// Returns the start of the first line with which the text is nested too deep, because the parser does not report it.
fn first_deep(text: &str) -> usize {
    let ends: Vec<usize> = text
        .match_indices('\n')
        .map(|(position, _)| position + 1)
        .chain(std::iter::once(text.len()))
        .collect();
    let is_deep = |end: &usize| text[..*end].parse::<Table>().is_err_and(|error| is_limit(error.message()));
    let line = ends.partition_point(|end| !is_deep(end));
    line.checked_sub(1).and_then(|before| ends.get(before)).copied().unwrap_or(0).min(text.len())
}
