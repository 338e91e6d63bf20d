//! Moments of a co-simulation: instants, before and after the response to their events.

use flexsc_core::numerics::time::Instant;
use serde::{Deserialize, Serialize};

/// Instant of a run, and whether the response to its event has been given.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Moment {
    /// Whole seconds.
    whole: u64,
    /// Femtoseconds past the whole second.
    part: u64,
    /// True if everything that is due at the instant has been done.
    pub is_complete: bool,
}

impl Moment {
    /// Creates the moment of an instant.
    pub fn new(at: Instant, is_complete: bool) -> Self {
        let (whole, part) = at.parts();
        Self { whole, part, is_complete }
    }

    /// Returns the instant.
    pub fn at(self) -> Instant {
        Instant::from_parts(self.whole, self.part)
    }

    /// Returns true if both numbers are those of an instant.
    pub fn is_valid(self) -> bool {
        self.whole < 1 << 60 && self.part < 1_000_000_000_000_000
    }
}
