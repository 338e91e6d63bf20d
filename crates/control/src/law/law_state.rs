//! State of a law for the log and the run loop, and the references that it reads.

use super::Phase;
use crate::state_estimate::DampingStatus;

/// State of a law.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct LawState<'a> {
    /// Phase of the law, which the log has.
    pub phase: Phase,
    /// Value of the parameter tuned last, or of the law's tunable parameter; NaN if there is none.
    pub tuned: f64,
    /// Status of active damping in the last cycle, if the law has it.
    pub damping: Option<&'a DampingStatus>,
}

impl LawState<'_> {
    /// Creates the state of a law in this phase, without a tuned parameter and without active damping.
    pub fn new(phase: Phase) -> Self {
        Self { phase, tuned: f64::NAN, damping: None }
    }

    /// Creates the state of a law in this phase with the value of its tuned parameter.
    pub fn with_tuned(phase: Phase, tuned: f64) -> Self {
        Self { tuned, ..Self::new(phase) }
    }
}

/// References that a law reads besides the current state estimate.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct ReferenceNeeds {
    /// True if the law tracks a manoeuvre while it lasts, and not only from its end on.
    pub tracks_manoeuvre: bool,
    /// Lead time after a sample for which the law reads predicted elastic rates (s).
    pub lead_time: f64,
}
