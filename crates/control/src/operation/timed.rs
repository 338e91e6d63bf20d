//! Operators of requirements over time, on conditions that hold or not at each instant.

use super::condition::Expression;

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

impl Expression {
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
