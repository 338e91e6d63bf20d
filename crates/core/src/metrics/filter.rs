//! Metrics of a Kalman filter: its errors, and their consistency with its covariance (\[BarShalom01\]).

use flexsc_numerics::time::Instant;
use flexsc_record::{Estimate, Lock, Use};

use super::{
    FREQUENCY_ERROR_MAX, FREQUENCY_ERROR_RMS, LOCK_LOST, LOCK_LOST_AT, MetricDescription, MetricValue,
    NEES_MEAN, NIS_INSIDE, NIS_MEAN, NamedMetric,
};
use flexsc_scenario::Scenario;

/// Descriptions of the metrics.
pub(super) const METRICS: &[MetricDescription] =
    &[NEES_MEAN, NIS_MEAN, NIS_INSIDE, FREQUENCY_ERROR_RMS, FREQUENCY_ERROR_MAX, LOCK_LOST, LOCK_LOST_AT];

/// 95 % intervals of chi-square with one and with two degrees of freedom.
const INSIDE: [[f64; 2]; 2] =
    [[9.820_691_171_752_583e-4, 5.023_886_187_314_888], [0.050_635_615_968_579_8, 7.377_758_908_227_871]];

/// Collector of the samples of a filter.
#[derive(Clone, Debug)]
pub struct FilterMetrics {
    assess: [f64; 2],
    measurements: usize,
    /// Number of samples, and number of those that were not dropped.
    count: (u64, u64),
    nees: f64,
    nis: f64,
    inside: u64,
    square: f64,
    largest: f64,
    /// Time at which the filter lost lock (s); none while it has not.
    lost_at: Option<f64>,
}

impl FilterMetrics {
    /// Creates an empty collector for runs of a scenario; `None` without a filter.
    pub fn new(scenario: &Scenario) -> Option<Self> {
        let estimator = scenario.estimator.as_ref().filter(|estimator| estimator.filters_measurements())?;
        Some(Self {
            assess: estimator.assess(),
            measurements: 1 + usize::from(scenario.sensor.rate_noise(0).is_some()),
            count: (0, 0),
            nees: 0.0,
            nis: 0.0,
            inside: 0,
            square: 0.0,
            largest: 0.0,
            lost_at: None,
        })
    }

    /// Records the estimates of the filters of all axes at a sample.
    pub fn observe(&mut self, now: Instant, estimates: &[Estimate]) {
        let t = now.seconds();
        if estimates.iter().any(|estimate| estimate.lock == Lock::Lost) {
            self.lost_at.get_or_insert(t);
        } else {
            self.lost_at = None;
        }
        for estimate in estimates {
            self.judge(t, estimate);
        }
    }

    /// Returns true if estimates at time `t` (s) are assessed.
    pub fn is_assessed(&self, t: f64) -> bool {
        let [from, to] = self.assess;
        from <= t && t <= to
    }

    fn judge(&mut self, t: f64, estimate: &Estimate) {
        if !self.is_assessed(t) {
            return;
        }
        let error = (estimate.frequency_rad_s - estimate.true_frequency_rad_s).abs();
        self.count.0 += 1;
        self.nees += estimate.nees;
        self.square += error * error;
        self.largest = self.largest.max(error);
        if estimate.measured == Use::Used {
            let [low, high] = INSIDE[self.measurements - 1];
            self.count.1 += 1;
            self.nis += estimate.nis;
            self.inside += u64::from((low..=high).contains(&(estimate.nis * self.measurements as f64)));
        }
    }

    /// Returns the metrics of the run that has ended.
    pub fn finish(self) -> [NamedMetric; 7] {
        // Without samples the means are 0/0: NaN.
        let (all, measured) = (self.count.0 as f64, self.count.1 as f64);
        let largest = if self.count.0 > 0 { self.largest } else { f64::NAN };
        [
            (&NEES_MEAN, MetricValue::Number(self.nees / all)),
            (&NIS_MEAN, MetricValue::Number(self.nis / measured)),
            (&NIS_INSIDE, MetricValue::Number(self.inside as f64 / measured)),
            (&FREQUENCY_ERROR_RMS, MetricValue::Number(f64::sqrt(self.square / all))),
            (&FREQUENCY_ERROR_MAX, MetricValue::Number(largest)),
            (&LOCK_LOST, MetricValue::Count(u64::from(self.lost_at.is_some()))),
            (&LOCK_LOST_AT, MetricValue::Number(self.lost_at.unwrap_or(f64::NAN))),
        ]
    }
}
