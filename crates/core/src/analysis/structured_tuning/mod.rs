//! Structured tuning: parameters of a law of any form that maximise the least modulus margin over a set of plants.
//!
//! Each local minimum of 1/s1(S) over frequency, with the largest singular value s1 of the sensitivity S, is linearised in
//! the parameters at its frequency: at a minimum, the change of the frequency has no effect to first order. A linear
//! programme within a trust region maximises the least of them; a step is taken if it raises the least margin and leaves
//! every loop stable. Such a search ends at a local optimum, so several are made.

mod linear_step;
mod loop_set;
mod scenario_loops;
mod scenario_tuning;
mod sensitivity_minima;

use std::fmt;

use flexsc_formats::document::ConfigError;

pub use loop_set::{LoopSet, PlantMargin};
pub use scenario_loops::{MOST_UNCERTAIN, ScenarioLoops};
pub use scenario_tuning::{MOST_TUNED, ScenarioTuning, TunedScenario};
pub use sensitivity_minima::LoopSensitivity;

use loop_set::Evaluation;

/// Narrow and wide trust region at the start, relative to the ranges.
const TRUSTS: [f64; 2] = [0.1, 0.4];
/// Number of points of the ranges from which searches start.
const STARTS: usize = 6;
/// Largest trust region, relative to the ranges.
const LARGEST_TRUST: f64 = 0.5;
/// Trust region below which the search ends, relative to the ranges.
const SMALLEST_TRUST: f64 = 1e-9;
/// Factors on the trust region after a step that was taken, and after one that was not.
const FACTORS: [f64; 2] = [1.5, 0.4];
/// Largest number of linear programmes.
const MOST_STEPS: usize = 200;
/// Increase of the margin below which steps no longer count.
const LEAST_GAIN: f64 = 1e-11;

/// Parameter of a law.
#[derive(Clone, Debug, PartialEq)]
pub struct TunedParameter {
    /// Key of the scenario, such as `law.pd.k_d`.
    pub key: String,
    /// Value at the start.
    pub start: f64,
    /// Least and largest value.
    pub range: [f64; 2],
}

/// Parameters and the margins that they give.
#[derive(Clone, Debug, PartialEq)]
pub struct TuningPoint {
    /// Value of each parameter.
    pub values: Vec<f64>,
    /// Margin of each plant.
    pub plants: Vec<PlantMargin>,
    /// Least loop gain of the nominal plant at the bandwidth; none without one.
    pub bandwidth_gain: Option<f64>,
}

/// Result of a tuning.
#[derive(Clone, Debug, PartialEq)]
pub struct TunedLoop {
    /// Parameters of the scenario.
    pub before: TuningPoint,
    /// Tuned parameters.
    pub after: TuningPoint,
    /// Number of linear programmes.
    pub steps: usize,
}

/// Reason for which a loop cannot be tuned.
#[derive(Clone, Debug, PartialEq)]
pub enum TuningFault {
    /// Key that cannot be tuned.
    Key(ConfigError),
    /// The loop with the parameters of the scenario is not stable for this plant, with this spectral radius.
    Unstable(usize, f64),
    /// The loop cannot be formed.
    Loop(String),
}

impl fmt::Display for TuningFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unstable(plant, radius) => write!(
                f,
                "the closed loop of plant {plant} is not stable at the start: its spectral radius is {radius:.7}; a search for \
                 margins starts from a stable loop"
            ),
            Self::Key(fault) => write!(f, "`{}`: {}", fault.key, fault.why),
            Self::Loop(why) => f.write_str(why),
        }
    }
}

impl std::error::Error for TuningFault {}

impl TuningPoint {
    fn new(values: &[f64], evaluation: &Evaluation) -> Self {
        Self {
            values: values.to_vec(),
            plants: evaluation.margins(),
            bandwidth_gain: evaluation.bandwidth_gain(),
        }
    }

    /// Returns the least margin.
    pub fn least(&self) -> f64 {
        self.worst().map_or(f64::NAN, |worst| worst.margin)
    }

    /// Returns the plant with the least margin.
    pub fn worst(&self) -> Option<&PlantMargin> {
        self.plants.iter().min_by(|a, b| a.margin.total_cmp(&b.margin))
    }
}

