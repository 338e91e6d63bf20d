//! Custom estimator: an alpha-beta filter of angle and rate about each axis.

use flexsc_core::control::estimator::{Estimator, EstimatorContext, EstimatorSpec, SampleContext};
use flexsc_core::control::state_estimate::StateEstimate;
use flexsc_core::numerics::random::Seed;
use flexsc_core::numerics::time::Instant;

/// Gains by which an innovation corrects angle and rate.
#[derive(Copy, Clone, Debug)]
pub struct AlphaBeta {
    pub alpha: f64,
    pub beta: f64,
}

/// Run-time state of the filter: angle (rad) and rate (rad/s) about each axis after the last sample.
#[derive(Clone, Debug)]
struct Filtering(AlphaBeta, Vec<[f64; 2]>, Option<Instant>);

impl EstimatorSpec for AlphaBeta {
    fn start(&self, known: &EstimatorContext<'_>, _: Seed) -> Box<dyn Estimator> {
        Box::new(Filtering(*self, vec![[0.0; 2]; known.axes.len()], None))
    }
}

impl Estimator for Filtering {
    fn update(&mut self, taken: &SampleContext<'_>, beliefs: &mut [StateEstimate]) {
        let Self(gains, states, last) = self;
        let Some(measured) = taken.measured else { return };
        let since = last.replace(taken.now).map(|last| taken.now.since(last).seconds());
        for ((state, measured), belief) in states.iter_mut().zip(measured).zip(beliefs) {
            if let Some(h) = since {
                let predicted = state[0] + h * state[1];
                let innovation = measured[0] - predicted;
                *state = [predicted + gains.alpha * innovation, state[1] + gains.beta * innovation / h];
            } else {
                *state = *measured;
            }
            [belief.angle, belief.rate] = *state;
        }
    }

    fn copy(&self) -> Box<dyn Estimator> {
        Box::new(self.clone())
    }
}
