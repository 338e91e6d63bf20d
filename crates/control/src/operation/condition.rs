//! Condition of a mode's end or of a requirement as it is read, and whether it holds.

use std::collections::BTreeMap;
use std::ops::Range;

use flexsc_numerics::quantity::Finite;
use flexsc_numerics::time::Span;

use super::quantity::ModeQuantity;

/// Part of a condition that cannot be read, and the reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ConditionFault {
    /// Bytes of the part in the text of the condition.
    pub part: Range<usize>,
    /// Reason, as a text that follows the key.
    pub why: String,
}

/// Names that a condition may use as arguments.
#[derive(Clone, Debug, Default)]
pub struct Vocabulary<'a> {
    /// Kinds of the sensors, in their order.
    pub sensors: Vec<&'a str>,
    /// Names of the modes, in their order.
    pub modes: Vec<&'a str>,
    /// Numbers by name, in the units of the quantities that they are compared with.
    pub numbers: Option<&'a BTreeMap<String, Finite>>,
    /// Names for a requirement, which may have operators over time; `None` for a condition of a mode.
    pub requirement: Option<RequirementNames<'a>>,
}

/// Names that only requirements may use.
#[derive(Clone, Debug, Default)]
pub struct RequirementNames<'a> {
    /// Points of the lines of sight, in their order.
    pub points: Vec<&'a str>,
    /// Names of the faults, in their order.
    pub faults: Vec<&'a str>,
    /// Names and units of the metrics.
    pub metrics: Vec<(&'a str, &'a str)>,
}

/// Comparison of a quantity with a number.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Comparison {
    /// Below the number.
    Below,
    /// At most the number.
    AtMost,
    /// Above the number.
    Above,
    /// At least the number.
    AtLeast,
}

/// Condition that has been read.
#[derive(Clone, Debug, PartialEq)]
pub enum Expression {
    /// Comparison of a quantity with a number in its unit.
    Compared {
        /// Quantity; of several sensors of a kind, the first.
        quantity: ModeQuantity,
        /// Comparison.
        comparison: Comparison,
        /// Number, in the unit of the quantity.
        limit: f64,
    },
    /// Quantity that is true or false.
    Flag(ModeQuantity),
    /// True if another condition is false.
    Not(Box<Expression>),
    /// True if all of them are.
    All(Vec<Expression>),
    /// True if any of them is.
    Any(Vec<Expression>),
    /// Expression over time, which only a requirement has.
    Timed(Box<Timed>),
}

/// Closed window of time after an instant.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct TimeWindow {
    /// Start (s).
    pub from: f64,
    /// End (s); `None` for the end of the run.
    pub to: Option<f64>,
}

impl TimeWindow {
    /// Window from an instant to the end of the run.
    pub const REST: Self = Self { from: 0.0, to: None };
}

/// Expression that depends on more than one instant.
#[derive(Clone, Debug, PartialEq)]
pub enum Timed {
    /// True if the expression is throughout a window.
    Always(TimeWindow, Expression),
    /// True if the second expression is at an instant of the window, and the first one up to that instant.
    Until(Expression, TimeWindow, Expression),
    /// True if the second expression is at each instant at which the first one becomes true.
    When(Expression, Expression),
    /// True if the second expression is, or the first one is not.
    While(Expression, Expression),
}

impl Timed {
    /// True for an operator that cannot be within a window of time.
    pub fn is_outermost(&self) -> bool {
        matches!(self, Self::Until(..) | Self::When(..))
    }
}

/// Access to the quantities at one instant.
pub trait ModeReadings {
    /// Returns the value of a quantity in its unit, 1 or 0 of a flag; NaN while it is not known.
    fn value(&self, quantity: ModeQuantity) -> f64;

    /// Returns the span of a quantity that is a clock.
    fn clock(&self, quantity: ModeQuantity) -> Span;
}

impl Comparison {
    fn holds<T: PartialOrd>(self, value: &T, limit: &T) -> bool {
        match self {
            Self::Below => value < limit,
            Self::AtMost => value <= limit,
            Self::Above => value > limit,
            Self::AtLeast => value >= limit,
        }
    }
}

