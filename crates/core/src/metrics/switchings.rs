//! Metrics of a relay law's switchings: pushes, impulse, envelope, adaptation, limit cycle.

use flexsc_control::adaptation::Objective;
use flexsc_control::law::{Phase, Setpoint};
use flexsc_dynamics::axis_model::AxisModel;
use flexsc_dynamics::{AxisState, MotionPiece};
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::{Adaptation, Command, PieceDemand, Record, RecordError, Sample};

use super::envelope::EnvelopeMetrics;
use super::goal::GoalMetrics;
use super::{
    CYCLE_DUTY, CYCLE_IMPULSE, CYCLE_KIND, CYCLE_MULTIPLIER_ARGUMENTS, CYCLE_MULTIPLIER_MAX,
    CYCLE_MULTIPLIERS, CYCLE_ORDER, CYCLE_PERIOD, CYCLE_REDUCED_IMPULSE, CYCLE_SYMMETRIC, DUTY,
    ENVELOPE_FROZEN, FROZEN_REDUCTION, GAIN_FINAL, GAIN_FROZEN, GAIN_FROZEN_AT, GAIN_INITIAL, IMPULSE,
    MetricDescription, MetricValue, NamedMetric, PUSHES_LEFT, PUSHES_RIGHT, REDUCED_IMPULSE, SWITCHINGS,
    Selection,
};
use flexsc_analysis::limit_cycle::LimitCycleDetector;
use flexsc_scenario::Scenario;
use flexsc_scenario::metric_descriptions::OF_GOAL;

/// Collector of the switchings of a relay law, of window means and of the adaptation's steps.
#[derive(Clone, Debug)]
pub struct RelayMetrics {
    duration: f64,
    count: u64,
    pushes: (u64, u64),
    strong: Span,
    impulse: f64,
    /// Time of the last switching, its torque, and true if that is strong.
    since: (Instant, f64, bool),
    windows: EnvelopeMetrics,
    gain: (f64, f64),
    /// Initial value of the gain that the adaptation tunes.
    tuned: Option<f64>,
    frozen_at: f64,
    cycle: LimitCycleDetector,
    observed: bool,
    adapted: bool,
    /// True if torques are accelerations.
    reduced: bool,
    goal: Setpoint,
    verdict: GoalMetrics,
    wanted: WantedMetrics,
}

/// Groups of these metrics that are wanted.
#[derive(Copy, Clone, Debug)]
struct WantedMetrics {
    cycle: bool,
    verdict: bool,
    /// True if counts, duty or impulse are wanted.
    counts: bool,
}

/// Metrics of the limit cycle.
const OF_CYCLE: &[MetricDescription] = &[
    CYCLE_KIND,
    CYCLE_PERIOD,
    CYCLE_ORDER,
    CYCLE_SYMMETRIC,
    CYCLE_DUTY,
    CYCLE_IMPULSE,
    CYCLE_MULTIPLIERS,
    CYCLE_MULTIPLIER_ARGUMENTS,
    CYCLE_MULTIPLIER_MAX,
];

/// Metrics of the switchings without those of the cycle.
const COUNTED: &[MetricDescription] = &[SWITCHINGS, PUSHES_RIGHT, PUSHES_LEFT, DUTY, IMPULSE];

impl RelayMetrics {
    /// Creates an empty collector for runs of a scenario.
    pub fn new(scenario: &Scenario, body: &AxisModel, selection: &Selection) -> Self {
        // Multipliers are defined for uncoupled modes only.
        let smooth = scenario.study.sample_period.is_none() && scenario.linear.is_none();
        Self {
            duration: scenario.duration.seconds(),
            count: 0,
            pushes: (0, 0),
            strong: Span::ZERO,
            impulse: 0.0,
            since: (Instant::START, 0.0, false),
            windows: EnvelopeMetrics::new(scenario),
            gain: (f64::NAN, f64::NAN),
            tuned: scenario.tuned_parameter(),
            frozen_at: f64::NAN,
            cycle: LimitCycleDetector::new(body, smooth),
            observed: scenario.estimator.as_ref().is_some_and(|estimator| estimator.envelope().is_some()),
            adapted: scenario.objective() == Some(Objective::EnvelopeMean),
            reduced: body.commands_acceleration(),
            goal: scenario.goal(),
            verdict: GoalMetrics::new(
                scenario.goal().from.seconds(),
                scenario.expected_band().band(f64::NAN),
            ),
            wanted: WantedMetrics {
                cycle: selection.wants_any(OF_CYCLE),
                verdict: selection.wants_any(OF_GOAL),
                counts: selection.wants_any(COUNTED),
            },
        }
    }

    /// Returns the metrics of the run that has ended.
    pub fn finish(mut self, scenario: &Scenario) -> Vec<NamedMetric> {
        self.switch(Instant::START + scenario.duration, 0.0, false);
        let hours = self.duration / 3600.0;
        let mut metrics = vec![
            (&SWITCHINGS, MetricValue::Count(self.count)),
            (&PUSHES_RIGHT, MetricValue::Count(self.pushes.0)),
            (&PUSHES_LEFT, MetricValue::Count(self.pushes.1)),
            (&DUTY, MetricValue::Number(self.strong.seconds() / self.duration)),
            (
                if self.reduced { &REDUCED_IMPULSE } else { &IMPULSE },
                MetricValue::Number(self.impulse / hours),
            ),
        ];
        if self.observed {
            metrics.extend(self.windows.finish());
        }
        metrics.push((&GAIN_INITIAL, MetricValue::Number(self.gain.0)));
        metrics.push((&GAIN_FINAL, MetricValue::Number(self.gain.1)));
        metrics.push((&GAIN_FROZEN_AT, MetricValue::Number(self.frozen_at)));
        if self.adapted {
            metrics.extend(self.frozen());
        }
        metrics.extend(limit_cycle_metrics(self.cycle, self.reduced));
        metrics.extend(self.verdict.finish(self.duration));
        metrics
    }

