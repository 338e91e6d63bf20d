//! Budget of a requirement from the runs of a campaign: order statistics of all values of its pointing index, and the levels of
//! the sources that the runs show.

use super::run_sources::{IndexRun, ValueTimes, fit_sources};
use super::{ErrorSources, LEVELS};
use flexsc_numerics::order_statistics::order_statistic;
use flexsc_scenario::{AssessedRequirement, Interpretation, SampledError};
use schemars::JsonSchema;
use serde::Serialize;

/// Interpretations of a level, in the order in which they are reported.
pub const INTERPRETATIONS: [Interpretation; 3] =
    [Interpretation::Temporal, Interpretation::Ensemble, Interpretation::Mixed];

/// Budget of the pointing index of a requirement.
#[derive(Clone, Debug, PartialEq)]
pub struct CampaignBudget {
    /// Requirement.
    pub requirement: AssessedRequirement,
    /// Sources of an error about one axis that the runs show; `None` for the norm of several components.
    pub sources: Option<ErrorSources>,
    /// Levels at [`LEVELS`], for each of [`INTERPRETATIONS`].
    pub levels: Vec<[BudgetLevel; 3]>,
    /// Magnitudes of all values of all runs, sorted.
    pub magnitudes: Vec<f64>,
    /// Rms of the index under the noise of the linear loop; `None` without one.
    pub linear_noise: Option<f64>,
    /// Sources of an error about one axis by the linear loop; `None` without one.
    pub linear_sources: Option<ErrorSources>,
    /// Mixed levels of these at [`LEVELS`].
    pub linear_levels: Option<[f64; 3]>,
}

/// Level of the magnitude of an index at a probability, in three ways.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct BudgetLevel {
    /// Order statistic of the runs; NaN without values.
    pub campaign: f64,
    /// Level of the sum of the error sources by convolution.
    pub convolution: Option<f64>,
    /// Level by the rule of k sigma.
    pub rule: Option<f64>,
}

impl CampaignBudget {
    /// Returns the budget from the values of the index in each run, for the error that is sampled; `is_signed` if the values
    /// have their sign, and `cycle` is the number of values after which the noise repeats.
    pub fn new(
        requirement: AssessedRequirement,
        error: &SampledError,
        runs: &[IndexRun],
        is_signed: bool,
        cycle: usize,
    ) -> Self {
        let (period, window) = (error.period.seconds(), error.index.places() as usize);
        let times = ValueTimes { period, window, cycle };
        let is_complete = runs.iter().all(|run| !run.values.is_empty());
        let sources = (is_signed && is_complete).then(|| fit_sources(runs, times));
        let sorted = |values: &mut dyn Iterator<Item = f64>| {
            let mut values: Vec<f64> = values.map(f64::abs).collect();
            values.sort_by(f64::total_cmp);
            values
        };
        let each: Vec<Vec<f64>> = runs.iter().map(|run| sorted(&mut run.values.iter().copied())).collect();
        let most = sorted(&mut each.iter().filter_map(|run| run.last().copied()));
        let magnitudes = sorted(&mut runs.iter().flat_map(|run| &run.values).copied());
        let campaign = |probability: f64, interpretation: Interpretation| match interpretation {
            Interpretation::Temporal => {
                each.iter().map(|run| order_statistic(run, probability)).fold(f64::NAN, f64::max)
            }
            Interpretation::Ensemble => order_statistic(&most, probability),
            Interpretation::Mixed => order_statistic(&magnitudes, probability),
        };
        let convolved =
            INTERPRETATIONS.map(|interpretation| sources.as_ref().map(|of| of.distribution(interpretation)));
        let level = |probability: f64| {
            [0, 1, 2].map(|place| BudgetLevel {
                campaign: campaign(probability, INTERPRETATIONS[place]),
                convolution: convolved[place].as_ref().map(|of| of.level(probability)),
                rule: sources.as_ref().map(|of| of.rule(probability, INTERPRETATIONS[place])),
            })
        };
        let levels = LEVELS.into_iter().map(level).collect();
        Self {
            requirement,
            sources,
            levels,
            magnitudes,
            linear_noise: None,
            linear_sources: None,
            linear_levels: None,
        }
    }
}
