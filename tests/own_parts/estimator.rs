//! Custom estimator: an alpha-beta filter of angle and rate about each axis, which logs its innovations.

use std::sync::Arc;

use flexsc_core::control::custom::Custom;
use flexsc_core::control::estimator::{
    Estimator, EstimatorContext, EstimatorKind, EstimatorSpec, SampleContext,
};
use flexsc_core::control::part::{Occasion, Part, ReportContext};
use flexsc_core::control::state_estimate::StateEstimate;
use flexsc_core::numerics::random::Seed;
use flexsc_core::numerics::time::Instant;
use flexsc_core::record::{CustomField, CustomTopic, Report};

/// Gains by which an innovation corrects angle and rate.
#[derive(Clone, Debug)]
pub struct AlphaBeta {
    pub alpha: f64,
    pub beta: f64,
    /// Topic of the innovations.
    topic: Arc<CustomTopic>,
}

/// Run-time state of the filter: angle (rad) and rate (rad/s) about each axis after the last sample, its time, and the
/// innovation about the first axis (rad).
#[derive(Clone, Debug)]
struct Filtering(AlphaBeta, Vec<[f64; 2]>, Option<Instant>, f64);

impl AlphaBeta {
    /// Creates the estimator.
    pub fn kind(alpha: f64, beta: f64) -> EstimatorKind {
        let field = CustomField::new("innovation", "rad", "Innovation about the first axis.");
        let topic = CustomTopic::new("/alpha_beta", "Filter of angle and rate.", vec![field]);
        let topic = topic.expect("a topic");
        let topics = vec![Arc::clone(&topic)];
        EstimatorKind::Own(Custom::with_topics(Arc::new(Self { alpha, beta, topic }), topics))
    }
}

impl EstimatorSpec for AlphaBeta {
    fn start(&self, known: &EstimatorContext<'_>, _: Seed) -> Box<dyn Estimator> {
        Box::new(Filtering(self.clone(), vec![[0.0; 2]; known.axes.len()], None, 0.0))
    }
}

impl Part for Filtering {
    fn report(&self, at: &ReportContext<'_>, report: &mut Report) {
        if at.occasion == Occasion::Sample {
            report.add(self.0.topic.row([self.3]).expect("one value"));
        }
    }
}

impl Estimator for Filtering {
    fn update(&mut self, taken: &SampleContext<'_>, beliefs: &mut [StateEstimate]) {
        let Self(gains, states, last, first) = self;
        let Some(measured) = taken.measured else { return };
        let since = last.replace(taken.now).map(|last| taken.now.since(last).seconds());
        for (axis, ((state, measured), belief)) in states.iter_mut().zip(measured).zip(beliefs).enumerate() {
            if let Some(h) = since {
                let predicted = state[0] + h * state[1];
                let innovation = measured[0] - predicted;
                *state = [predicted + gains.alpha * innovation, state[1] + gains.beta * innovation / h];
                if axis == 0 {
                    *first = innovation;
                }
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
