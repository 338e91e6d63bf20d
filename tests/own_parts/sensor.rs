//! Custom sensor: an encoder that measures angles in whole steps, and no rates.

use flexsc_core::random::Seed;
use flexsc_core::sensor::{Instrument, Reading, Sense, Truth};
use flexsc_core::time::{Instant, Span};

/// Encoder with its step (rad) and its period (s).
#[derive(Copy, Clone, Debug)]
pub struct Encoder {
    pub step: f64,
    pub period: f64,
}

impl Instrument for Encoder {
    fn start(&self, _: usize, _: Seed) -> Box<dyn Sense> {
        Box::new(*self)
    }

    fn period(&self) -> Span {
        Span::from_seconds(self.period)
    }

    fn angle_noise(&self) -> f64 {
        self.step / 12.0_f64.sqrt()
    }
}

impl Sense for Encoder {
    fn read(&mut self, _: Instant, truth: &Truth, _: Option<&Reading>) -> Option<Reading> {
        let steps = truth.seen().map(|angle| (angle / self.step).round() * self.step);
        Some(Reading { at: truth.orientation.at(steps), rate: None, sight: None })
    }

    fn copy(&self) -> Box<dyn Sense> {
        Box::new(*self)
    }
}
