//! Adaptation loops: they improve a parameter of the law, and never call it.

mod random_search;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use random_search::{Decision, RandomSearch, Search, Step};

/// The kinds of adaptation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Adaptation {
    /// Random search with learning, by the window means of the envelope.
    RandomSearch(RandomSearch),
}
