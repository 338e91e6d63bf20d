//! Budgets of pointing indices in numbers.

use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value as Json;

use super::{BudgetLevel, CampaignBudget, ErrorSources, LEVELS};
use crate::noise::RequiredContrast;

/// Budgets of all pointing indices that a scenario limits, and the verdicts of its requirements.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct PointingBudget {
    /// Number of runs of the campaign.
    pub runs: u64,
    /// Budget of each pointing index, in the order of the requirements.
    #[schemars(extend("x-name" = "indices"))]
    pub budgets: Vec<IndexBudget>,
    /// Contrasts of images that requirements ask for, with what each source costs.
    #[schemars(extend("x-key" = "name"))]
    pub contrasts: Vec<RequiredContrast>,
    /// Verdict of each requirement: `name`, `verdict`, `value`, `limit` and the confidence of the campaign.
    pub requirements: Vec<Json>,
}

/// Budget of one pointing index.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct IndexBudget {
    /// Name of the requirement.
    pub name: String,
    /// Index, quantity and window of the requirement.
    pub description: String,
    /// Unit of the levels and of the limit.
    pub unit: &'static str,
    /// Limit of the requirement.
    pub limit: f64,
    /// Error sources that the runs show; none for an index without sources.
    pub sources: Option<SourceNumbers>,
    /// Rms of the index under the noise of the linear loop about its target at rest.
    pub linear_noise: Option<f64>,
    /// Error sources of the linear loop under its disturbances; none without such a loop.
    pub linear_sources: Option<SourceNumbers>,
    /// Mixed levels of these sources; none without such a loop.
    #[schemars(extend("x-key" = "level"))]
    pub linear_levels: Option<Vec<LinearLevel>>,
    /// Levels at each probability, by their interpretation.
    #[schemars(extend("x-key" = "level"))]
    pub levels: Vec<LevelsAtProbability>,
}

/// Error sources in the unit of their index.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[schemars(extend("x-dict" = true))]
pub struct SourceNumbers {
    /// Mean of the bias over the runs.
    pub bias: f64,
    /// Standard deviation of the bias from run to run.
    pub bias_spread: f64,
    /// Largest magnitude of the bias.
    pub largest_bias: f64,
    /// Rms amplitude of each sine.
    pub amplitudes: Vec<f64>,
    /// Rms of the random part.
    pub noise: f64,
}

/// Mixed level of the sources of a linear loop at a probability.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[schemars(extend("x-main" = "convolution"))]
pub struct LinearLevel {
    /// Probability.
    pub level: f64,
    /// Level of the sum of the error sources by convolution.
    pub convolution: f64,
}

/// Levels of an index at a probability.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[schemars(extend("x-dict" = true))]
pub struct LevelsAtProbability {
    /// Probability.
    pub level: f64,
    /// Levels with the bias at its worst.
    pub temporal: BudgetLevel,
    /// Levels with the sines at their worst.
    pub ensemble: BudgetLevel,
    /// Levels of all sources as they are.
    pub mixed: BudgetLevel,
}

impl From<&ErrorSources> for SourceNumbers {
    fn from(sources: &ErrorSources) -> Self {
        Self {
            bias: sources.bias(),
            bias_spread: sources.bias_spread(),
            largest_bias: sources.largest_bias(),
            amplitudes: sources.amplitudes(),
            noise: sources.noise(),
        }
    }
}

impl From<&CampaignBudget> for IndexBudget {
    fn from(budget: &CampaignBudget) -> Self {
        let at = |(level, [temporal, ensemble, mixed]): (&f64, &[BudgetLevel; 3])| LevelsAtProbability {
            level: *level,
            temporal: *temporal,
            ensemble: *ensemble,
            mixed: *mixed,
        };
        let linear = |(level, convolution): (f64, f64)| LinearLevel { level, convolution };
        Self {
            name: budget.requirement.name.clone(),
            description: budget.requirement.description(),
            unit: budget.requirement.unit,
            limit: budget.requirement.limit,
            sources: budget.sources.as_ref().map(SourceNumbers::from),
            linear_noise: budget.linear_noise,
            linear_sources: budget.linear_sources.as_ref().map(SourceNumbers::from),
            linear_levels: budget.linear_levels.map(|of| LEVELS.into_iter().zip(of).map(linear).collect()),
            levels: LEVELS.iter().zip(&budget.levels).map(at).collect(),
        }
    }
}