    fn frozen(&self) -> [NamedMetric; 3] {
        let level = if self.frozen_at.is_nan() {
            f64::NAN
        } else {
            self.windows.mean_since(self.frozen_at).unwrap_or(self.windows.last_mean())
        };
        let gain = if self.frozen_at.is_nan() { f64::NAN } else { self.gain.1 };
        [
            (&GAIN_FROZEN, MetricValue::Number(gain)),
            (&ENVELOPE_FROZEN, MetricValue::Number(level)),
            (&FROZEN_REDUCTION, MetricValue::Number(self.windows.reference_mean() / level)),
        ]
    }

    /// Observes a switching, with the body in this state.
    pub fn observe_switching(&mut self, now: Instant, command: &Command, state: &AxisState) {
        self.count += 1;
        self.enter(now, command.state, command.torque_nm);
        if self.wanted.cycle {
            self.cycle.observe(now, command, state);
        }
    }

    fn switch(&mut self, now: Instant, torque: f64, strong: bool) {
        let (from, before, was_strong) = self.since;
        let span = now.since(from);
        self.impulse += before.abs() * span.seconds();
        if was_strong {
            self.strong = self.strong + span;
        }
        self.since = (now, torque, strong);
    }

    fn enter(&mut self, now: Instant, phase: Phase, torque: f64) {
        self.pushes.0 += u64::from(phase == Phase::PushFromRight);
        self.pushes.1 += u64::from(phase == Phase::PushFromLeft);
        self.switch(now, torque, phase.is_strong());
    }
}

fn limit_cycle_metrics(watch: LimitCycleDetector, reduced: bool) -> Vec<NamedMetric> {
    let cycle = watch.cycle();
    let cycle = cycle.as_ref();
    let number = |value: Option<f64>| MetricValue::Number(value.unwrap_or(f64::NAN));
    let multipliers = cycle.map_or(&[][..], |c| &c.multipliers);
    let impulse = cycle.map(|c| c.impulse / c.period * 3600.0);
    vec![
        (&CYCLE_KIND, MetricValue::Word(cycle.map_or("none", |c| c.kind.word()))),
        (&CYCLE_PERIOD, number(cycle.map(|c| c.period))),
        (&CYCLE_ORDER, number(cycle.map(|c| c.order as f64))),
        (&CYCLE_SYMMETRIC, number(cycle.map(|c| f64::from(u8::from(c.symmetric))))),
        (&CYCLE_DUTY, number(cycle.map(|c| c.duty))),
        (if reduced { &CYCLE_REDUCED_IMPULSE } else { &CYCLE_IMPULSE }, number(impulse)),
        (&CYCLE_MULTIPLIERS, MetricValue::Numbers(multipliers.iter().map(|m| m.0).collect())),
        (&CYCLE_MULTIPLIER_ARGUMENTS, MetricValue::Numbers(multipliers.iter().map(|m| m.1).collect())),
        (&CYCLE_MULTIPLIER_MAX, number(multipliers.first().map(|m| m.0))),
    ]
}

impl Record for RelayMetrics {
    fn wants_switchings(&self) -> bool {
        self.wanted.counts || self.wanted.cycle
    }

    fn piece_demand(&self) -> PieceDemand {
        if !self.wanted.verdict {
            return PieceDemand::None;
        }
        // For a goal of 0 from the start on, bounds of the angle show most motions to be inside the band.
        if self.goal == Setpoint::default() {
            PieceDemand::Beyond(self.verdict.band())
        } else {
            PieceDemand::All
        }
    }

    fn piece(&mut self, _: Instant, piece: &MotionPiece) -> Result<(), RecordError> {
        let since = piece.from - self.goal.from.seconds();
        let start = self.goal.angle + self.goal.rate * since;
        let distance = piece.angle.minus_line(start, self.goal.rate * piece.length);
        self.verdict.observe(piece.from, piece.length, &distance);
        Ok(())
    }

    fn record(&mut self, now: Instant, sample: Sample<'_>) -> Result<(), RecordError> {
        match sample {
            Sample::Begin(law) => {
                let gain = self.tuned.unwrap_or(law.gain);
                self.gain = (gain, gain);
                self.enter(now, law.state, law.torque_nm);
            }
            Sample::Switching(command, state) => self.observe_switching(now, command, state),
            Sample::Row(_) | Sample::Report(_) => {
                if let Some(window) = sample.get() {
                    self.windows.observe(window);
                }
                if let Some(step) = sample.get::<Adaptation>() {
                    self.gain.1 = step.gain;
                    if step.decision == flexsc_control::adaptation::Decision::Freeze {
                        self.frozen_at = now.seconds();
                    }
                }
            }
        }
        Ok(())
    }
}
