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
/// Number of linear programmes after which the best searches alone go on.
const FIRST_STEPS: usize = 8;
/// Number of searches that go on to their ends.
const CONTINUED: usize = 2;
/// Largest number of linear programmes of a search.
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
    let mut searches = vec![
        TuningSearch::new((start.clone(), first.clone()), TRUSTS[0]),
        TuningSearch::new((start, first), TRUSTS[1]),
    ];
    for values in (0..STARTS).map(|index| point(parameters, index)) {
        // A point that the scenario does not accept is no start.
        let Ok(here) = loops.evaluate(&values) else { continue };
        if here.unstable().is_none() {
            searches.push(TuningSearch::new((values, here), TRUSTS[0]));
        }
    }
    for search in &mut searches {
        search.advance(loops, parameters, FIRST_STEPS)?;
    }
    searches.sort_by(|a, b| b.here.merit().total_cmp(&a.here.merit()));
    let mut steps: usize = searches.iter().map(|search| search.steps).sum();
    searches.truncate(CONTINUED);
    for search in &mut searches {
        let taken = search.steps;
        search.advance(loops, parameters, MOST_STEPS)?;
        steps += search.steps - taken;
    }
    let best = searches
        .into_iter()
        .reduce(|best, other| if other.here.merit() > best.here.merit() + LEAST_GAIN { other } else { best });
    let after = best.map_or_else(|| before.clone(), |best| TuningPoint::new(&best.values, &best.here));
    Ok(TunedLoop { before, after, steps })
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

/// Search from a point at which all loops are stable.
struct TuningSearch {
    values: Vec<f64>,
    here: Evaluation,
    /// Trust region, relative to the ranges; 0 of a search that has ended.
    trust: f64,
    /// Number of linear programmes.
    steps: usize,
}

impl TuningSearch {
    fn new((values, here): (Vec<f64>, Evaluation), trust: f64) -> Self {
        Self { values, here, trust, steps: 0 }
    }

    /// Searches until the end, or until a number of linear programmes.
    fn advance(
        &mut self,
        loops: &LoopSet<'_>,
        parameters: &[TunedParameter],
        most: usize,
    ) -> Result<(), TuningFault> {
        let width = |parameter: &TunedParameter| parameter.range[1] - parameter.range[0];
        if self.trust <= SMALLEST_TRUST || self.steps >= most {
            return Ok(());
        }
        let mut slopes = loops.slopes(&self.here, &self.values, parameters)?;
        while self.trust > SMALLEST_TRUST && self.steps < most {
            self.steps += 1;
            let room = self.values.iter().zip(parameters).map(|(value, parameter)| {
                let ([low, high], most) = (parameter.range, self.trust * width(parameter));
                [(low - value).max(-most), (high - value).min(most)]
            });
            let (step, expected) = linear_step::largest_least(&slopes, &room.collect::<Vec<_>>());
            if expected < self.here.merit() + LEAST_GAIN {
                self.trust = 0.0;
                return Ok(());
            }
            let moved = self.values.iter().zip(&step).zip(parameters);
            let tried: Vec<f64> = moved
                .map(|((value, step), parameter)| {
                    (value + step).clamp(parameter.range[0], parameter.range[1])
                })
                .collect();
            // Values that the scenario does not accept, or of which the margins cannot be computed, are no step.
            let there = loops.evaluate(&tried).ok();
            match there.filter(|there| there.unstable().is_none() && there.merit() > self.here.merit()) {
                Some(better) => {
                    (self.values, self.here) = (tried, better);
                    self.trust = (self.trust * FACTORS[0]).min(LARGEST_TRUST);
                    let Ok(next) = loops.slopes(&self.here, &self.values, parameters) else {
                        self.trust = 0.0;
                        return Ok(());
                    };
                    slopes = next;
                }
                None => self.trust *= FACTORS[1],
            }
        }
        Ok(())
    }
}
