//! Mode of operation under a supervisor.

use crate::ticks::Ticks;

/// Mode of operation in the list of modes.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct SupervisedMode {
    /// Period at which its conditions are tested.
    pub period: Ticks,
    /// Index of its first end.
    pub first_exit: usize,
    /// Number of its ends, which follow each other.
    pub exit_count: usize,
    /// Number of times that it was entered.
    pub entries: u64,
}
