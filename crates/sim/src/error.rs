//! Errors that end a run before its end.

use flexsc_control::custom::PartError;
use flexsc_numerics::time::Instant;
use flexsc_record::RecordError;
use flexsc_scenario::PATH_HAS_NO_RUN;
use thiserror::Error;

/// Error that ends a simulation.
#[derive(Debug, Error)]
pub enum SimulationError {
    /// The state of the body is no longer a finite number.
    #[error("the state is no longer finite at t = {at} s")]
    NonFinite {
        /// Instant of the state.
        at: Instant,
    },
    /// The rotation of a three-axis body is no longer small.
    #[error(
        "the rotation about {axis} is no longer small at t = {at} s: it leaves `small_angles.{key} = {limit}`; give a larger \
         limit, or leave out `small_angles` for any rotation"
    )]
    SmallAngles {
        /// Instant at which the motion reached the limit.
        at: Instant,
        /// Axis: `roll`, `pitch` or `yaw`.
        axis: &'static str,
        /// Key of the limit: `angle` or `rate`.
        key: &'static str,
        /// Limit (rad or rad/s).
        limit: f64,
    },
    /// The law switches endlessly at one instant.
    #[error(
        "chatter: the law decided {count} times at t = {at} s: is the next time or level that it gives passed already?"
    )]
    Chatter {
        /// Instant of the decisions.
        at: Instant,
        /// Number of decisions.
        count: u32,
    },
    /// The law switches faster than any mode of the body moves.
    #[error(
        "chatter: the law switched {count} times within {span:.1e} s, up to t = {at} s, which is less than a thousandth of the period \
         of any mode: is its hysteresis too small, or its torque too large?"
    )]
    LawChatter {
        /// Instant of the last switching.
        at: Instant,
        /// Number of switchings.
        count: u64,
        /// Shortest duration of that many switchings that is no error (s).
        span: f64,
    },
    /// The modes of operation change endlessly.
    #[error(
        "chatter: the mode of operation changed {count} times within a second, up to t = {at} s, between `{before}` and `{after}`: \
         give their conditions different limits, or a dwell `for`"
    )]
    ModeChatter {
        /// Instant of the last change.
        at: Instant,
        /// Number of changes.
        count: usize,
        /// Name of the mode before the last change.
        before: String,
        /// Name of the mode after it.
        after: String,
    },
    /// Wheels slip and stick endlessly.
    #[error("chatter: wheels slipped and stuck {count} times within a nanosecond at t = {at} s")]
    WheelChatter {
        /// Instant of the last event.
        at: Instant,
        /// Number of events within a nanosecond.
        count: u32,
    },
    /// A measured path to a line of sight is a response over frequency, which a run does not have.
    #[error("`{key}` {PATH_HAS_NO_RUN}")]
    MeasuredPath {
        /// Key of the paths.
        key: String,
    },
    /// A custom part cannot go on.
    #[error("the {role} at t = {at} s: {source}")]
    Own {
        /// Instant of the failure.
        at: Instant,
        /// Role of the part, such as `law`.
        role: &'static str,
        /// Error of the part.
        source: PartError,
    },
    /// The record could not be written.
    #[error(transparent)]
    Record(#[from] RecordError),
}
