//! Errors of a hand-over.

use std::path::Path;

use flexsc_core::ScenarioError;
use flexsc_core::record::LogError;
use thiserror::Error;

/// Error of a hand-over.
#[derive(Debug, Error)]
pub enum HandoverError {
    /// Log that cannot be read.
    #[error(transparent)]
    Log(#[from] LogError),
    /// Scenario of the log that this version does not accept.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// Run that lacks what the format needs, or an option that contradicts it.
    #[error("{0}")]
    Refused(String),
}

impl HandoverError {
    /// Creates a refusal with its reason and a hint.
    pub(crate) fn refused(why: &str, hint: &str) -> Self {
        Self::Refused(format!("{why}\n\nhint: {hint}"))
    }

    /// Returns the error with the log's path before the reason of a refusal.
    pub(crate) fn in_log(self, path: &Path) -> Self {
        match self {
            Self::Refused(why) => Self::Refused(format!("{}: {why}", path.display())),
            other => other,
        }
    }
}
