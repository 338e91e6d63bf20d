//! Structured tuning: parameters of a law of any form that maximise the least modulus margin over a set of plants.
//!
//! Each local minimum of 1/s1(S) over frequency, with the largest singular value s1 of the sensitivity S, is linearised in
//! the parameters at its frequency: at a minimum, the change of the frequency has no effect to first order. A linear
//! programme within a trust region maximises the least of them; a step is taken if it raises the least margin and leaves
//! every loop stable.

mod linear_step;
mod loop_set;
mod scenario_loops;
mod scenario_tuning;
mod sensitivity_minima;

use std::fmt;

use flexsc_formats::document::ConfigError;

pub use loop_set::{LoopSet, PlantMargin};
pub use scenario_loops::{MOST_UNCERTAIN, ScenarioLoops, UncertainKey};
pub use scenario_tuning::{MOST_TUNED, ScenarioTuning, TunedScenario};
pub use sensitivity_minima::LoopSensitivity;

use loop_set::Evaluation;

/// Trust region at the start, relative to the ranges.
const TRUST: f64 = 0.1;
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
        Self { values: values.to_vec(), plants: evaluation.margins() }
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

/// Maximises the least modulus margin of a set of loops over parameters within their ranges.
///
/// # Errors
/// A loop that cannot be formed, or that is not stable at the start.
pub fn tune(loops: &LoopSet<'_>, parameters: &[TunedParameter]) -> Result<TunedLoop, TuningFault> {
    let inside = |value: f64, parameter: &TunedParameter| value.clamp(parameter.range[0], parameter.range[1]);
    let mut values: Vec<f64> =
        parameters.iter().map(|parameter| inside(parameter.start, parameter)).collect();
    let mut here = loops.evaluate(&values)?;
    if let Some((plant, radius)) = here.unstable() {
        return Err(TuningFault::Unstable(plant, radius));
    }
    let start: Vec<f64> = parameters.iter().map(|parameter| parameter.start).collect();
    let before = TuningPoint::new(&start, &here);
    let widths: Vec<f64> =
        parameters.iter().map(|parameter| parameter.range[1] - parameter.range[0]).collect();
    let (mut trust, mut steps) = (TRUST, 0);
    let mut slopes = loops.slopes(&here, &values, parameters)?;
    while trust > SMALLEST_TRUST && steps < MOST_STEPS {
        steps += 1;
        let room: Vec<[f64; 2]> = values
            .iter()
            .zip(parameters)
            .zip(&widths)
            .map(|((value, parameter), width)| {
                [
                    (parameter.range[0] - value).max(-trust * width),
                    (parameter.range[1] - value).min(trust * width),
                ]
            })
            .collect();
        let (step, expected) = linear_step::largest_least(&slopes, &room);
        if expected < here.merit() + LEAST_GAIN {
            break;
        }
        let tried: Vec<f64> = values
            .iter()
            .zip(&step)
            .zip(parameters)
            .map(|((value, step), parameter)| inside(value + step, parameter))
            .collect();
        let there = loops.evaluate(&tried)?;
        if there.unstable().is_none() && there.merit() > here.merit() {
            (values, here) = (tried, there);
            slopes = loops.slopes(&here, &values, parameters)?;
            trust = (trust * FACTORS[0]).min(LARGEST_TRUST);
        } else {
            trust *= FACTORS[1];
        }
    }
    Ok(TunedLoop { before, after: TuningPoint::new(&values, &here), steps })
}
