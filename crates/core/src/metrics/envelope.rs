//! Metrics of the envelope over windows, for runs whose law is not the relay law of a one-axis body.

use flexsc_record::WindowMean;

use super::{
    ENVELOPE_FINAL, ENVELOPE_LATE, ENVELOPE_MEAN, MetricDescription, MetricValue, NamedMetric, REDUCTION,
    WINDOW_MEANS,
};
use flexsc_scenario::Scenario;

/// Descriptions of the metrics.
pub const METRICS: &[MetricDescription] =
    &[WINDOW_MEANS, ENVELOPE_MEAN, ENVELOPE_LATE, ENVELOPE_FINAL, REDUCTION];

/// Collector of the means of the envelope's windows.
#[derive(Clone, Debug)]
pub struct EnvelopeMetrics {
    duration: f64,
    reference: Option<f64>,
    means: Vec<f64>,
    from: Vec<f64>,
}

impl EnvelopeMetrics {
    /// Creates an empty collector for runs of a scenario.
    pub fn new(scenario: &Scenario) -> Self {
        Self {
            duration: scenario.duration.seconds(),
            reference: scenario.reference.envelope.map(flexsc_numerics::quantity::Positive::get),
            means: Vec::new(),
            from: Vec::new(),
        }
    }

    /// Creates an empty collector; `None` if a scenario has no monitor, or if another collector records it.
    pub fn if_not_collected_elsewhere(scenario: &Scenario) -> Option<Self> {
        let observed = scenario.estimator.as_ref().is_some_and(|estimator| estimator.envelope().is_some());
        let relay = scenario.axis_count() == 1 && scenario.law.is_switching();
        (observed && !relay).then(|| Self::new(scenario))
    }

    /// Records a window.
    pub fn observe(&mut self, window: &WindowMean) {
        self.means.push(window.mean_rad);
        self.from.push(window.from_s);
    }

    /// Returns the mean over the windows that begin at `from` (s) or later; `None` without any.
    pub fn mean_since(&self, from: f64) -> Option<f64> {
        let first = self.from.iter().position(|begins| *begins >= from)?;
        Some(mean(&self.means[first..]))
    }

    /// Returns the mean over the last window; NaN without one.
    pub fn last_mean(&self) -> f64 {
        self.means.last().copied().unwrap_or(f64::NAN)
    }

    /// Returns the value with which the envelope is compared: the reference, or the first window.
    pub fn reference_mean(&self) -> f64 {
        self.reference.unwrap_or(self.means.first().copied().unwrap_or(f64::NAN))
    }

    /// Returns the metrics of the run that has ended.
    pub fn finish(&self) -> [NamedMetric; 5] {
        let late = self.mean_since(0.5 * self.duration).unwrap_or(f64::NAN);
        [
            (&WINDOW_MEANS, MetricValue::Numbers(self.means.clone())),
            (&ENVELOPE_MEAN, MetricValue::Number(mean(&self.means))),
            (&ENVELOPE_LATE, MetricValue::Number(late)),
            (&ENVELOPE_FINAL, MetricValue::Number(self.last_mean())),
            (&REDUCTION, MetricValue::Number(self.reference_mean() / self.last_mean())),
        ]
    }
}

fn mean(values: &[f64]) -> f64 {
    // Without values the mean is 0/0: NaN.
    values.iter().sum::<f64>() / values.len() as f64
}
