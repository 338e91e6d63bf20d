//! A motion that is computed elsewhere, beside those of other runs: when it begins anew, and under what.

use crate::time::Instant;

/// The motion as its body knows it.
#[derive(Clone, Debug)]
pub struct Elsewhere {
    mobility: f64,
    departed: Option<(Instant, f64)>,
}

impl Elsewhere {
    /// That of a body that a unit of torque accelerates so (1/(kg m²)).
    pub fn new(mobility: f64) -> Self {
        Self { mobility, departed: None }
    }

    /// It begins anew under a constant input (N m).
    pub fn depart(&mut self, now: Instant, input: f64) {
        self.departed = Some((now, input * self.mobility));
    }

    /// When it began anew, and its reduced moment (rad/s²); none since this was asked last.
    pub fn departed(&mut self) -> Option<(Instant, f64)> {
        self.departed.take()
    }
}
