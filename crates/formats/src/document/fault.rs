//! Error in a part of a scenario: the key, and the reason.

use std::fmt;

/// Key with an invalid value, and the reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ConfigError {
    /// Key relative to the part that reports the error; empty for the part itself.
    pub key: String,
    /// Reason, as a text that follows the key.
    pub why: String,
}

impl ConfigError {
    /// Creates a fault at a key.
    pub fn new(key: impl Into<String>, why: impl Into<String>) -> Self {
        Self { key: key.into(), why: why.into() }
    }

    /// Returns the fault relative to the enclosing table, in which `prefix` is the key of the part.
    #[must_use]
    pub fn within(self, prefix: &str) -> Self {
        let key = match self.key.as_str() {
            "" => prefix.to_owned(),
            index if index.starts_with('[') => format!("{prefix}{index}"),
            key => format!("{prefix}.{key}"),
        };
        Self { key, why: self.why }
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
