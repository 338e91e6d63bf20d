//! One error in a document: its place and the message.

use std::fmt;
use std::ops::Range;

/// Number of characters of a line that messages show before and after the erroneous place.
pub const SHOWN: usize = 80;

/// Error in a document. It is printed as `file:line:column: message`, with the line below and carets under the place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Name of the document's source, such as its path.
    pub origin: String,
    /// Place in the text, if there is one.
    pub place: Option<TextPlace>,
    /// Path of the erroneous key, such as `law.relay.k_t`; `None` for the document as a whole.
    pub key: Option<String>,
    /// Error message.
    pub message: String,
    /// Key or word that was probably meant.
    pub suggestion: Option<&'static str>,
}

/// Place in a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextPlace {
    /// Line number, from 1.
    pub line: usize,
    /// Character in the line, from 1.
    pub column: usize,
    /// Quoted line, with carets under the place.
    quoted: String,
}

impl Diagnostic {
    /// Creates an error without a key and a place.
    pub fn new(origin: &str, message: impl Into<String>) -> Self {
        Self { origin: origin.to_owned(), place: None, key: None, message: message.into(), suggestion: None }
    }

    /// Sets the key of the error.
    #[must_use]
    pub fn about(self, key: impl Into<String>) -> Self {
        Self { key: Some(key.into()), ..self }
    }

    /// Sets the place of the error in a text.
    #[must_use]
    pub fn at(self, text: &str, span: &Range<usize>) -> Self {
        Self { place: Some(TextPlace::from_span(text, span)), ..self }
    }
}

impl TextPlace {
    fn from_span(text: &str, span: &Range<usize>) -> Self {
        let start = span.start.min(text.len());
        let before = &text[..start];
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let line_number = before.matches('\n').count() + 1;
        let column = text[line_start..start].chars().count();
        let line = text[line_start..].lines().next().unwrap_or_default();
        let marked = text[start..span.end.min(text.len()).max(start)].lines().next().unwrap_or_default();
        // A line may be as long as the file, and contain control characters.
        let hidden = column.saturating_sub(SHOWN);
        let printable = |c: char| if c.is_control() { ' ' } else { c };
        let line: String = line.chars().skip(hidden).take(2 * SHOWN).map(printable).collect();
        let width = marked.chars().count().clamp(1, SHOWN);
        let (number, gutter) = (line_number.to_string(), " ".repeat(line_number.to_string().len()));
        let (indent, carets) = (" ".repeat(column - hidden), "^".repeat(width));
        let quoted = format!("{gutter} |\n{number} | {line}\n{gutter} | {indent}{carets}");
        Self { line: line_number, column: column + 1, quoted }
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { origin, place, message, .. } = self;
        match place {
            Some(TextPlace { line, column, quoted }) => {
                write!(f, "{origin}:{line}:{column}: {message}\n{quoted}")
            }
            None => write!(f, "{origin}: {message}"),
        }
    }
}

/// Shortens a text to the length that fits a message.
pub fn shortened(text: &str) -> String {
    match text.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}
