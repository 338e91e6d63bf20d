//! Pointing budget: levels of an error that is the sum of a bias, sines and a random part, by convolution of their
//! distributions, and by the rule of k sigma.
//!
//! A bias is constant in a run and may differ from run to run, sines have a random phase in time, and random parts are
//! Gaussian. The three interpretations of a level (ECSS-E-ST-60-10C) differ in what is taken at its worst: the
//! bias (temporal), the sines (ensemble), or nothing (mixed).

mod campaign_budget;
mod convolution;
mod linear_noise;
mod linear_sources;
mod report;
mod run_sources;

use flexsc_scenario::Interpretation;

pub use campaign_budget::{BudgetLevel, CampaignBudget, INTERPRETATIONS};
pub use convolution::Mixture;
use convolution::Sum;
pub use linear_noise::{linear_noise, noise_cycle};
pub use linear_sources::{DisturbedLoop, linear_sources, sine_frequencies};
pub use report::{IndexBudget, LevelsAtProbability, LinearLevel, PointingBudget, SourceNumbers};
pub use run_sources::IndexRun;

/// Levels at which a budget is stated: those of one, two and three standard deviations of a Gaussian number.
pub const LEVELS: [f64; 3] = [0.683, 0.955, 0.997];

/// Sources of an error about one axis: the combinations in which they occur, over the ensemble of runs and over the places of
/// an index in its window.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ErrorSources {
    /// Combinations, whose weights add up to 1.
    pub combinations: Vec<SourceCombination>,
}

/// Sources that act together.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SourceCombination {
    /// Probability of the combination.
    pub weight: f64,
    /// Bias, with its sign.
    pub bias: f64,
    /// Amplitudes of the sines.
    pub amplitudes: Vec<f64>,
    /// Standard deviation of the random part.
    pub noise: f64,
}

impl ErrorSources {
    /// Creates the sources from combinations, whose weights are relative.
    pub fn new(mut combinations: Vec<SourceCombination>) -> Self {
        let total: f64 = combinations.iter().map(|own| own.weight).sum();
        for own in &mut combinations {
            own.weight /= total;
        }
        Self { combinations }
    }

    fn mean(&self, value: impl Fn(&SourceCombination) -> f64) -> f64 {
        self.combinations.iter().map(|own| own.weight * value(own)).sum()
    }

    /// Returns the mean of the bias over the ensemble.
    pub fn bias(&self) -> f64 {
        self.mean(|own| own.bias)
    }

    /// Returns the standard deviation of the bias over the ensemble.
    pub fn bias_spread(&self) -> f64 {
        let mean = self.bias();
        f64::sqrt(self.mean(|own| (own.bias - mean) * (own.bias - mean)))
    }

    /// Returns the largest magnitude of the bias in the ensemble.
    pub fn largest_bias(&self) -> f64 {
        self.combinations.iter().map(|own| own.bias.abs()).fold(0.0, f64::max)
    }

    /// Returns the root mean square amplitude of each sine.
    pub fn amplitudes(&self) -> Vec<f64> {
        let count = self.combinations.iter().map(|own| own.amplitudes.len()).max().unwrap_or(0);
        let square = |own: &SourceCombination, sine: usize| {
            own.amplitudes.get(sine).map_or(0.0, |amplitude| amplitude * amplitude)
        };
        (0..count).map(|sine| f64::sqrt(self.mean(|own| square(own, sine)))).collect()
    }

    /// Returns the root mean square of the random part.
    pub fn noise(&self) -> f64 {
        f64::sqrt(self.mean(|own| own.noise * own.noise))
    }

    /// Returns the distribution of the error, by convolution.
    pub fn distribution(&self, interpretation: Interpretation) -> Mixture {
        let (largest, side) = (self.largest_bias(), if self.bias() < 0.0 { -1.0 } else { 1.0 });
        let sum = |own: &SourceCombination| {
            let crests = own.amplitudes.iter().sum::<f64>();
            let (offset, sines) = match interpretation {
                Interpretation::Mixed => (own.bias, own.amplitudes.clone()),
                Interpretation::Temporal => (largest, own.amplitudes.clone()),
                Interpretation::Ensemble => (own.bias + side * crests, Vec::new()),
            };
            Sum { weight: own.weight, offset, sines, noise: own.noise }
        };
        Mixture::new(self.combinations.iter().map(sum))
    }

    /// Returns the mixed levels of the error's magnitude at [`LEVELS`], by convolution.
    pub fn mixed_levels(&self) -> [f64; 3] {
        let distribution = self.distribution(Interpretation::Mixed);
        LEVELS.map(|level| distribution.level(level))
    }

    /// Returns the level of the error's magnitude by the rule of k sigma: the parts that are taken at their worst, and k
    /// times the root sum of the other variances. k is 1, 2 or 3 for the [`LEVELS`], else the Gaussian quantile of
    /// the probability.
    pub fn rule(&self, probability: f64, interpretation: Interpretation) -> f64 {
        let (bias, spread, noise) = (self.bias().abs(), self.bias_spread(), self.noise());
        let amplitudes = self.amplitudes();
        let waves = amplitudes.iter().map(|amplitude| 0.5 * amplitude * amplitude).sum::<f64>();
        let (worst, variance) = match interpretation {
            Interpretation::Mixed => (bias, spread * spread + waves),
            Interpretation::Temporal => (self.largest_bias(), waves),
            Interpretation::Ensemble => (bias + amplitudes.iter().sum::<f64>(), spread * spread),
        };
        worst + sigmas(probability) * f64::sqrt(variance + noise * noise)
    }
}

/// Returns the number of standard deviations of the rule at a probability.
pub fn sigmas(probability: f64) -> f64 {
    let place = LEVELS.iter().position(|level| (level - probability).abs() < 1e-12);
    place.map_or_else(|| gaussian(probability), |place| (place + 1) as f64)
}

/// Returns the level of the magnitude of a standard normal number.
fn gaussian(probability: f64) -> f64 {
    bisect(probability, 40.0, |x| libm::erf(x / std::f64::consts::SQRT_2))
}

/// Returns the least argument up to `most` at which a function that rises reaches a value.
fn bisect(value: f64, most: f64, function: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (0.0, most);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if middle == low || middle == high {
            break;
        }
        if function(middle) < value {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

#[cfg(test)]
mod tests;
