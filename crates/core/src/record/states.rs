//! States of filters, observers and dampers that are one thing or the other, with the names that a log has for them.

use super::row::label_cells;
use crate::label::labels;

/// Declares enumerations of two values, the second of which is what a `true` stands for.
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
    /// Whether a filter follows the body.
    Lock {
        /// It has lost the body.
        Lost = "lost",
        /// It follows.
        Locked = "locked",
    }
    /// Whether a filter learns frequencies.
    Gate {
        /// It learns.
        Learning = "learning",
        /// The dominant mode moves too little for that.
        Gated = "gated",
    }
    /// Whether the Sun shines on a body.
    Light {
        /// The planet hides it.
        Shadow = "shadow",
        /// It shines.
        Lit = "lit",
    }
    /// What a filter did with a sample.
    Use {
        /// There was none, or it was dropped.
        Dropped = "dropped",
        /// It was used.
        Used = "used",
    }
    /// Whether an observer may be acted on.
    Trust {
        /// Its innovations are too large.
        Doubted = "doubted",
        /// They are small enough.
        Trusted = "trusted",
    }
    /// Whether active damping is at work about an axis.
    Latch {
        /// The rate is within the threshold.
        Quiet = "quiet",
        /// It was beyond the threshold, and is not yet back.
        Latched = "latched",
    }
    /// Whether the watchdog keeps active damping quiet.
    Watch {
        /// It does not.
        Awake = "awake",
        /// It does.
        Resting = "resting",
    }
}
