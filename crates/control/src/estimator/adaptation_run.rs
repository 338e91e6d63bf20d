//! Run-time state of an adaptation, with the law's parameter that it tunes.

use flexsc_numerics::random::Seed;
use flexsc_numerics::time::Instant;

use crate::adaptation::{Adaptation, AdaptationKind};
use crate::part::Part;

/// Run-time state of an adaptation and the current value of its parameter.
#[derive(Clone, Debug)]
pub struct AdaptationRun {
    search: Box<dyn Adaptation>,
    /// Key of the law's parameter that the adaptation tunes.
    key: String,
    /// Current value of the parameter.
    value: f64,
}

impl AdaptationRun {
    /// Creates the run-time state of an adaptation whose parameter starts at `value`.
    pub fn new(adaptation: &AdaptationKind, value: f64, seed: Seed) -> Self {
        Self { search: adaptation.start(value, seed), key: adaptation.tunes().to_owned(), value }
    }

    /// Updates the adaptation with the objective's value over the window that ends at `now`. Returns its step and the
    /// parameter before it.
    pub fn learn(
        &mut self,
        now: Instant,
        window: u64,
        measured: f64,
    ) -> Option<(flexsc_record::Adaptation, f64)> {
        let step = self.search.learn(now, measured)?;
        let row = flexsc_record::Adaptation {
            window,
            decision: step.decision,
            change: step.change,
            draw: step.draw,
            gain: step.gain,
            settled: u64::from(step.settled),
        };
        Some((row, std::mem::replace(&mut self.value, step.gain)))
    }

    /// Returns the key and the value of the tuned parameter.
    pub fn parameter(&self) -> (&str, f64) {
        (&self.key, self.value)
    }

    /// Returns the adaptation as a part of the run.
    pub fn part(&self) -> &dyn Part {
        &*self.search
    }
}
