//! The envelope over windows, of runs whose law is no relay of one angle.

use super::{
    ENVELOPE_FINAL, ENVELOPE_LATE, ENVELOPE_MEAN, Meaning, MetricValue, REDUCTION, Value, WINDOW_MEANS,
};
use crate::record::WindowMean;
use crate::scenario::Scenario;

/// What it tells.
pub const TOLD: &[Meaning] = &[WINDOW_MEANS, ENVELOPE_MEAN, ENVELOPE_LATE, ENVELOPE_FINAL, REDUCTION];

/// Gathers the means of the envelope's windows.
#[derive(Clone, Debug)]
pub struct Windows {
    duration: f64,
    reference: Option<f64>,
    means: Vec<f64>,
    from: Vec<f64>,
}

impl Windows {
    /// An empty gathering for runs of a scenario.
    pub fn new(scenario: &Scenario) -> Self {
        Self {
            duration: scenario.duration.seconds(),
            reference: scenario.reference.envelope.map(crate::quantity::Positive::get),
            means: Vec::new(),
            from: Vec::new(),
        }
    }

    /// An empty gathering for runs of a scenario whose monitor nothing else gathers.
    pub fn alone(scenario: &Scenario) -> Option<Self> {
        let observed = scenario.estimator.as_ref().is_some_and(|estimator| estimator.envelope().is_some());
        let relay = scenario.axis_count() == 1 && scenario.law.switches();
        (observed && !relay).then(|| Self::new(scenario))
    }

    /// Takes a window.
    pub fn see(&mut self, window: &WindowMean) {
        self.means.push(window.mean_rad);
        self.from.push(window.from_s);
    }

    /// The mean over the windows that begin from a time on (s), if there are any.
    pub fn since(&self, from: f64) -> Option<f64> {
        let first = self.from.iter().position(|begins| *begins >= from)?;
        Some(mean(&self.means[first..]))
    }

    /// The mean over the last window; NaN without one.
    pub fn last(&self) -> f64 {
        self.means.last().copied().unwrap_or(f64::NAN)
    }

    /// What the envelope is compared with: the reference, or the first window.
    pub fn reference(&self) -> f64 {
        self.reference.unwrap_or(self.means.first().copied().unwrap_or(f64::NAN))
    }

    /// The metrics of the run that has ended.
    pub fn finish(&self) -> [MetricValue; 5] {
        let late = self.since(0.5 * self.duration).unwrap_or(f64::NAN);
        [
            (&WINDOW_MEANS, Value::Numbers(self.means.clone())),
            (&ENVELOPE_MEAN, Value::Number(mean(&self.means))),
            (&ENVELOPE_LATE, Value::Number(late)),
            (&ENVELOPE_FINAL, Value::Number(self.last())),
            (&REDUCTION, Value::Number(self.reference() / self.last())),
        ]
    }
}

fn mean(values: &[f64]) -> f64 {
    // 0 / 0 where there are none: a mean of nothing is not a number.
    values.iter().sum::<f64>() / values.len() as f64
}
