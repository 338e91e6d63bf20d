//! Modes of operation as lists of numbers, which the supervisor of [`flexsc_flight::mode_supervisor`] reads.

use flexsc_flight::mode_condition::{
    CONDITION_MET, CONDITION_UNMET, ConditionRelation, ConditionSource, ConditionStep,
};
use flexsc_flight::mode_supervisor::SupervisedExit;
use flexsc_flight::supervised_mode::SupervisedMode;
use flexsc_flight::ticks::Ticks;
use flexsc_numerics::time::Span;

use super::condition::{Comparison, Expression, Vocabulary};
use super::operating_mode::OperatingMode;
use super::quantity::ModeQuantity;
use crate::law::Stage;

/// Value that a comparison of the supervisor reads.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum ModeReading {
    /// Quantity that the control system knows.
    Known(ModeQuantity),
    /// 1 while the condition on the truth of the end with this index is met, else 0.
    Truth(usize),
}

/// End of a mode as it is written.
#[derive(Clone, Debug, PartialEq)]
pub struct WrittenExit {
    /// Index of its mode.
    pub mode: usize,
    /// Condition as written.
    pub text: String,
    /// Condition that was read.
    pub condition: Expression,
}

/// Modes of operation as lists of numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ModeTables {
    /// Names of the modes.
    pub names: Vec<String>,
    /// Modes.
    pub modes: Vec<SupervisedMode>,
    /// Ends of all modes, mode by mode.
    pub exits: Vec<SupervisedExit>,
    /// Ends as they are written; none of stages.
    pub written: Vec<WrittenExit>,
    /// Comparisons of all conditions.
    pub steps: Vec<ConditionStep>,
    /// Values that the comparisons read.
    pub readings: Vec<ModeReading>,
}

impl ModeTables {
    /// Reads the conditions of modes, which were checked before, on sensors of these kinds; a mode whose law has no period is
    /// tested at `shortest`.
    pub fn from_modes(modes: &[OperatingMode], sensors: &[&str], shortest: Span) -> Self {
        let known = Vocabulary {
            sensors: sensors.to_vec(),
            modes: modes.iter().map(|mode| mode.name.as_str()).collect(),
            ..Vocabulary::default()
        };
        let mut tables = Self::default();
        for (index, mode) in modes.iter().enumerate() {
            let first_exit = tables.exits.len();
            for exit in &mode.leave {
                let to = known.modes.iter().position(|name| *name == exit.to);
                let (Some(to), Ok(condition)) = (to, exit.read(&known)) else { continue };
                let text = exit.when.text().to_owned();
                tables.written.push(WrittenExit { mode: index, text, condition });
                tables.add_exit(to, exit.dwell());
            }
            let period = mode.law.period().unwrap_or(shortest);
            tables.add_mode(mode.name.clone(), period, first_exit);
        }
        tables
    }

    /// Returns stages of a law as modes, each of which ends at the start of the next one.
    pub fn from_stages(stages: &[Stage]) -> Self {
        let mut tables = Self::default();
        for (index, stage) in stages.iter().enumerate() {
            let first_exit = tables.exits.len();
            if let Some(next) = stages.get(index + 1) {
                let instant = next.begins().ticks();
                let step = ConditionStep {
                    source: ConditionSource::RunTime,
                    index: 0,
                    relation: ConditionRelation::AtLeast,
                    limit: 0.0,
                    limit_time: instant,
                    met: CONDITION_MET,
                    unmet: CONDITION_UNMET,
                };
                let exit = SupervisedExit { is_exact: true, has_instant: true, instant, ..NO_EXIT };
                tables.exits.push(SupervisedExit { to: index + 1, first_step: tables.steps.len(), ..exit });
                tables.steps.push(step);
            }
            let period = stage.law.period().unwrap_or(Span::from_seconds(1.0));
            tables.add_mode(format!("stage_{index}"), period, first_exit);
        }
        tables
    }

    fn add_mode(&mut self, name: String, period: Span, first_exit: usize) {
        let exit_count = self.exits.len() - first_exit;
        self.names.push(name);
        self.modes.push(SupervisedMode { period: period.ticks(), first_exit, exit_count, entries: 0 });
    }

