//! Pointing budget: levels of an error that is the sum of constant, harmonic and random parts, by convolution of their
//! distributions, and by the rule of k sigma.
//!
//! Constant parts (biases) are uniform over the ensemble of runs, harmonic parts have a random phase in time, and random parts
//! are Gaussian. The three interpretations of a level (ECSS-E-ST-60-10C) differ in what is taken at its worst: the
//! biases (temporal), the harmonics (ensemble), or nothing (mixed).

mod campaign_budget;
mod convolution;
mod linear_noise;
mod linear_sources;

use flexsc_scenario::Interpretation;

pub use campaign_budget::{BudgetLevel, CampaignBudget, INTERPRETATIONS};
pub use convolution::Sum;
pub use linear_noise::linear_noise;
pub use linear_sources::linear_sources;

/// Levels at which a budget is stated: those of one, two and three standard deviations of a Gaussian number.
pub const LEVELS: [f64; 3] = [0.683, 0.955, 0.997];

/// Parts of an error about one axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ErrorSources {
    /// Largest values of the biases, each uniform between plus and minus this value over the ensemble.
    pub biases: Vec<f64>,
    /// Amplitudes of the harmonic parts.
    pub amplitudes: Vec<f64>,
    /// Standard deviation of the random part.
    pub noise: f64,
}

impl ErrorSources {
    /// Returns the level of the error's magnitude at a probability, by convolution.
    pub fn level(&self, probability: f64, interpretation: Interpretation) -> f64 {
        self.sum(interpretation).level(probability)
    }

    /// Returns the probability that the error's magnitude is at most `most`.
    pub fn probability(&self, most: f64, interpretation: Interpretation) -> f64 {
        self.sum(interpretation).probability(most)
    }

    /// Returns the level of the error's magnitude by the rule of k sigma: the parts that are taken at their worst, and k
    /// times the root sum of the other variances. k is 1, 2 or 3 for the [`LEVELS`], else the Gaussian quantile of
    /// the probability.
    pub fn rule(&self, probability: f64, interpretation: Interpretation) -> f64 {
        let sum = self.sum(interpretation);
        sum.offset + sigmas(probability) * sum.deviation()
    }

    fn sum(&self, interpretation: Interpretation) -> Sum {
        let total = |parts: &[f64]| parts.iter().sum::<f64>();
        let (biases, amplitudes) = (self.biases.clone(), self.amplitudes.clone());
        match interpretation {
            Interpretation::Mixed => {
                Sum { offset: 0.0, uniform: biases, sines: amplitudes, noise: self.noise }
            }
            Interpretation::Temporal => {
                Sum { offset: total(&biases), uniform: Vec::new(), sines: amplitudes, noise: self.noise }
            }
            Interpretation::Ensemble => {
                Sum { offset: total(&amplitudes), uniform: biases, sines: Vec::new(), noise: self.noise }
            }
        }
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
