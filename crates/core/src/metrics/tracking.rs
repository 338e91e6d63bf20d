//! Metrics of adaptive observers, from their state at the end of a run, and of active damping.

use flexsc_record::{TrackedMode, Tracking, Watch};

use super::{
    DAMPING_CYCLES, DAMPING_PAUSES, FREQUENCY_ERRORS, FREQUENCY_ESTIMATES, INFLUENCE_ERRORS,
    INFLUENCE_ESTIMATES, MetricValue, NamedMetric, TRACKING_ERROR,
};
use flexsc_scenario::Scenario;

/// Collector of the cycles of a run.
#[derive(Clone, Debug, Default)]
pub struct ObserverMetrics {
    last: Option<Vec<TrackedMode>>,
    /// Sum of the squared errors of the elastic rates (rad²/s²), and the number of cycles.
    square: (f64, u64),
    cycles: u64,
    pauses: u64,
    resting: [bool; 3],
}

impl ObserverMetrics {
    /// Creates an empty collector for runs of a scenario.
    pub fn new(scenario: &Scenario) -> Self {
        Self { last: scenario.has_adaptive_observers().then(Vec::new), ..Self::default() }
    }

    /// Returns true if the scenario has adaptive observers.
    pub fn has_observers(&self) -> bool {
        self.last.is_some()
    }

    /// Records a cycle.
    pub fn observe(&mut self, tracking: &Tracking) {
        let error =
            |channel: &flexsc_record::ChannelState| channel.elastic_rad_s - channel.true_elastic_rad_s;
        self.square.0 += tracking.channels.iter().map(|channel| error(channel) * error(channel)).sum::<f64>();
        self.square.1 += 1;
        self.cycles += u64::from(tracking.channels.iter().any(|channel| channel.damping_on_s != 0.0));
        for (resting, channel) in self.resting.iter_mut().zip(&tracking.channels) {
            let rests = channel.resting == Watch::Resting;
            self.pauses += u64::from(rests && !*resting);
            *resting = rests;
        }
        self.last.get_or_insert_default().clone_from(&tracking.trackers);
    }

    /// Returns the metrics of the run that has ended; empty without an adaptive observer.
    pub fn finish(self) -> Vec<NamedMetric> {
        let Some(last) = self.last else { return Vec::new() };
        let list = |value_of: &dyn Fn(&TrackedMode) -> f64| {
            MetricValue::Numbers(last.iter().map(value_of).collect())
        };
        vec![
            (&FREQUENCY_ESTIMATES, list(&|of| of.frequency_rad_s / std::f64::consts::TAU)),
            (&FREQUENCY_ERRORS, list(&|of| of.frequency_rad_s / of.true_frequency_rad_s - 1.0)),
            (&INFLUENCE_ESTIMATES, list(&|of| of.influence)),
            (&INFLUENCE_ERRORS, list(&|of| of.influence / of.true_influence - 1.0)),
            (&TRACKING_ERROR, MetricValue::Number(f64::sqrt(self.square.0 / self.square.1 as f64))),
            (&DAMPING_CYCLES, MetricValue::Count(self.cycles)),
            (&DAMPING_PAUSES, MetricValue::Count(self.pauses)),
        ]
    }
}
