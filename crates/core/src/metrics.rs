//! Metrics: what a run comes to, as named numbers with units.

use serde_json::{Map, Value as Json, json};

use crate::analysis::cycle::CycleWatch;
use crate::law::Phase;
use crate::record::{self, Record, RecordError, Sample};
use crate::scenario::Scenario;
use crate::time::{Instant, Span};

/// What a metric means.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct Meaning {
    /// Name.
    pub name: &'static str,
    /// Unit; empty for a count, a ratio or a word.
    pub unit: &'static str,
    /// What it tells.
    pub doc: &'static str,
}

/// The value of a metric.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A count.
    Count(u64),
    /// A number; NaN where there is none.
    Number(f64),
    /// Numbers.
    Numbers(Vec<f64>),
    /// A word.
    Word(&'static str),
}

/// Declares the metrics: a constant for each, and the list of all.
macro_rules! metrics {
    ($($constant:ident = $name:literal, $unit:literal, $doc:literal;)+) => {
        $(const $constant: Meaning = Meaning { name: $name, unit: $unit, doc: $doc };)+

        /// All metrics, in the order in which they are reported.
        pub const ALL: &[Meaning] = &[$($constant),+];
    };
}

metrics! {
    SWITCHINGS = "switchings", "", "Switchings of the law in the run";
    PUSHES_RIGHT = "pushes_right", "", "Strong pushes back from the right boundary of the dead zone";
    PUSHES_LEFT = "pushes_left", "", "Strong pushes back from the left boundary of the dead zone";
    DUTY = "duty", "", "Fraction of the run under strong torque";
    IMPULSE = "torque_impulse_per_hour_nm_s", "N m s",
        "Integral of the absolute torque per hour of the run; rad/s on a body without inertia";
    WINDOW_MEANS = "envelope_window_means_rad", "rad",
        "Mean of the total envelope over each whole window of the observer";
    ENVELOPE_MEAN = "envelope_mean_rad", "rad", "Mean of the total envelope over all whole windows";
    ENVELOPE_LATE = "envelope_late_mean_rad", "rad",
        "Mean of the total envelope over the windows that begin in the second half of the run";
    ENVELOPE_FINAL = "envelope_final_rad", "rad", "Mean of the total envelope over the last whole window";
    REDUCTION = "envelope_reduction", "",
        "How many times smaller envelope_final_rad is than the scenario's reference.envelope, or than the first window";
    GAIN_INITIAL = "gain_initial", "", "The law's tunable parameter at the start (k_t of the relay law)";
    GAIN_FINAL = "gain_final", "", "The law's tunable parameter at the end";
    GAIN_FROZEN_AT = "gain_frozen_at_s", "s", "When the adaptation froze the gain; null if it did not";
    GAIN_FROZEN = "gain_frozen", "", "The frozen gain; null if the adaptation did not freeze it";
    ENVELOPE_FROZEN = "envelope_frozen_rad", "rad",
        "Mean of the total envelope over the whole windows after the freeze (the last one, if it came at the end); null without a freeze";
    FROZEN_REDUCTION = "envelope_frozen_reduction", "",
        "How many times smaller envelope_frozen_rad is than what envelope_reduction compares with; null without a freeze";
    CYCLE_KIND = "cycle_kind", "",
        "The limit cycle at the end of the run: two-sided, one-sided, mixed, or none if the run is not periodic";
    CYCLE_PERIOD = "cycle_period_s", "s", "Period of that cycle; null without one";
    CYCLE_ORDER = "cycle_order", "", "Pushes from one boundary in each period; null without a cycle";
    CYCLE_SYMMETRIC = "cycle_symmetric", "",
        "1 if the cycle's second half mirrors its first, else 0; null without a cycle";
    CYCLE_DUTY = "cycle_duty", "", "Fraction of the cycle under strong torque; null without a cycle";
    CYCLE_IMPULSE = "cycle_impulse_per_hour_nm_s", "N m s",
        "Integral of the absolute torque per hour of that cycle; null without one";
    CYCLE_MULTIPLIERS = "cycle_multipliers", "",
        "Absolute values of the cycle's Floquet multipliers, largest first; empty without a cycle";
    CYCLE_MULTIPLIER_ARGUMENTS = "cycle_multiplier_arguments_rad", "rad",
        "Arguments of the same multipliers";
    CYCLE_MULTIPLIER_MAX = "cycle_multiplier_max", "",
        "Largest absolute value among the multipliers: below 1 the cycle attracts; null without a cycle";
}

