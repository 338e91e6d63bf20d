//! Metrics of star trackers with exclusion angles: the time for which each is blinded.

use flexsc_record::{BlindingEvent, Onset};

use super::{MetricValue, NamedMetric, TRACKER_BLINDED};
use flexsc_scenario::Scenario;

/// Collector of the events of all star trackers with exclusion angles.
#[derive(Clone, Debug)]
pub struct BlindingMetrics {
    trackers: Vec<BlindedTime>,
    end: f64,
}

/// Time for which a star tracker is blinded.
#[derive(Copy, Clone, Debug)]
struct BlindedTime {
    /// Index among the sensors.
    sensor: u64,
    /// Number of bodies that blind it, and the time (s) since which there is one.
    bodies: u32,
    since: f64,
    /// Sum of the times before (s).
    sum: f64,
}

impl BlindingMetrics {
    /// Creates an empty collector for runs of a scenario.
    pub fn new(scenario: &Scenario) -> Self {
        let unblinded =
            |sensor: usize| BlindedTime { sensor: sensor as u64, bodies: 0, since: 0.0, sum: 0.0 };
        Self {
            trackers: scenario.sensor.exclusions().map(|(index, ..)| unblinded(index)).collect(),
            end: scenario.duration.seconds(),
        }
    }

    /// Observes an event.
    pub fn observe(&mut self, event: &BlindingEvent) {
        let Some(of) = self.trackers.iter_mut().find(|of| of.sensor == event.sensor) else { return };
        if event.onset == Onset::Begins {
            if of.bodies == 0 {
                of.since = event.time_s;
            }
            of.bodies += 1;
        } else {
            of.bodies = of.bodies.saturating_sub(1);
            if of.bodies == 0 {
                of.sum += event.time_s - of.since;
            }
        }
    }

    /// Returns the metrics of the run that has ended.
    pub fn finish(&self) -> Option<NamedMetric> {
        let time = |of: &BlindedTime| if of.bodies > 0 { of.sum + (self.end - of.since) } else { of.sum };
        let times: Vec<f64> = self.trackers.iter().map(time).collect();
        (!times.is_empty()).then_some((&TRACKER_BLINDED, MetricValue::Numbers(times)))
    }
}
