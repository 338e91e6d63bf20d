//! Conditions that end a mode of operation: comparisons of what the control system knows, joined by and, or and not.
//!
//! A condition is a list of comparisons, each with the one that follows if it is met, and if it is not. All follow later in the
//! list, so that a test ends.

use crate::supervised_mode::SupervisedMode;
use crate::ticks::Ticks;

/// Index that ends a condition which is met.
pub const CONDITION_MET: usize = 2_000_000_000;
/// Index that ends a condition which is not met.
pub const CONDITION_UNMET: usize = 2_000_000_001;

/// Source of the value in a comparison.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum ConditionSource {
    /// Reading at an index.
    Reading,
    /// Time since the mode was entered, compared exactly.
    ModeTime,
    /// Time since the start, compared exactly.
    RunTime,
    /// Number of times that the mode at an index was entered.
    Entries,
}

/// Relation between a value and a limit.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum ConditionRelation {
    /// Below the limit.
    Below,
    /// At most the limit.
    AtMost,
    /// Above the limit.
    Above,
    /// At least the limit.
    AtLeast,
    /// Equal to the limit.
    Equal,
}

impl ConditionRelation {
    /// Returns true if a number has the relation to a limit; no relation holds for a number that is not known, NaN.
    fn holds(self, value: f64, limit: f64) -> bool {
        match self {
            Self::Below => value < limit,
            Self::AtMost => value <= limit,
            Self::Above => value > limit,
            Self::AtLeast => value >= limit,
            Self::Equal => value == limit,
        }
    }

    /// Returns true if a time has the relation to a limit.
    fn holds_at(self, time: Ticks, limit: Ticks) -> bool {
        match self {
            Self::Below => time.is_before(limit),
            Self::AtMost => !limit.is_before(time),
            Self::Above => limit.is_before(time),
            Self::AtLeast => !time.is_before(limit),
            Self::Equal => !time.is_before(limit) && !limit.is_before(time),
        }
    }
}

/// Comparison in a condition.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct ConditionStep {
    /// Source of the value.
    pub source: ConditionSource,
    /// Index of the reading, or of the mode whose entries are counted.
    pub index: usize,
    /// Relation.
    pub relation: ConditionRelation,
    /// Limit of a number, in the unit of the reading.
    pub limit: f64,
    /// Limit of a time.
    pub limit_time: Ticks,
    /// Index of the comparison that follows if this one holds, or an end.
    pub met: usize,
    /// Index of the comparison that follows if this one does not hold, or an end.
    pub unmet: usize,
}

impl ConditionStep {
    /// Returns true if the comparison holds.
    fn holds(&self, mode_time: Ticks, run_time: Ticks, readings: &[f64], modes: &[SupervisedMode]) -> bool {
        match self.source {
            ConditionSource::Reading => self.relation.holds(readings[self.index], self.limit),
            ConditionSource::ModeTime => self.relation.holds_at(mode_time, self.limit_time),
            ConditionSource::RunTime => self.relation.holds_at(run_time, self.limit_time),
            ConditionSource::Entries => self.relation.holds(modes[self.index].entries as f64, self.limit),
        }
    }
}

/// Returns true if the condition whose first comparison has this index is met, at these times since the mode was entered and
/// since the start.
pub fn condition_holds(
    steps: &[ConditionStep],
    first: usize,
    mode_time: Ticks,
    run_time: Ticks,
    readings: &[f64],
    modes: &[SupervisedMode],
) -> bool {
    let mut at: usize = first;
    while at < steps.len() {
        let holds: bool = steps[at].holds(mode_time, run_time, readings, modes);
        at = if holds { steps[at].met } else { steps[at].unmet };
    }
    at == CONDITION_MET
}