/// The metrics of one run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Metrics(pub Vec<(&'static Meaning, Value)>);

impl Metrics {
    /// The value of a metric.
    pub fn get(&self, name: &str) -> Option<&Value> {
        self.0.iter().find(|(meaning, _)| meaning.name == name).map(|(_, value)| value)
    }

    /// The value of a metric that is a number or a count.
    pub fn number(&self, name: &str) -> Option<f64> {
        match self.get(name)? {
            Value::Number(number) => Some(*number),
            Value::Count(count) => Some(*count as f64),
            _ => None,
        }
    }

    /// The metrics as a JSON object. What is not a number is null.
    pub fn to_json(&self) -> Json {
        let object = self.0.iter().map(|(meaning, value)| (meaning.name.to_owned(), value.to_json()));
        Json::Object(object.collect::<Map<_, _>>())
    }

    /// The metrics as a log holds them.
    pub fn to_row(&self) -> record::Metrics {
        let mut metrics = Vec::new();
        for (meaning, value) in &self.0 {
            let mut push = |index: usize, value: f64, text: &str| {
                metrics.push(record::Metric {
                    name: meaning.name.to_owned(),
                    unit: meaning.unit.to_owned(),
                    index: index as u64,
                    value,
                    text: text.to_owned(),
                });
            };
            match value {
                Value::Count(count) => push(0, *count as f64, ""),
                Value::Number(number) => push(0, *number, ""),
                Value::Word(word) => push(0, f64::NAN, word),
                Value::Numbers(numbers) => {
                    numbers.iter().enumerate().for_each(|(index, number)| push(index, *number, ""));
                }
            }
        }
        record::Metrics { metrics }
    }
}

impl Value {
    /// The value as JSON; NaN is null.
    pub fn to_json(&self) -> Json {
        match self {
            Self::Count(count) => json!(count),
            Self::Number(number) => json!(number),
            Self::Numbers(numbers) => json!(numbers),
            Self::Word(word) => json!(word),
        }
    }
}

/// Gathers the metrics of a run.
#[derive(Clone, Debug)]
pub struct Gather {
    duration: f64,
    reference: Option<f64>,
    switchings: u64,
    pushes: (u64, u64),
    strong: Span,
    impulse: f64,
    /// When the torque was switched last, to what, and whether it is strong.
    since: (Instant, f64, bool),
    means: Vec<f64>,
    windows_from: Vec<f64>,
    gain: (f64, f64),
    frozen_at: f64,
    cycle: CycleWatch,
    observed: bool,
    adapted: bool,
}

impl Gather {
    /// An empty gathering for runs of a scenario.
    pub fn new(scenario: &Scenario) -> Self {
        let smooth = scenario.sensor.period().is_none();
        Self {
            duration: scenario.duration.seconds(),
            reference: scenario.reference.envelope.map(crate::quantity::Positive::get),
            switchings: 0,
            pushes: (0, 0),
            strong: Span::ZERO,
            impulse: 0.0,
            since: (Instant::START, 0.0, false),
            means: Vec::new(),
            windows_from: Vec::new(),
            gain: (f64::NAN, f64::NAN),
            frozen_at: f64::NAN,
            cycle: CycleWatch::new(&scenario.model, smooth),
            observed: scenario.estimator.is_some(),
            adapted: scenario.adaptation.is_some(),
        }
    }

    /// The metrics of the run that has ended.
    pub fn finish(mut self, scenario: &Scenario) -> Metrics {
        self.switch(Instant::START + scenario.duration, 0.0, false);
        let hours = self.duration / 3600.0;
        let mut metrics = vec![
            (&SWITCHINGS, Value::Count(self.switchings)),
            (&PUSHES_RIGHT, Value::Count(self.pushes.0)),
            (&PUSHES_LEFT, Value::Count(self.pushes.1)),
            (&DUTY, Value::Number(self.strong.seconds() / self.duration)),
            (&IMPULSE, Value::Number(self.impulse / hours)),
        ];
        if self.observed {
            metrics.extend(self.envelope());
        }
        metrics.push((&GAIN_INITIAL, Value::Number(self.gain.0)));
        metrics.push((&GAIN_FINAL, Value::Number(self.gain.1)));
        metrics.push((&GAIN_FROZEN_AT, Value::Number(self.frozen_at)));
        if self.adapted {
            metrics.extend(self.frozen());
        }
        metrics.extend(cycle_metrics(self.cycle));
        Metrics(metrics)
    }

