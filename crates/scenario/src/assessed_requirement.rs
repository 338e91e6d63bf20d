//! Requirement of a scenario as it is assessed: what is sampled, how often, and against which limit.

use flexsc_control::operation::{Comparison, Expression, ModeQuantity, TimeWindow, Timed};
use flexsc_formats::reader_units::time_span;
use flexsc_numerics::time::{Instant, Span};

use super::requirement::{ErrorAxis, Interpretation, PointingIndex, WindowConvention};

/// Requirement of a scenario, ready to be assessed.
#[derive(Clone, Debug, PartialEq)]
pub struct AssessedRequirement {
    /// Name of the requirement.
    pub name: String,
    /// Origin of its values.
    pub source: RequirementSource,
    /// Unit of its values.
    pub unit: &'static str,
    /// Largest accepted value, in the unit.
    pub limit: f64,
    /// Limit as it was written, if with a unit, such as `0.1 deg`.
    pub written_limit: Option<String>,
    /// Probability at which the value is at most the limit.
    pub level: f64,
    /// Interpretation of the level.
    pub interpretation: Interpretation,
    /// Confidence that a campaign has to reach, if any.
    pub confidence: Option<f64>,
}

/// Limit of a requirement, and the origin of the values that are compared with it.
pub(super) struct RequirementLimit {
    /// Origin of the values.
    pub source: RequirementSource,
    /// SI unit of the values and of the limit.
    pub unit: &'static str,
    /// Limit in the unit.
    pub limit: f64,
    /// Limit as written with a unit; `None` of a plain number.
    pub written: Option<String>,
}

/// Origin of the values of a requirement.
#[derive(Clone, Debug, PartialEq)]
pub enum RequirementSource {
    /// Metric by its name, and the index of an element; of a list without one, the largest element.
    Metric(String, Option<usize>),
    /// Pointing index of a sampled error.
    Error(SampledError),
    /// Robustness of an expression over time.
    Formula(Box<RequirementFormula>),
}

/// Expression over time of a requirement, whose value is the limit less the robustness times a scale.
#[derive(Clone, Debug, PartialEq)]
pub struct RequirementFormula {
    /// Expression in words.
    pub text: String,
    /// Expression.
    pub expression: Expression,
    /// Scale, in the unit of the value.
    pub scale: f64,
}

impl RequirementFormula {
    /// Returns the quantity of the expression, if it has one upper limit and no other.
    pub fn limited_quantity(&self) -> Option<ModeQuantity> {
        match self.expression.measured()[..] {
            [Expression::Compared { quantity, comparison: Comparison::Below | Comparison::AtMost, .. }] => {
                Some(*quantity)
            }
            _ => None,
        }
    }

    /// Returns the start and end (s) of the time in which the expression counts, as far as it is fixed, and the index of its mode,
    /// if it has one.
    pub fn span(&self) -> ([f64; 2], Option<usize>) {
        let (window, inner) = match &self.expression {
            Expression::Timed(timed) => match &**timed {
                Timed::Always(window, inner) => (*window, inner),
                _ => (TimeWindow::REST, &self.expression),
            },
            inner => (TimeWindow::REST, inner),
        };
        let mode = match inner {
            Expression::Timed(timed) => match &**timed {
                Timed::While(condition, _) => mode_of(condition),
                _ => None,
            },
            _ => None,
        };
        ([window.from, window.to.unwrap_or(f64::INFINITY)], mode)
    }
}

/// Returns the index of the mode in which alone a condition is met.
pub fn mode_of(condition: &Expression) -> Option<usize> {
    match condition {
        Expression::Flag(ModeQuantity::Mode(index)) => Some(*index),
        Expression::All(all) => all.iter().find_map(mode_of),
        _ => None,
    }
}

/// Sampled error and its pointing index.
#[derive(Clone, Debug, PartialEq)]
pub struct SampledError {
    /// Quantity that is sampled.
    pub quantity: SampledQuantity,
    /// Axis of the component; `None` for the norm.
    pub axis: Option<ErrorAxis>,
    /// Index.
    pub index: IndexWindow,
    /// Sampling period.
    pub period: Span,
    /// First instant that counts.
    pub from: Instant,
    /// Last instant that may count.
    pub to: Instant,
    /// Number of samples from `from` to `to`.
    pub samples: u64,
    /// Condition at which samples count, with its words; `None` if all do.
    pub scope: Option<(Expression, String)>,
}

/// Sampled quantity.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SampledQuantity {
    /// Rotation from the reference attitude or angle (rad).
    PointingError,
    /// Rate less the reference rate (rad/s).
    RateError,
    /// Error of the line of sight with this index (rad), and its point.
    LineOfSight(usize, String),
}

