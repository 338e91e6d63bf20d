//! Worst case over the uncertain keys: the value of a metric, a requirement, a stability margin or the lines of wheels at the worst point of
//! their box that a search finds.
//!
//! Half of the points are spread over the box, with its corners where they are few; pattern searches from the worst of
//! them use the other half. What is found is a lower bound on how bad it can be: a witness, not a proof. All runs have
//! the noise of one run, so that points differ by their keys alone.

mod box_search;
mod contrast_search;
mod line_search;
mod loop_search;
mod margin_search;
mod metric_search;

use std::collections::BTreeMap;
use std::fmt;

use flexsc_formats::document::{ConfigError, ScenarioError};
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Map, Value as Json, json};

pub use box_search::{Assessed, SearchPoint};
pub use contrast_search::ContrastSearch;
use flexsc_scenario::Scenario;
use flexsc_scenario::uncertain::{UncertainBox, UncertainKey};
pub use line_search::LineSearch;
pub use margin_search::{MarginKind, MarginSearch};
pub use metric_search::{MetricSearch, RunQuantity};

/// Worst point that a search found.
#[derive(Clone, Debug)]
pub struct WorstCase {
    /// Name of the quantity.
    pub quantity: String,
    /// Unit of its values.
    pub unit: String,
    /// True if small values are bad.
    pub is_least: bool,
    /// Box of the uncertain keys.
    pub ranges: UncertainBox,
    /// Points that were assessed, the first at the values of the scenario itself, or as near to them as the box is.
    pub points: Vec<SearchPoint>,
    /// Index of the worst point.
    pub worst: usize,
    /// True if the quantity is a margin, and the loop is not stable at the worst point.
    pub is_unstable: bool,
    /// Number of points without a value.
    pub failed: usize,
    /// Reason of the first point whose run or loop failed.
    pub first_failure: Option<String>,
    /// Scenario with the keys of the worst point, and without uncertain ones.
    pub witness: Scenario,
}

/// Worst point of the ranges of the uncertain keys that a search found.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct WorstCaseReport {
    /// Name of the metric, the requirement or the margin.
    pub quantity: String,
    /// Unit of the values.
    pub unit: String,
    /// True if small values are bad.
    pub least: bool,
    /// Value with the keys of the scenario itself, or as near to them as their ranges are.
    pub nominal: f64,
    /// Value at the worst point.
    #[schemars(extend("x-name" = "value"))]
    pub worst: f64,
    /// Value of each uncertain key at the worst point.
    #[schemars(with = "BTreeMap<String, f64>")]
    pub keys: Map<String, Json>,
    /// True if the quantity is a margin and the loop is not stable at the worst point.
    pub unstable: bool,
    /// Number of points that were assessed.
    #[schemars(extend("x-name" = "point_count"))]
    pub points: usize,
    /// Number of points without a value.
    pub without_value: usize,
}

/// Reason for which there is no worst case.
#[derive(Debug)]
pub enum WorstCaseFault {
    /// Key of the scenario.
    Key(ConfigError),
    /// Scenario of a point.
    Scenario(ScenarioError),
    /// Quantity that is not there, or has no value.
    Request(String),
    /// The search was stopped.
    Interrupted,
}

impl fmt::Display for WorstCaseFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Key(fault) => write!(f, "`{}`: {}", fault.key, fault.why),
            Self::Scenario(error) => error.fmt(f),
            Self::Request(why) => f.write_str(why),
            Self::Interrupted => f.write_str("interrupted"),
        }
    }
}

impl std::error::Error for WorstCaseFault {}

impl WorstCase {
    /// Returns the value at the worst point; NaN for a requirement that has none there.
    pub fn value(&self) -> f64 {
        self.points[self.worst].assessed.value
    }

    /// Returns the value with the keys of the scenario itself, or as near to them as the box is.
    pub fn nominal(&self) -> f64 {
        self.points[0].assessed.value
    }

    /// Returns the values of the uncertain keys at a point.
    pub fn key_values(&self, point: usize) -> Vec<f64> {
        let parts = self.points[point].parts.iter();
        self.ranges.keys.iter().zip(parts).map(|(own, part)| own.number_at(*part)).collect()
    }

    /// Returns the value at the worst point with its keys.
    pub fn report(&self) -> WorstCaseReport {
        let keys = self.ranges.keys.iter().zip(self.key_values(self.worst));
        WorstCaseReport {
            quantity: self.quantity.clone(),
            unit: self.unit.clone(),
            least: self.is_least,
            nominal: self.nominal(),
            worst: self.value(),
            keys: keys.map(|(own, value)| (own.key.clone(), json!(value))).collect(),
            unstable: self.is_unstable,
            points: self.points.len(),
            without_value: self.failed,
        }
    }
}

/// Returns the box of a scenario that has uncertain keys.
///
/// # Errors
/// A scenario without uncertain keys.
pub fn uncertain_box(scenario: &Scenario) -> Result<UncertainBox, ConfigError> {
    let ranges = UncertainBox::new(&scenario.uncertain, &scenario.self_contained().to_table());
    if ranges.keys.is_empty() {
        let why = "is missing: the worst case is searched for over the ranges of its keys";
        return Err(ConfigError::new("uncertain", why));
    }
    Ok(ranges)
}
