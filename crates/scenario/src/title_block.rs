//! Title block of the page that `flexsc report` writes.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Title block of the page that `flexsc report` writes. Every key is a plain text; one that is absent leaves no empty field.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TitleBlock {
    /// Title of the page; default: `about`, or the name of the scenario.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub title: String,
    /// Project.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub project: String,
    /// Author.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub author: String,
    /// Issue or revision.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub issue: String,
    /// Date of the issue.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub date: String,
}

impl TitleBlock {
    /// Returns true if no key is given.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}