/// Pointing index with its window.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum IndexWindow {
    /// Error itself.
    Absolute,
    /// Mean over a window.
    Mean {
        /// Length (samples).
        window: u64,
    },
    /// Error less the mean over a window.
    Relative {
        /// Length (samples).
        window: u64,
        /// Position of the error in the window.
        convention: WindowConvention,
    },
    /// Difference of the means over two windows.
    Difference {
        /// Length of each (samples).
        window: u64,
        /// Distance of their starts (samples).
        shift: u64,
        /// PDE or PRE.
        index: PointingIndex,
    },
}

impl IndexWindow {
    /// Returns the number of values of the index among a number of samples.
    pub fn values(self, samples: u64) -> u64 {
        match self {
            Self::Absolute => samples,
            Self::Relative { window, convention: WindowConvention::Uniform } => samples / window * window,
            Self::Mean { window } | Self::Relative { window, .. } => (samples + 1).saturating_sub(window),
            Self::Difference { window, shift, .. } => (samples + 1).saturating_sub(window + shift),
        }
    }

    /// Returns the number of values that one set of samples gives: by the convention `uniform` one for each place of a
    /// window, else 1. The next set begins as many samples later.
    pub fn places(self) -> u64 {
        match self {
            Self::Relative { window, convention: WindowConvention::Uniform } => window,
            _ => 1,
        }
    }

    /// Returns the number of samples of a set, from which one value or those of all places follow.
    pub fn reach(self) -> u64 {
        match self {
            Self::Absolute => 1,
            Self::Mean { window } | Self::Relative { window, .. } => window,
            Self::Difference { window, shift, .. } => window + shift,
        }
    }

    /// Returns the weights on the samples of a set whose sum is the value of the index at one of its places.
    pub fn weights(self, place: u64) -> Vec<f64> {
        let mean = |window: u64, sign: f64| vec![sign / window as f64; window as usize];
        match self {
            Self::Absolute => vec![1.0],
            Self::Mean { window } => mean(window, 1.0),
            Self::Relative { window, convention } => {
                let mut weights = mean(window, -1.0);
                weights[convention.place(window).unwrap_or(place) as usize] += 1.0;
                weights
            }
            Self::Difference { window, shift, .. } => {
                let mut weights = mean(window, -1.0);
                weights.resize(shift as usize, 0.0);
                weights.extend(mean(window, 1.0));
                weights
            }
        }
    }
}

impl AssessedRequirement {
    /// Returns the index, the window, the quantity and the part of the run, in words.
    pub fn description(&self) -> String {
        let of = match &self.source {
            RequirementSource::Metric(name, None) => name.clone(),
            RequirementSource::Metric(name, Some(index)) => format!("{name}[{index}]"),
            RequirementSource::Error(error) => error.description(),
            RequirementSource::Formula(formula) => formula.text.clone(),
        };
        if self.level < 1.0 {
            format!("{of}, {} % {}", trimmed(100.0 * self.level), self.interpretation.word())
        } else {
            of
        }
    }
}

/// Returns a number without the digits of rounding errors.
fn trimmed(value: f64) -> String {
    let text = format!("{value:.6}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

impl SampledError {
    /// Returns the time of the first sample (fs): `from`; of a line of sight, which is sampled from the start of the run
    /// on, that of the first sample from then on.
    pub fn first_sample(&self) -> u128 {
        let from = self.from.femtoseconds();
        match self.quantity {
            SampledQuantity::PointingError | SampledQuantity::RateError => from,
            SampledQuantity::LineOfSight(..) => {
                let period = (Instant::START + self.period).femtoseconds().max(1);
                from.div_ceil(period) * period
            }
        }
    }

    /// Returns true if the error of a body with this number of axes has one component.
    pub fn is_component(&self, axes: usize) -> bool {
        self.axis.is_some() || axes == 1
    }

    fn description(&self) -> String {
        let period = self.period.seconds();
        let length = |samples: u64| time_span(samples as f64 * period);
        let index = match self.index {
            IndexWindow::Absolute => "APE".to_owned(),
            IndexWindow::Mean { window } => format!("MPE over {}", length(window)),
            IndexWindow::Relative { window, convention } => {
                format!("RPE over {} ({})", length(window), convention.word())
            }
            IndexWindow::Difference { window, shift, index } => {
                format!("{index} of windows of {}, {} apart", length(window), length(shift))
            }
        };
        let quantity = match &self.quantity {
            SampledQuantity::PointingError => "the pointing error".to_owned(),
            SampledQuantity::RateError => "the rate error".to_owned(),
            SampledQuantity::LineOfSight(_, point) => format!("the line of sight of {point}"),
        };
        let axis = self.axis.map_or(String::new(), |axis| format!(" about {}", axis.name()));
        let [from, to] = [self.from, self.to].map(|at| trimmed(at.seconds()));
        let part =
            if self.from > self.to { format!("from {from} s on") } else { format!("from {from} to {to} s") };
        let scope = self.scope.as_ref().map_or_else(String::new, |(_, words)| format!(", {words}"));
        format!("{index} of {quantity}{axis}, {part}{scope}")
    }
}
