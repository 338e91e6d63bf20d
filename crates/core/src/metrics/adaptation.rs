//! Metrics of an adaptation: its objective over the windows, and the gain that it tunes.

use flexsc_control::adaptation::{Decision, Objective};
use flexsc_numerics::time::Instant;
use flexsc_record::{self, Sample};

use super::{
    GAIN_FINAL, GAIN_FROZEN, GAIN_FROZEN_AT, GAIN_INITIAL, MetricDescription, MetricValue, NamedMetric,
    OBJECTIVE_FINAL, OBJECTIVE_INITIAL, OBJECTIVE_LATE, OBJECTIVE_WINDOWS,
};
use flexsc_scenario::Scenario;

/// Descriptions of the objective's metrics, for each unit of an objective.
static UNITS: [[MetricDescription; 4]; 6] =
    [in_unit(""), in_unit("rad"), in_unit("rad/s"), in_unit("N m"), in_unit("rad/s²"), in_unit("W")];

const fn in_unit(unit: &'static str) -> [MetricDescription; 4] {
    [
        MetricDescription { unit, ..OBJECTIVE_WINDOWS },
        MetricDescription { unit, ..OBJECTIVE_INITIAL },
        MetricDescription { unit, ..OBJECTIVE_LATE },
        MetricDescription { unit, ..OBJECTIVE_FINAL },
    ]
}

/// Returns the descriptions of the objective's metrics in a scenario; `None` without an objective other than the
/// envelope.
pub fn descriptions(scenario: &Scenario) -> Option<&'static [MetricDescription; 4]> {
    let objective = scenario.objective().filter(|objective| *objective != Objective::EnvelopeMean)?;
    let unit = objective.unit(scenario.torque_unit());
    UNITS.iter().find(|meanings| meanings[0].unit == unit)
}

/// Collector of an objective's windows and of the steps of the adaptation.
#[derive(Clone, Debug)]
pub struct AdaptationMetrics {
    /// Descriptions of the metrics of an objective other than the envelope.
    meanings: Option<&'static [MetricDescription; 4]>,
    /// True if this collector reports the tuned gain, because no other one does.
    gains: bool,
    duration: f64,
    /// Start of each window (s), and the objective over it.
    windows: Vec<(f64, f64)>,
    gain: [f64; 2],
    frozen_at: f64,
}

impl AdaptationMetrics {
    /// Creates an empty collector for runs of a scenario; `None` without an adaptation.
    pub fn new(scenario: &Scenario) -> Option<Self> {
        let gain = scenario.tuned_parameter()?;
        Some(Self {
            meanings: descriptions(scenario),
            gains: scenario.axis_count() == 3 || !scenario.law.is_switching(),
            duration: scenario.duration.seconds(),
            windows: Vec::new(),
            gain: [gain; 2],
            frozen_at: f64::NAN,
        })
    }

    /// Records an objective's window or a step of the adaptation.
    pub fn observe(&mut self, now: Instant, sample: Sample<'_>) {
        if let Some(row) = sample.get::<flexsc_record::Objective>() {
            self.windows.push((row.from_s, row.value));
        }
        if let Some(step) = sample.get::<flexsc_record::Adaptation>() {
            self.gain[1] = step.gain;
            if step.decision == Decision::Freeze {
                self.frozen_at = now.seconds();
            }
        }
    }

    /// Returns the metrics of the run that has ended.
    pub fn finish(self) -> Vec<NamedMetric> {
        let Self { windows, frozen_at, gain: [first, last], .. } = self;
        let mut metrics: Vec<NamedMetric> = Vec::new();
        if let Some([all, initial, late, end]) = self.meanings {
            let begun_late: Vec<f64> = windows
                .iter()
                .filter(|(from, _)| *from >= 0.5 * self.duration)
                .map(|(_, value)| *value)
                .collect();
            let value = |window: Option<&(f64, f64)>| {
                MetricValue::Number(window.map_or(f64::NAN, |(_, value)| *value))
            };
            metrics.extend([
                (all, MetricValue::Numbers(windows.iter().map(|(_, value)| *value).collect())),
                (initial, value(windows.first())),
                (late, MetricValue::Number(begun_late.iter().sum::<f64>() / begun_late.len() as f64)),
                (end, value(windows.last())),
            ]);
        }
        let frozen = (&GAIN_FROZEN, MetricValue::Number(if frozen_at.is_nan() { f64::NAN } else { last }));
        if self.gains {
            metrics.push((&GAIN_INITIAL, MetricValue::Number(first)));
            metrics.push((&GAIN_FINAL, MetricValue::Number(last)));
            metrics.push((&GAIN_FROZEN_AT, MetricValue::Number(frozen_at)));
            metrics.push(frozen);
        } else if self.meanings.is_some() {
            metrics.push(frozen);
        }
        metrics
    }
}