impl Expression {
    /// Returns true if the condition is met. A comparison with a quantity that is not known is false.
    pub fn holds(&self, readings: &dyn ModeReadings) -> bool {
        match self {
            Self::Compared { quantity, comparison, limit } if quantity.is_clock() => {
                comparison.holds(&readings.clock(*quantity), &Span::from_seconds(*limit))
            }
            Self::Compared { quantity, comparison, limit } => {
                comparison.holds(&readings.value(*quantity), limit)
            }
            Self::Flag(quantity) => readings.value(*quantity) == 1.0,
            Self::Not(inner) => !inner.holds(readings),
            Self::All(inner) => inner.iter().all(|inner| inner.holds(readings)),
            Self::Any(inner) => inner.iter().any(|inner| inner.holds(readings)),
            Self::Timed(_) => false,
        }
    }

    /// Returns the comparisons and flags, each with its quantity and, of a comparison, its number.
    pub fn leaves(&self) -> Vec<(ModeQuantity, Option<f64>)> {
        let number =
            |(quantity, compared): (_, Option<(_, f64)>)| (quantity, compared.map(|(_, limit)| limit));
        self.comparisons().into_iter().map(number).collect()
    }

    /// Returns the quantities of the comparisons and flags, of a comparison with its sign and number.
    pub fn comparisons(&self) -> Vec<(ModeQuantity, Option<(Comparison, f64)>)> {
        match self {
            Self::Compared { quantity, comparison, limit } => vec![(*quantity, Some((*comparison, *limit)))],
            Self::Flag(quantity) => vec![(*quantity, None)],
            Self::Not(inner) => inner.comparisons(),
            Self::All(inner) | Self::Any(inner) => inner.iter().flat_map(Self::comparisons).collect(),
            Self::Timed(timed) => match &**timed {
                Timed::Always(_, inner) => inner.comparisons(),
                Timed::Until(one, _, other) | Timed::When(one, other) | Timed::While(one, other) => {
                    [one.comparisons(), other.comparisons()].concat()
                }
            },
        }
    }

    /// Returns true if the condition reads the truth.
    pub fn reads_truth(&self) -> bool {
        self.leaves().iter().any(|(quantity, _)| quantity.is_truth())
    }

    /// True if the expression joins operators over time of which one is wanted; the parts of an operator do not count.
    pub fn has_timed(&self, is_wanted: fn(&Timed) -> bool) -> bool {
        match self {
            Self::Timed(timed) => is_wanted(timed),
            Self::Not(inner) => inner.has_timed(is_wanted),
            Self::All(inner) | Self::Any(inner) => inner.iter().any(|inner| inner.has_timed(is_wanted)),
            Self::Compared { .. } | Self::Flag(_) => false,
        }
    }

    /// Returns the expression, throughout a window.
    #[must_use]
    pub fn always(self, window: TimeWindow) -> Self {
        Self::Timed(Box::new(Timed::Always(window, self)))
    }

    /// Returns the expression, at any instant of a window.
    #[must_use]
    pub fn eventually(self, window: TimeWindow) -> Self {
        self.negated().always(window).negated()
    }

    /// Returns the window and the expression of [`Self::eventually`].
    pub fn as_eventually(&self) -> Option<(TimeWindow, &Self)> {
        let Self::Not(always) = self else { return None };
        let Self::Timed(timed) = &**always else { return None };
        match &**timed {
            Timed::Always(window, Self::Not(inner)) => Some((*window, inner)),
            _ => None,
        }
    }

    /// Returns the expression with the opposite sense.
    #[must_use]
    pub fn negated(self) -> Self {
        Self::Not(Box::new(self))
    }

    /// Returns the comparisons and flags whose size counts, and not only whether they hold.
    pub fn measured(&self) -> Vec<&Self> {
        match self {
            Self::Compared { .. } | Self::Flag(_) => vec![self],
            Self::Not(inner) => inner.measured(),
            Self::All(inner) | Self::Any(inner) => inner.iter().flat_map(Self::measured).collect(),
            Self::Timed(timed) => match &**timed {
                Timed::Always(_, inner) | Timed::When(_, inner) | Timed::While(_, inner) => inner.measured(),
                Timed::Until(held, _, reached) => [held.measured(), reached.measured()].concat(),
            },
        }
    }
}
