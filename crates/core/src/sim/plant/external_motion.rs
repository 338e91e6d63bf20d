//! Segment starts of a motion that a batch computes.

use flexsc_numerics::time::Instant;

/// Interface to a motion that a batch computes.
#[derive(Clone, Debug)]
pub struct ExternalSegment {
    mobility: f64,
    departed: Option<(Instant, f64)>,
}

impl ExternalSegment {
    /// Creates it for a body with the given acceleration per unit of torque (1/(kg m²)).
    pub fn new(mobility: f64) -> Self {
        Self { mobility, departed: None }
    }

    /// Begins a motion segment under a constant input (N m).
    pub fn depart(&mut self, now: Instant, input: f64) {
        self.departed = Some((now, input * self.mobility));
    }

    /// Returns the start of the last segment and its reduced moment (rad/s²), once per segment; `None` since the last
    /// call.
    pub fn departed(&mut self) -> Option<(Instant, f64)> {
        self.departed.take()
    }
}
