//! An adaptation at work, with the number that it tunes.

use crate::adaptation::{Adaptation, Learn};
use crate::own::Halt;
use crate::random::Seed;
use crate::record;
use crate::time::Instant;

/// The adaptation at work.
#[derive(Clone, Debug)]
pub struct Searching {
    search: Box<dyn Learn>,
    /// The number of the law that it tunes.
    key: String,
    /// Its value.
    value: f64,
}

impl Searching {
    /// An adaptation in a run, of a number of the law that begins with this value.
    pub fn new(adaptation: &Adaptation, value: f64, seed: Seed) -> Self {
        Self { search: adaptation.start(value, seed), key: adaptation.tunes().to_owned(), value }
    }

    /// Learns what was measured over a window that ends now: its step, and the value before it.
    pub fn learn(&mut self, now: Instant, window: u64, measured: f64) -> Option<(record::Adaptation, f64)> {
        let step = self.search.learn(now, measured)?;
        let row = record::Adaptation {
            window,
            decision: step.decision,
            change: step.change,
            draw: step.draw,
            gain: step.gain,
            settled: u64::from(step.settled),
        };
        Some((row, std::mem::replace(&mut self.value, step.gain)))
    }

    /// The key of the number that it tunes, and its value.
    pub fn tunes(&self) -> (&str, f64) {
        (&self.key, self.value)
    }

    /// Why one from outside cannot go on.
    pub fn halted(&self) -> Option<Halt> {
        self.search.halted()
    }
}
