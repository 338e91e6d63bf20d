//! Guards: thresholds of the measured angle.

pub use flexsc_flight::guard::{Guard, GuardDirection};
use flexsc_numerics::time::Instant;

/// Guards about each axis; those of a one-axis body are about the first.
pub type AxisGuards<'a> = [&'a [Guard]; 3];

/// Guard that trips, with its instant.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct GuardCrossing {
    /// Instant of the trip.
    pub at: Instant,
    /// Axis of the guard: 0, or 0 to 2 for roll, pitch and yaw.
    pub axis: usize,
    /// Index of the guard among those about its axis.
    pub guard: usize,
}
