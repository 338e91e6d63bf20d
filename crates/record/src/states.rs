//! States of laws, filters, observers, dampers and bearings, with their names in a log.

use flexsc_dynamics::three_axis::SlipDirection;

use super::row::label_cells;
use crate::enum_label::labels;

/// Declares enumerations of two values, the second of which corresponds to `true`.
macro_rules! states {
    ($($(#[doc = $doc:literal])* $name:ident {
        #[doc = $no_doc:literal] $no:ident = $no_label:literal,
        #[doc = $yes_doc:literal] $yes:ident = $yes_label:literal,
    })+) => {
        $(
            labels! {
                $(#[doc = $doc])*
                $name {
                    #[doc = $no_doc] $no = $no_label,
                    #[doc = $yes_doc] $yes = $yes_label,
                }
            }

            impl From<bool> for $name {
                fn from(yes: bool) -> Self {
                    if yes { Self::$yes } else { Self::$no }
                }
            }
        )+
        label_cells!($($name),+);
    };
}

states! {
    /// Whether a failure begins or ends.
    Onset {
        /// It ends.
        Ends = "ends",
        /// It begins.
        Begins = "begins",
    }
    /// Whether a filter has lock.
    Lock {
        /// The filter has lost lock.
        Lost = "lost",
        /// The filter has lock.
        Locked = "locked",
    }
    /// Whether a filter updates frequencies.
    Gate {
        /// The frequency is updated.
        Learning = "learning",
        /// The amplitude of the dominant mode is too small for an update.
        Gated = "gated",
    }
    /// Whether a body is in sunlight.
    Light {
        /// Less than half of the Sun's disc is in view.
        Shadow = "shadow",
        /// At least half of the Sun's disc is in view.
        Lit = "lit",
    }
    /// How a filter used a sample.
    Use {
        /// There was no sample, or it was dropped.
        Dropped = "dropped",
        /// It was used.
        Used = "used",
    }
    /// Whether active damping may use an observer.
    Trust {
        /// Innovations of the observer are too large.
        Doubted = "doubted",
        /// Innovations of the observer are small enough.
        Trusted = "trusted",
    }
    /// Whether active damping acts about an axis.
    Latch {
        /// The rate is within the threshold.
        Quiet = "quiet",
        /// The rate exceeded the threshold and has not yet fallen below the release level.
        Latched = "latched",
    }
    /// Whether the watchdog pauses active damping.
    Watch {
        /// Active damping is allowed.
        Awake = "awake",
        /// Active damping is paused.
        Resting = "resting",
    }
}

labels! {
    /// The states of all laws, by the names under which they are logged.
    Phase {
        /// Open loop: no feedback acts.
        Open = "OPEN",
        /// PD: the sampled feedback acts.
        Feedback = "PD",
        /// Relay: weak push before the first boundary is reached.
        Start = "W0",
        /// Relay: strong push to the left, from beyond the right boundary.
        PushFromRight = "RACC",
        /// Relay: strong timed brake of the leftward motion.
        BrakeFromRight = "RBRK",
        /// Relay: weak push to the right, while coasting inside the dead zone.
        WeakRight = "W+",
        /// Relay: strong push to the right, from beyond the left boundary.
        PushFromLeft = "LACC",
        /// Relay: strong timed brake of the rightward motion.
        BrakeFromLeft = "LBRK",
        /// Relay: weak push to the left, while coasting inside the dead zone.
        WeakLeft = "W-",
        /// Phase plane: the rate is within its limits.
        Coasting = "COAST",
        /// Phase plane: pulses bring the rate back within its limits.
        Firing = "FIRE",
        /// B-dot: magnetic moments reduce the rotation.
        Detumbling = "BDOT",
    }
}

impl Phase {
    /// Returns true if the strong torque is on.
    pub const fn is_strong(self) -> bool {
        matches!(self, Self::PushFromRight | Self::BrakeFromRight | Self::PushFromLeft | Self::BrakeFromLeft)
    }
}

label_cells!(Phase);

labels! {
    /// Whether a wheel turns in its bearing, and which way.
    Sliding {
        /// It turns at a negative speed.
        Backward = "backward",
        /// It is at rest relative to the body.
        Stuck = "stuck",
        /// It turns at a positive speed.
        Forward = "forward",
    }
}

labels! {
    /// Outcome of a reading that an attitude filter did not accept at once.
    ReadingOutcome {
        /// Refused: not finite, not of unit length, or a rate above the largest.
        Unsound = "unsound",
        /// Refused: its innovation is above the gate.
        Improbable = "improbable",
        /// Refused: older than the recent past of the filter.
        Untimely = "untimely",
        /// Accepted after refusals or a gap, with an inflated covariance.
        Reaccepted = "reaccepted",
    }
}

label_cells!(Sliding, ReadingOutcome);

impl From<SlipDirection> for Sliding {
    fn from(direction: SlipDirection) -> Self {
        match direction {
            SlipDirection::Backward => Self::Backward,
            SlipDirection::Stuck => Self::Stuck,
            SlipDirection::Forward => Self::Forward,
        }
    }
}
