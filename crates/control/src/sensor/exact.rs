//! Ideal sensor: the exact motion.

use super::{Reading, Sense, Truth};
use crate::time::Instant;

/// Ideal sensor of orientation and rates, at every instant.
#[derive(Copy, Clone, Debug)]
pub(super) struct Exact;

impl Sense for Exact {
    fn read(&mut self, _: Instant, truth: &Truth, _: Option<&Reading>) -> Option<Reading> {
        Some(Reading { at: truth.orientation.at(truth.seen()), rate: Some(truth.rate), sight: None })
    }

    fn copy(&self) -> Box<dyn Sense> {
        Box::new(*self)
    }
}
