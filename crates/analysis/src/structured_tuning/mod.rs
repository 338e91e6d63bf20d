//! Structured tuning: parameters of a law of any form that maximise the least modulus margin over a set of plants, or
//! minimise a settling time or a pointing index, within limits of the others.
//!
//! Each local minimum of 1/s1(S) over frequency, with the largest singular value s1 of the sensitivity S, is linearised in
//! the parameters at its frequency: at a minimum, the change of the frequency has no effect to first order. A linear
//! programme within a trust region maximises the least of them; a step is taken if it raises the least margin and leaves
//! every loop stable. A settling time and a pointing index are linearised as they are. Such a search ends at a local optimum,
//! so several are made.

mod goal;
mod linear_step;
mod loop_set;
mod scenario_loops;
mod scenario_measure;
mod scenario_tuning;
mod sensitivity_minima;

use std::fmt;

use flexsc_formats::document::ConfigError;

pub use goal::{TunedMeasure, TuningGoal, TuningLimit, TuningObjective};
pub use loop_set::{LoopSet, PlantMargin, TunedPlant};
pub use scenario_loops::{MOST_UNCERTAIN, ScenarioLoops};
pub use scenario_tuning::{
    KeyChange, MOST_TUNED, MeasureChange, PlantChange, ScenarioTuning, TunedScenario, TuningReport,
};
pub use sensitivity_minima::LoopSensitivity;

use loop_set::Evaluation;

use crate::margins::magnitude_text;

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
    /// Largest value of each measure of the goal, and the plant that has it.
    pub measures: Vec<(f64, usize)>,
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
    /// The objective has no finite value at the start: the name of its measure.
    Unbounded(String),
}

impl fmt::Display for TuningFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unstable(plant, radius) => write!(
                f,
                "the closed loop of plant {plant} is not stable at the start: its spectral radius is {}; a search for margins \
                 starts from a stable loop",
                magnitude_text(*radius)
            ),
            Self::Key(fault) => write!(f, "`{}`: {}", fault.key, fault.why),
            Self::Loop(why) => f.write_str(why),
            Self::Unbounded(name) => write!(
                f,
                "`{name}` has no finite value above 0 at the start: a search for smaller values starts from one"
            ),
        }
    }
}

impl std::error::Error for TuningFault {}

impl TuningPoint {
    fn new(values: &[f64], evaluation: &Evaluation, measures: usize) -> Self {
        Self {
            values: values.to_vec(),
            plants: evaluation.margins(),
            bandwidth_gain: evaluation.bandwidth_gain(),
            measures: (0..measures).map(|index| LoopSet::largest(evaluation, index)).collect(),
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

/// Tunes the parameters of a set of loops within their ranges for a goal: the best of searches from the start, with a
/// narrow and a wide trust region, and from points of the ranges at which all loops are stable.
///
/// # Errors
/// A loop that cannot be formed, or that is not stable at the start; an objective without a finite value there.
pub fn tune(loops: &LoopSet<'_>, parameters: &[TunedParameter]) -> Result<TunedLoop, TuningFault> {
    let start: Vec<f64> = parameters.iter().map(|parameter| parameter.start).collect();
    let first = loops.evaluate(&start)?;
    if let Some((plant, radius)) = first.unstable() {
        return Err(TuningFault::Unstable(plant, radius));
    }
    let measures = loops.goal.measures.len();
    let before = TuningPoint::new(&start, &first, measures);
    // A minimised measure in units of its value at the start has the size of a margin.
    let unit = loops.goal.minimised.map_or(1.0, |index| before.measures[index].0);
    if !(unit > 0.0 && unit.is_finite()) {
        let index = loops.goal.minimised.unwrap_or(0);
        return Err(TuningFault::Unbounded(loops.goal.measures[index].name.clone()));
    }
    let problem = TuningProblem { loops, parameters, unit };
    let search = |values: Vec<f64>, here: Evaluation, trust: f64| TuningSearch {
        merit: loops.merit(&here, unit),
        values,
        here,
        trust,
        steps: 0,
    };
    let mut searches = vec![search(start.clone(), first.clone(), TRUSTS[0]), search(start, first, TRUSTS[1])];
    for values in (0..STARTS).map(|index| point(parameters, index)) {
        // A point that the scenario does not accept is no start.
        let Ok(here) = loops.evaluate(&values) else { continue };
        if here.unstable().is_none() {
            searches.push(search(values, here, TRUSTS[0]));
        }
    }
    for search in &mut searches {
        search.advance(&problem, FIRST_STEPS)?;
    }
    searches.sort_by(|a, b| b.merit.total_cmp(&a.merit));
    let mut steps: usize = searches.iter().map(|search| search.steps).sum();
    searches.truncate(CONTINUED);
    for search in &mut searches {
        let taken = search.steps;
        search.advance(&problem, MOST_STEPS)?;
        steps += search.steps - taken;
    }
    let best = searches
        .into_iter()
        .reduce(|best, other| if other.merit > best.merit + LEAST_GAIN { other } else { best });
    let after =
        best.map_or_else(|| before.clone(), |best| TuningPoint::new(&best.values, &best.here, measures));
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

/// Loops with the parameters of a tuning.
struct TuningProblem<'a> {
    loops: &'a LoopSet<'a>,
    parameters: &'a [TunedParameter],
    /// Unit of a minimised measure.
    unit: f64,
}

/// Search from a point at which all loops are stable.
struct TuningSearch {
    values: Vec<f64>,
    here: Evaluation,
    /// Merit of the point.
    merit: f64,
    /// Trust region, relative to the ranges; 0 of a search that has ended.
    trust: f64,
    /// Number of linear programmes.
    steps: usize,
}

impl TuningSearch {
    /// Searches until the end, or until a number of linear programmes.
    fn advance(&mut self, problem: &TuningProblem<'_>, most: usize) -> Result<(), TuningFault> {
        let TuningProblem { loops, parameters, unit } = *problem;
        let width = |parameter: &TunedParameter| parameter.range[1] - parameter.range[0];
        if self.trust <= SMALLEST_TRUST || self.steps >= most {
            return Ok(());
        }
        let mut slopes = loops.slopes(&self.here, unit, &self.values, parameters)?;
        while self.trust > SMALLEST_TRUST && self.steps < most {
            self.steps += 1;
            let room = self.values.iter().zip(parameters).map(|(value, parameter)| {
                let ([low, high], most) = (parameter.range, self.trust * width(parameter));
                [(low - value).max(-most), (high - value).min(most)]
            });
            let (step, expected) = linear_step::largest_least(&slopes, &room.collect::<Vec<_>>());
            if expected < self.merit + LEAST_GAIN {
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
            let there = loops.evaluate(&tried).ok().filter(|there| there.unstable().is_none());
            let better = there
                .map(|there| (loops.merit(&there, unit), there))
                .filter(|(merit, _)| *merit > self.merit);
            match better {
                Some((merit, better)) => {
                    (self.values, self.here, self.merit) = (tried, better, merit);
                    self.trust = (self.trust * FACTORS[0]).min(LARGEST_TRUST);
                    let Ok(next) = loops.slopes(&self.here, unit, &self.values, parameters) else {
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
