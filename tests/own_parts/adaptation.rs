//! Custom adaptation: it adds a step to a gain of the law after each window, and ends the run beyond a limit.

use std::io;

use flexsc_core::control::adaptation::{Adaptation, AdaptationSpec, Decision, SearchStep};
use flexsc_core::control::custom::PartError;
use flexsc_core::control::part::Part;
use flexsc_core::numerics::random::Seed;
use flexsc_core::numerics::time::Instant;

/// Climber with its step, and its largest value.
#[derive(Copy, Clone, Debug)]
pub struct Climber {
    pub step: f64,
    pub most: f64,
}

/// Run-time state of the climber, with the value.
#[derive(Clone, Debug)]
struct Climbing(Climber, f64);

impl AdaptationSpec for Climber {
    fn tunes(&self) -> &'static str {
        "k_t"
    }

    fn start(&self, value: f64, _: Seed) -> Box<dyn Adaptation> {
        Box::new(Climbing(*self, value))
    }
}

impl Part for Climbing {
    fn failure(&self) -> Option<PartError> {
        (self.1 > self.0.most).then(|| PartError::new(io::Error::other("too far")))
    }
}

impl Adaptation for Climbing {
    fn learn(&mut self, _: Instant, _: f64) -> Option<SearchStep> {
        self.1 += self.0.step;
        Some(SearchStep { decision: Decision::Keep, change: 0.0, draw: 1.0, gain: self.1, settled: 0 })
    }

    fn copy(&self) -> Box<dyn Adaptation> {
        Box::new(self.clone())
    }
}
