//! Metrics of the modes of operation.

use flexsc_numerics::time::{Instant, Span};
use flexsc_record::ModeEvent;

use super::{MODE_CHANGES, MODE_STARTS, MODE_TIMES, MODE_VISITS, MetricValue, NamedMetric};
use flexsc_scenario::Scenario;

/// Collector of the changes of the mode.
#[derive(Clone, Debug)]
pub struct ModeMetrics {
    /// Time in each mode before the current one.
    times: Vec<Span>,
    /// First start of each mode (s); NaN before.
    starts: Vec<f64>,
    /// Number of starts of each mode.
    visits: Vec<f64>,
    changes: u64,
    /// Index and start of the current mode.
    current: Option<(usize, Instant)>,
    end: Instant,
}

impl ModeMetrics {
    /// Creates an empty collector; `None` for a scenario without modes.
    pub fn new(scenario: &Scenario) -> Option<Self> {
        let count = scenario.mode.len();
        (count > 0).then(|| Self {
            times: vec![Span::ZERO; count],
            starts: vec![f64::NAN; count],
            visits: vec![0.0; count],
            changes: 0,
            current: None,
            end: Instant::START + scenario.duration,
        })
    }

    /// Observes the start of a mode.
    pub fn observe(&mut self, now: Instant, event: &ModeEvent) {
        self.changes += u64::from(self.current.is_some());
        self.close(now);
        let index = event.index as usize;
        self.current = Some((index, now));
        self.visits.get_mut(index).into_iter().for_each(|visits| *visits += 1.0);
        if let Some(start) = self.starts.get_mut(index).filter(|start| start.is_nan()) {
            *start = now.seconds();
        }
    }

    /// Adds the time in the current mode up to an instant.
    fn close(&mut self, now: Instant) {
        if let Some((index, from)) = self.current
            && let Some(time) = self.times.get_mut(index)
        {
            *time = *time + now.since(from);
        }
    }

    /// Returns the metrics at the end of the run.
    pub fn finish(mut self) -> [NamedMetric; 4] {
        self.close(self.end);
        let times = self.times.into_iter().map(Span::seconds).collect();
        [
            (&MODE_TIMES, MetricValue::Numbers(times)),
            (&MODE_STARTS, MetricValue::Numbers(self.starts)),
            (&MODE_VISITS, MetricValue::Numbers(self.visits)),
            (&MODE_CHANGES, MetricValue::Count(self.changes)),
        ]
    }
}
