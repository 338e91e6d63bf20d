//! Estimators: they turn what was commanded and measured into beliefs.

mod envelope;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use envelope::{Envelope, Form, Observer};

/// The kinds of estimator.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Estimator {
    /// The envelope of the elastic modes and its window means.
    Envelope(Envelope),
}
