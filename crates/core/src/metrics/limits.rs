//! Metrics of actuators at their limits: shares, first times and times of the modes of operation, and losses of the target.

use flexsc_control::actuator::{LimitKind, LimitTime, Saturation, TargetLoss};
use flexsc_numerics::time::Instant;
use flexsc_record::Report;

use super::{
    ACTUATOR_END, GIMBAL_LIMIT_STARTS, GIMBAL_LIMIT_TIMES, JET_LIMIT_STARTS, JET_LIMIT_TIMES, LATE_SHARE,
    LOSS_BEFORE, LOSS_ERRORS, LOSS_LIMITS, LOSS_MODES, LOSS_STARTS, LOSS_TIMES, MOMENT_LIMIT_STARTS,
    MOMENT_LIMIT_TIMES, MOMENT_SHARE, MOMENTUM_LIMIT_STARTS, MOMENTUM_LIMIT_TIMES, MOMENTUM_SHARE,
    MetricDescription, MetricValue, NamedMetric, TARGET_LOSSES, TORQUE_LIMIT_STARTS, TORQUE_LIMIT_TIMES,
    TORQUE_SHARE, WHEEL_MOMENTUM, WHEEL_SPEED,
};
use flexsc_scenario::Scenario;

/// Largest number of losses that are listed.
const MOST_LOSSES: usize = 100;

/// Collector of the cycles with actuators at their limits.
#[derive(Clone, Debug)]
pub struct LimitMetrics {
    saturation: Saturation,
    end: Instant,
    /// First losses of the target, and the number of all.
    losses: Vec<TargetLoss>,
    count: u64,
}

impl LimitMetrics {
    /// Creates an empty collector for runs of a scenario.
    pub fn new(scenario: &Scenario) -> Self {
        let end = Instant::START + scenario.duration;
        Self { saturation: scenario.saturation(), end, losses: Vec::new(), count: 0 }
    }

    /// Observes the report of a cycle that begins now.
    pub fn observe(&mut self, now: Instant, report: &Report) {
        let loss = self.saturation.observe(now, report);
        self.add(loss);
    }

    fn add(&mut self, loss: Option<TargetLoss>) {
        self.count += u64::from(loss.is_some());
        self.losses.extend(loss.filter(|_| self.losses.len() < MOST_LOSSES));
    }

    /// Returns true if there are wheels.
    pub fn has_wheels(&self) -> bool {
        self.saturation.has_wheels()
    }

    /// Returns the metrics of the run that has ended.
    pub fn finish(mut self) -> Vec<NamedMetric> {
        let loss = self.saturation.close(self.end);
        self.add(loss);
        let mut metrics: Vec<NamedMetric> = Vec::new();
        let saturation = &self.saturation;
        if saturation.has_wheels() {
            let [speed, momentum] = saturation.peaks();
            metrics.push((&WHEEL_SPEED, MetricValue::Number(speed)));
            metrics.push((&WHEEL_MOMENTUM, MetricValue::Number(momentum)));
        }
        for kind in LimitKind::ALL {
            let share = descriptions(kind).0.zip(saturation.share(kind));
            metrics.extend(share.map(|(meaning, share)| (meaning, MetricValue::Number(share))));
        }
        if let Some(state) = saturation.end_state() {
            metrics.push((&ACTUATOR_END, MetricValue::Word(state.word())));
            metrics.push((&LATE_SHARE, MetricValue::Number(saturation.late_share())));
        }
        if saturation.limits().is_empty() {
            return metrics;
        }
        for kind in LimitKind::ALL.into_iter().filter(|kind| saturation.limits().has(*kind)) {
            let numbers = |number: fn(LimitTime) -> f64| saturation.times(kind).map(number).collect();
            let (_, [starts, times]) = descriptions(kind);
            let start = |time: LimitTime| time.start.map_or(f64::NAN, Instant::seconds);
            metrics.push((starts, MetricValue::Numbers(numbers(start))));
            metrics.push((times, MetricValue::Numbers(numbers(|time| time.time.seconds()))));
        }
        metrics.push((&TARGET_LOSSES, MetricValue::Count(self.count)));
        let numbers =
            |number: fn(&TargetLoss) -> f64| MetricValue::Numbers(self.losses.iter().map(number).collect());
        let limits = self.losses.iter().map(|loss| saturation.limits().name(loss.limit).to_owned());
        metrics.extend([
            (&LOSS_MODES, numbers(|loss| loss.mode as f64)),
            (&LOSS_LIMITS, MetricValue::Words(limits.collect())),
            (&LOSS_STARTS, numbers(|loss| loss.start.seconds())),
            (&LOSS_TIMES, numbers(|loss| loss.time.seconds())),
            (&LOSS_BEFORE, numbers(|loss| loss.error_before)),
            (&LOSS_ERRORS, numbers(|loss| loss.error)),
        ]);
        metrics
    }
}

/// Returns the metrics of a kind of limits: the share of the cycles, if there is one, and the first time and the time there.
fn descriptions(kind: LimitKind) -> (Option<&'static MetricDescription>, [&'static MetricDescription; 2]) {
    match kind {
        LimitKind::Torque => (Some(&TORQUE_SHARE), [&TORQUE_LIMIT_STARTS, &TORQUE_LIMIT_TIMES]),
        LimitKind::Momentum => (Some(&MOMENTUM_SHARE), [&MOMENTUM_LIMIT_STARTS, &MOMENTUM_LIMIT_TIMES]),
        LimitKind::Moment => (Some(&MOMENT_SHARE), [&MOMENT_LIMIT_STARTS, &MOMENT_LIMIT_TIMES]),
        LimitKind::OnTime => (None, [&JET_LIMIT_STARTS, &JET_LIMIT_TIMES]),
        LimitKind::GimbalRate => (None, [&GIMBAL_LIMIT_STARTS, &GIMBAL_LIMIT_TIMES]),
    }
}