/// Maximises the least modulus margin of a set of loops over parameters within their ranges: the best of searches from the
/// start, with a narrow and a wide trust region, and from points of the ranges at which all loops are stable.
///
/// # Errors
/// A loop that cannot be formed, or that is not stable at the start.
pub fn tune(loops: &LoopSet<'_>, parameters: &[TunedParameter]) -> Result<TunedLoop, TuningFault> {
    let start: Vec<f64> = parameters.iter().map(|parameter| parameter.start).collect();
    let first = loops.evaluate(&start)?;
    if let Some((plant, radius)) = first.unstable() {
        return Err(TuningFault::Unstable(plant, radius));
    }
    let before = TuningPoint::new(&start, &first);
    let mut best = search(loops, parameters, (start.clone(), first), TRUSTS[0])?;
    let mut steps = best.steps;
    let elsewhere = (0..STARTS).map(|index| (point(parameters, index), TRUSTS[0]));
    for (values, trust) in std::iter::once((start, TRUSTS[1])).chain(elsewhere) {
        // A point that the scenario does not accept is no start.
        let Ok(here) = loops.evaluate(&values) else { continue };
        if here.unstable().is_some() {
            continue;
        }
        let found = search(loops, parameters, (values, here), trust)?;
        steps += found.steps;
        if found.here.merit() > best.here.merit() + LEAST_GAIN {
            best = found;
        }
    }
    Ok(TunedLoop { before, after: TuningPoint::new(&best.values, &best.here), steps })
}

/// Returns a point of the ranges: of a sequence that fills them evenly, with the golden ratio of that many dimensions.
fn point(parameters: &[TunedParameter], index: usize) -> Vec<f64> {
    let dimensions = parameters.len() as f64;
    // The root of x^(d + 1) = x + 1, by its contraction.
    let ratio = (0..60).fold(2.0, |x: f64, _| libm::pow(1.0 + x, 1.0 / (dimensions + 1.0)));
    let each = parameters.iter().enumerate().map(|(place, TunedParameter { range: [low, high], .. })| {
        let turns = 0.5 + (index + 1) as f64 * libm::pow(ratio, -(place as f64 + 1.0));
        low + (high - low) * (turns - libm::floor(turns))
    });
    each.collect()
}

/// End of a search.
struct SearchEnd {
    values: Vec<f64>,
    here: Evaluation,
    steps: usize,
}

/// Searches from a point at which all loops are stable.
fn search(
    loops: &LoopSet<'_>,
    parameters: &[TunedParameter],
    (mut values, mut here): (Vec<f64>, Evaluation),
    mut trust: f64,
) -> Result<SearchEnd, TuningFault> {
    let width = |parameter: &TunedParameter| parameter.range[1] - parameter.range[0];
    let mut steps = 0;
    let mut slopes = loops.slopes(&here, &values, parameters)?;
    while trust > SMALLEST_TRUST && steps < MOST_STEPS {
        steps += 1;
        let room = values.iter().zip(parameters).map(|(value, parameter)| {
            let ([low, high], most) = (parameter.range, trust * width(parameter));
            [(low - value).max(-most), (high - value).min(most)]
        });
        let (step, expected) = linear_step::largest_least(&slopes, &room.collect::<Vec<_>>());
        if expected < here.merit() + LEAST_GAIN {
            break;
        }
        let moved = values.iter().zip(&step).zip(parameters);
        let tried: Vec<f64> = moved
            .map(|((value, step), parameter)| (value + step).clamp(parameter.range[0], parameter.range[1]))
            .collect();
        // Values that the scenario does not accept, or of which the margins cannot be computed, are no step.
        let there = loops.evaluate(&tried).ok();
        match there.filter(|there| there.unstable().is_none() && there.merit() > here.merit()) {
            Some(better) => {
                (values, here) = (tried, better);
                let Ok(next) = loops.slopes(&here, &values, parameters) else { break };
                slopes = next;
                trust = (trust * FACTORS[0]).min(LARGEST_TRUST);
            }
            None => trust *= FACTORS[1],
        }
    }
    Ok(SearchEnd { values, here, steps })
}
