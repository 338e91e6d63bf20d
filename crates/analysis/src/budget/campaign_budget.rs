//! Budget of a requirement from the runs of a campaign: order statistics of all values of its pointing index, and the levels of
//! the sources that the runs show.

use super::{ErrorSources, LEVELS};
use flexsc_numerics::order_statistics::order_statistic;
use flexsc_scenario::{AssessedRequirement, Interpretation};

/// Bias, relative to the random part, that is rounding.
const ROUNDING: f64 = 1e-9;

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
}

/// Level of the magnitude of an index at a probability, in three ways.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct BudgetLevel {
    /// Order statistic of the runs; NaN without values.
    pub campaign: f64,
    /// Convolution of the distributions of the sources.
    pub convolution: Option<f64>,
    /// Rule of k sigma.
    pub rule: Option<f64>,
}

impl CampaignBudget {
    /// Returns the budget from the values of the index in each run, with their sign if `is_signed`.
    pub fn new(requirement: AssessedRequirement, runs: &[Vec<f64>], is_signed: bool) -> Self {
        let sources = (is_signed && runs.iter().all(|run| !run.is_empty())).then(|| shown_sources(runs));
        let sorted = |values: &mut dyn Iterator<Item = f64>| {
            let mut values: Vec<f64> = values.map(f64::abs).collect();
            values.sort_by(f64::total_cmp);
            values
        };
        let each: Vec<Vec<f64>> = runs.iter().map(|run| sorted(&mut run.iter().copied())).collect();
        let most = sorted(&mut each.iter().filter_map(|run| run.last().copied()));
        let magnitudes = sorted(&mut runs.iter().flatten().copied());
        let campaign = |probability: f64, interpretation: Interpretation| match interpretation {
            Interpretation::Temporal => {
                each.iter().map(|run| order_statistic(run, probability)).fold(f64::NAN, f64::max)
            }
            Interpretation::Ensemble => order_statistic(&most, probability),
            Interpretation::Mixed => order_statistic(&magnitudes, probability),
        };
        let level = |probability: f64| {
            INTERPRETATIONS.map(|interpretation| BudgetLevel {
                campaign: campaign(probability, interpretation),
                convolution: sources.as_ref().map(|of| of.level(probability, interpretation)),
                rule: sources.as_ref().map(|of| of.rule(probability, interpretation)),
            })
        };
        let levels = LEVELS.into_iter().map(level).collect();
        Self { requirement, sources, levels, magnitudes, linear_noise: None, linear_sources: None }
    }
}

/// Returns the sources that runs show: a bias that is uniform over the ensemble with the root mean square of the runs' means, and
/// a random part with the variance within the runs.
fn shown_sources(runs: &[Vec<f64>]) -> ErrorSources {
    let (mut means, mut within) = (0.0, 0.0);
    for run in runs {
        let mean = run.iter().sum::<f64>() / run.len() as f64;
        means += mean * mean;
        within += run.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / run.len() as f64;
    }
    let count = runs.len() as f64;
    let (bias, noise) = (f64::sqrt(3.0 * means / count), f64::sqrt(within / count));
    // The mean of a uniform relative error is 0 but for rounding.
    let bias = if bias < ROUNDING * noise { 0.0 } else { bias };
    ErrorSources { biases: vec![bias], amplitudes: Vec::new(), noise }
}
