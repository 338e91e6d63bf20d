//! Condition of a mode's end as written in a scenario, such as `rate < 2e-3 and silent(star_tracker) <= 5 s`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::condition::{ConditionFault, Expression, Vocabulary};
use super::parser;

/// Condition as written in a scenario.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct ModeCondition(String);

impl ModeCondition {
    /// Creates a condition from its text.
    pub fn new(text: impl Into<String>) -> Self {
        Self(text.into())
    }

    /// Returns the text.
    pub fn text(&self) -> &str {
        &self.0
    }

    /// Reads the condition.
    ///
    /// # Errors
    /// The first part that is no condition, and the reason.
    pub fn parse(&self, known: &Vocabulary<'_>) -> Result<Expression, ConditionFault> {
        parser::parse(&self.0, known)
    }
}
