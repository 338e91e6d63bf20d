//! Refusal of a construct outside the subset, with its place.

use std::fmt;

use proc_macro2::Span;

/// Refusal of a construct that is outside the translated subset of Rust.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TranslationError {
    /// Path of the file, as given to the translator.
    pub path: String,
    /// Line, from 1; 0 if the error has no place in a file.
    pub line: usize,
    /// Column, from 1; 0 if the error has no place in a file.
    pub column: usize,
    /// Construct that was found.
    pub found: String,
    /// Constructs that are accepted in its place.
    pub accepted: String,
}

impl fmt::Display for TranslationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.line > 0 {
            write!(f, "{}:{}:{}: ", self.path, self.line, self.column)?;
        }
        write!(f, "found {}; accepted: {}", self.found, self.accepted)
    }
}

impl std::error::Error for TranslationError {}

impl TranslationError {
    /// Makes a refusal of the words at a span, in a file that is named later.
    pub(super) fn at(span: Span, found: impl Into<String>, accepted: impl Into<String>) -> Self {
        let start = span.start();
        Self {
            path: String::new(),
            line: start.line,
            column: start.column + 1,
            found: found.into(),
            accepted: accepted.into(),
        }
    }

    /// Makes a refusal without a place.
    pub(super) fn without_place(found: impl Into<String>, accepted: impl Into<String>) -> Self {
        Self { path: String::new(), line: 0, column: 0, found: found.into(), accepted: accepted.into() }
    }

    /// Names the file, unless an inner step has named it.
    pub(super) fn in_file(mut self, path: &str) -> Self {
        if self.path.is_empty() {
            path.clone_into(&mut self.path);
        }
        self
    }
}

/// Outcome of a step of the translation.
pub(super) type Outcome<T> = Result<T, TranslationError>;

/// Refuses the words at a span.
pub(super) fn refuse<T>(span: Span, found: impl Into<String>, accepted: impl Into<String>) -> Outcome<T> {
    Err(TranslationError::at(span, found, accepted))
}
