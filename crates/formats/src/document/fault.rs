//! What is wrong with a part of a scenario: the key, and why.

use std::fmt;

/// A key that cannot be used as it is given.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// The key, below that of the part that found it; empty for the part itself.
    pub key: String,
    /// Why, to be read after the key.
    pub why: String,
}

impl Fault {
    /// A fault at a key.
    pub fn new(key: impl Into<String>, why: impl Into<String>) -> Self {
        Self { key: key.into(), why: why.into() }
    }

    /// The fault as the table with this key sees it.
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

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}` {}", self.key, self.why)
    }
}

impl std::error::Error for Fault {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_joined_as_toml_joins_them() {
        let within = |key: &str| Fault::new(key, "must be given").within("law.pd").key;
        assert_eq!(within(""), "law.pd");
        assert_eq!(within("gain"), "law.pd.gain");
        assert_eq!(within("[2].gain"), "law.pd[2].gain");
        assert_eq!(Fault::new("gain", "must be given").to_string(), "`gain` must be given");
    }
}