    fn envelope(&self) -> Vec<(&'static Meaning, Value)> {
        let late = self.windows_from.iter().position(|from| *from >= 0.5 * self.duration);
        let late = late.map_or(&[][..], |first| &self.means[first..]);
        let first = self.means.first().copied().unwrap_or(f64::NAN);
        let last = self.means.last().copied().unwrap_or(f64::NAN);
        vec![
            (&WINDOW_MEANS, Value::Numbers(self.means.clone())),
            (&ENVELOPE_MEAN, Value::Number(mean(&self.means))),
            (&ENVELOPE_LATE, Value::Number(mean(late))),
            (&ENVELOPE_FINAL, Value::Number(last)),
            (&REDUCTION, Value::Number(self.reference.unwrap_or(first) / last)),
        ]
    }

    fn frozen(&self) -> [(&'static Meaning, Value); 3] {
        let first = self.means.first().copied().unwrap_or(f64::NAN);
        let after = self.windows_from.iter().position(|from| *from >= self.frozen_at);
        let (gain, level) = match (self.frozen_at.is_nan(), after) {
            (true, _) => (f64::NAN, f64::NAN),
            (false, Some(after)) => (self.gain.1, mean(&self.means[after..])),
            (false, None) => (self.gain.1, self.means.last().copied().unwrap_or(f64::NAN)),
        };
        [
            (&GAIN_FROZEN, Value::Number(gain)),
            (&ENVELOPE_FROZEN, Value::Number(level)),
            (&FROZEN_REDUCTION, Value::Number(self.reference.unwrap_or(first) / level)),
        ]
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
        self.pushes.0 += u64::from(phase == Phase::RightPush);
        self.pushes.1 += u64::from(phase == Phase::LeftPush);
        self.switch(now, torque, phase.is_strong());
    }
}

fn mean(values: &[f64]) -> f64 {
    // 0 / 0 where there are none: a mean of nothing is not a number.
    values.iter().sum::<f64>() / values.len() as f64
}

fn cycle_metrics(watch: CycleWatch) -> Vec<(&'static Meaning, Value)> {
    let cycle = watch.cycle();
    let cycle = cycle.as_ref();
    let number = |value: Option<f64>| Value::Number(value.unwrap_or(f64::NAN));
    let multipliers = cycle.map_or(&[][..], |c| &c.multipliers);
    let impulse = cycle.map(|c| c.impulse / c.period * 3600.0);
    vec![
        (&CYCLE_KIND, Value::Word(cycle.map_or("none", |c| c.kind.word()))),
        (&CYCLE_PERIOD, number(cycle.map(|c| c.period))),
        (&CYCLE_ORDER, number(cycle.map(|c| c.order as f64))),
        (&CYCLE_SYMMETRIC, number(cycle.map(|c| f64::from(u8::from(c.symmetric))))),
        (&CYCLE_DUTY, number(cycle.map(|c| c.duty))),
        (&CYCLE_IMPULSE, number(impulse)),
        (&CYCLE_MULTIPLIERS, Value::Numbers(multipliers.iter().map(|m| m.0).collect())),
        (&CYCLE_MULTIPLIER_ARGUMENTS, Value::Numbers(multipliers.iter().map(|m| m.1).collect())),
        (&CYCLE_MULTIPLIER_MAX, number(multipliers.first().map(|m| m.0))),
    ]
}

impl Record for Gather {
    fn record(&mut self, now: Instant, sample: Sample<'_>) -> Result<(), RecordError> {
        match sample {
            Sample::Begin(law) => {
                self.gain = (law.gain, law.gain);
                self.enter(now, law.state, law.torque_nm);
            }
            Sample::Switching(command, _) => {
                self.switchings += 1;
                self.enter(now, command.state, command.torque_nm);
                self.cycle.record(now, sample)?;
            }
            Sample::Window(window) => {
                self.means.push(window.mean_rad);
                self.windows_from.push(window.from_s);
            }
            Sample::Adaptation(step) => {
                self.gain.1 = step.gain;
                if step.decision == crate::adaptation::Decision::Freeze {
                    self.frozen_at = now.seconds();
                }
            }
            Sample::Motion(_) | Sample::Law(_) => {}
        }
        Ok(())
    }
}
