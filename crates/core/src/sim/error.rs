//! Why a run ends before its end.

use thiserror::Error;

use crate::own::Halt;
use crate::record::RecordError;
use crate::time::Instant;

/// A simulation that cannot go on.
#[derive(Debug, Error)]
pub enum SimulationError {
    /// The state of the body is no longer a finite number.
    #[error("the state is no longer finite at t = {at} s")]
    NonFinite {
        /// When.
        at: Instant,
    },
    /// The law switches without end at one instant.
    #[error("chatter: the law decided {count} times at t = {at} s")]
    Chatter {
        /// When.
        at: Instant,
        /// How often.
        count: u32,
    },
    /// The law switches faster than any mode of the body moves.
    #[error(
        "chatter: the law switched {count} times within {span:.1e} s, up to t = {at} s, which is less than a thousandth of the period \
         of any mode: is its hysteresis too small, or its torque too large?"
    )]
    LawChatter {
        /// When.
        at: Instant,
        /// How often.
        count: u64,
        /// The span in which it would not be an error (s).
        span: f64,
    },
    /// Wheels slip and stick without end.
    #[error("chatter: wheels slipped and stuck {count} times within a nanosecond at t = {at} s")]
    WheelChatter {
        /// When.
        at: Instant,
        /// How often.
        count: u32,
    },
    /// A part of a program's own cannot go on.
    #[error("the {role} at t = {at} s: {source}")]
    Own {
        /// When.
        at: Instant,
        /// Its role.
        role: &'static str,
        /// Why.
        source: Halt,
    },
    /// The record could not be kept.
    #[error(transparent)]
    Record(#[from] RecordError),
}
