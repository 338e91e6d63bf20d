//! One thing in a document that is not accepted: where it stands, and why.

use std::fmt;
use std::ops::Range;

/// Errors show no more of a line than this before and after the place that they are about (characters).
pub const SHOWN: usize = 80;

/// Something in a document that is not accepted. It is shown as `file:line:column: message`, with the line below and a caret
/// under the place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mistake {
    /// Where the document comes from.
    pub origin: String,
    /// Its place in the text, if it has one.
    pub place: Option<TextPlace>,
    /// The path of the key that it is about, such as `law.relay.k_t`; none for the document as a whole.
    pub key: Option<String>,
    /// What is wrong.
    pub message: String,
    /// The key or the word that was probably meant.
    pub suggestion: Option<&'static str>,
}

/// A place in a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextPlace {
    /// The line, from 1.
    pub line: usize,
    /// The character in the line, from 1.
    pub column: usize,
    /// The line and carets under the place.
    quoted: String,
}

impl Mistake {
    /// A mistake of a document that is not about one of its keys, or of which no more is known.
    pub fn new(origin: &str, message: impl Into<String>) -> Self {
        Self { origin: origin.to_owned(), place: None, key: None, message: message.into(), suggestion: None }
    }

    /// The mistake about this key.
    #[must_use]
    pub fn about(self, key: impl Into<String>) -> Self {
        Self { key: Some(key.into()), ..self }
    }

    /// The mistake at this place of a text.
    #[must_use]
    pub fn at(self, text: &str, span: &Range<usize>) -> Self {
        Self { place: Some(TextPlace::of(text, span)), ..self }
    }
}

impl TextPlace {
    fn of(text: &str, span: &Range<usize>) -> Self {
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
        let quoted = format!("{gutter} |\n{number} | {line}\n{gutter} | {indent}{carets}");
        Self { line: line_number, column: column + 1, quoted }
    }
}

impl fmt::Display for Mistake {
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

/// A text that fits a message.
pub fn shortened(text: &str) -> String {
    match text.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}
