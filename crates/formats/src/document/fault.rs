//! Error in a part of a scenario: the key, and the reason.

use std::fmt;
use std::ops::Range;

/// Key with an invalid value, and the reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ConfigError {
    /// Key relative to the part that reports the error; empty for the part itself.
    pub key: String,
    /// Reason, as a text that follows the key.
    pub why: String,
    /// Bytes of the part of a text that is invalid, if the value is a text with parts.
    pub part: Option<Range<usize>>,
}

impl ConfigError {
    /// Creates a fault at a key.
    pub fn new(key: impl Into<String>, why: impl Into<String>) -> Self {
        Self { key: key.into(), why: why.into(), part: None }
    }

    /// Returns the fault relative to the enclosing table, in which `prefix` is the key of the part.
    #[must_use]
    pub fn within(self, prefix: &str) -> Self {
        let key = match self.key.as_str() {
            "" => prefix.to_owned(),
            index if index.starts_with('[') => format!("{prefix}{index}"),
            key => format!("{prefix}.{key}"),
        };
        Self { key, ..self }
    }

    /// Returns the bytes in `text` of the invalid part of a value that stands at `value`. A text with escapes counts as a
    /// whole.
    pub(super) fn span_in(&self, text: &str, value: Range<usize>) -> Range<usize> {
        let Some(part) = &self.part else { return value };
        let Some(written) = text.get(value.clone()) else { return value };
        let quotes = ["\"\"\"", "'''", "\"", "'"].into_iter().find(|quotes| written.starts_with(quotes));
        let Some(quotes) = quotes.filter(|quotes| !(quotes.starts_with('"') && written.contains('\\')))
        else {
            return value;
        };
        let within = value.start + quotes.len();
        within + part.start..within + part.end
    }
}

impl fmt::Display for ConfigError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}` {}", self.key, self.why)
    }
}

impl std::error::Error for ConfigError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_joined_as_toml_joins_them() {
        let within = |key: &str| ConfigError::new(key, "must be given").within("law.pd").key;
        assert_eq!(within(""), "law.pd");
        assert_eq!(within("gain"), "law.pd.gain");
        assert_eq!(within("[2].gain"), "law.pd[2].gain");
        assert_eq!(ConfigError::new("gain", "must be given").to_string(), "`gain` must be given");
    }
}