    /// Adds the end that was written last. Of a condition on the truth the supervisor reads whether it is met.
    fn add_exit(&mut self, to: usize, dwell: Span) {
        let index = self.exits.len();
        let Some(WrittenExit { condition, .. }) = self.written.last().cloned() else { return };
        let (first_step, is_exact) = (self.steps.len(), condition.reads_truth());
        if is_exact {
            let flag = self.reading(ModeReading::Truth(index));
            self.steps.push(ConditionStep { index: flag, ..FLAG });
        } else {
            self.add_steps(&condition, CONDITION_MET, CONDITION_UNMET);
        }
        self.exits.push(SupervisedExit { to, first_step, dwell: dwell.ticks(), is_exact, ..NO_EXIT });
    }

    /// Adds the comparisons of a condition, with the comparisons that follow it if it is met, and if it is not.
    fn add_steps(&mut self, condition: &Expression, met: usize, unmet: usize) {
        match condition {
            Expression::Compared { quantity, comparison, limit } => {
                let (source, index) = self.source(*quantity);
                let limit_time =
                    if quantity.is_clock() { Span::from_seconds(*limit).ticks() } else { Ticks::default() };
                let relation = match comparison {
                    Comparison::Below => ConditionRelation::Below,
                    Comparison::AtMost => ConditionRelation::AtMost,
                    Comparison::Above => ConditionRelation::Above,
                    Comparison::AtLeast => ConditionRelation::AtLeast,
                };
                let limit = *limit;
                self.steps.push(ConditionStep { source, index, relation, limit, limit_time, met, unmet });
            }
            Expression::Flag(quantity) => {
                let (source, index) = self.source(*quantity);
                self.steps.push(ConditionStep { source, index, met, unmet, ..FLAG });
            }
            Expression::Not(inner) => self.add_steps(inner, unmet, met),
            Expression::All(list) => self.add_list(list, |next| (next, unmet), (met, unmet)),
            Expression::Any(list) => self.add_list(list, |next| (met, next), (met, unmet)),
            // No mode has one.
            Expression::Timed(_) => {}
        }
    }

    /// Adds conditions one after another; `ends` returns the comparisons after one that is followed by the comparison `next`.
    fn add_list(
        &mut self,
        list: &[Expression],
        ends: impl Fn(usize) -> (usize, usize),
        last: (usize, usize),
    ) {
        for (place, condition) in list.iter().enumerate() {
            let next = self.steps.len() + condition.leaves().len();
            let (met, unmet) = if place + 1 < list.len() { ends(next) } else { last };
            self.add_steps(condition, met, unmet);
        }
    }

    /// Returns the source of a quantity, and its index.
    fn source(&mut self, quantity: ModeQuantity) -> (ConditionSource, usize) {
        match quantity {
            ModeQuantity::Time => (ConditionSource::ModeTime, 0),
            ModeQuantity::RunTime => (ConditionSource::RunTime, 0),
            ModeQuantity::Entries(mode) => (ConditionSource::Entries, mode),
            known => (ConditionSource::Reading, self.reading(ModeReading::Known(known))),
        }
    }

    /// Returns the index of a reading, which is added if it is new.
    fn reading(&mut self, reading: ModeReading) -> usize {
        let found = self.readings.iter().position(|known| *known == reading);
        found.unwrap_or_else(|| {
            self.readings.push(reading);
            self.readings.len() - 1
        })
    }
}

/// Comparison of a flag.
const FLAG: ConditionStep = ConditionStep {
    source: ConditionSource::Reading,
    index: 0,
    relation: ConditionRelation::Equal,
    limit: 1.0,
    limit_time: Ticks { whole: 0, part: 0 },
    met: CONDITION_MET,
    unmet: CONDITION_UNMET,
};

/// End before its numbers are set.
const NO_EXIT: SupervisedExit = SupervisedExit {
    to: 0,
    first_step: 0,
    dwell: Ticks { whole: 0, part: 0 },
    is_exact: false,
    has_instant: false,
    instant: Ticks { whole: 0, part: 0 },
    is_held: false,
    since: Ticks { whole: 0, part: 0 },
};
