//! Metrics of requirements: the value of each, the fraction within its limit, and whether all are met.

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::time::Instant;
use flexsc_record::{LineOfSightSample, RequirementErrors, RequirementRobustness, RequirementScope};

use super::goal;
use super::pointing_index::{IndexStream, LargestValues};
use super::{
    MetricValue, Metrics, NamedMetric, NumberWithUnit, REQUIREMENT, REQUIREMENT_SHARES, REQUIREMENT_TIMES,
    REQUIREMENT_VALUES,
};
use flexsc_scenario::metric_descriptions;
use flexsc_scenario::{
    AssessedRequirement, ErrorAxis, Interpretation, RequirementSource, SampledError, SampledQuantity,
    Scenario,
};

/// Collector of the values of all requirements of a run.
#[derive(Clone, Debug)]
pub struct RequirementMetrics(Vec<RequirementValues>);

/// Values of a requirement.
#[derive(Clone, Debug)]
struct RequirementValues {
    unit: &'static str,
    limit: f64,
    source: ValueSource,
}

/// Origin of the values of a requirement.
#[derive(Clone, Debug)]
enum ValueSource {
    /// Metric by its name, with the index of an element, if one is named.
    Metric(String, Option<usize>),
    /// Values of a pointing index.
    Index(Box<IndexValues>),
    /// Robustness of an expression over time, once the run has ended, and its scale.
    Formula(Option<RequirementRobustness>, f64),
}

/// Pointing index of the sampled error of a requirement.
#[derive(Clone, Debug)]
pub struct ErrorStream {
    error: SampledError,
    stream: IndexStream,
    /// True while samples count.
    counts: bool,
}

impl ErrorStream {
    /// Creates a stream without samples.
    pub fn new(error: &SampledError) -> Self {
        Self { error: error.clone(), stream: IndexStream::new(error.index), counts: true }
    }

    /// Takes a sample of the error about the body's axes, and gives the values of the index that follow from it.
    pub fn push(&mut self, error: Vector, take: impl FnMut(Vector)) {
        if !self.counts {
            return;
        }
        let error = match self.error.axis {
            None => error,
            Some(ErrorAxis::X) => Vector::new(error.x, 0.0, 0.0),
            Some(ErrorAxis::Y) => Vector::new(0.0, error.y, 0.0),
            Some(ErrorAxis::Z) => Vector::new(0.0, 0.0, error.z),
        };
        self.stream.push(error, take);
    }

    /// Lets samples count from now on, or not; a window of the index holds samples that count one after another.
    pub fn set_counts(&mut self, counts: bool) {
        self.counts = counts;
        self.stream = IndexStream::new(self.error.index);
    }

    /// Returns true if a sample of a line of sight is one of the error.
    pub fn takes_line(&self, now: Instant, sample: &LineOfSightSample) -> bool {
        let SampledQuantity::LineOfSight(line, _) = &self.error.quantity else { return false };
        *line as u64 == sample.line && self.error.from <= now && now <= self.error.to
    }
}

/// Values of a pointing index.
#[derive(Clone, Debug)]
struct IndexValues {
    errors: ErrorStream,
    largest: LargestValues,
    /// Number of values within the limit.
    within: u64,
    /// All values, if they are kept: of one component with its sign, else the norm.
    all: Option<Vec<f64>>,
    /// True if the error has one component.
    is_component: bool,
}

impl IndexValues {
    fn new(requirement: &AssessedRequirement, error: &SampledError, is_component: bool) -> Self {
        // The ensemble takes the worst time of each run.
        let level = match requirement.interpretation {
            Interpretation::Ensemble => 1.0,
            Interpretation::Temporal | Interpretation::Mixed => requirement.level,
        };
        Self {
            errors: ErrorStream::new(error),
            largest: LargestValues::new(level, error.index.values(error.samples)),
            within: 0,
            all: None,
            is_component,
        }
    }

    /// Takes a sample of the error about the body's axes.
    fn push(&mut self, error: Vector, limit: f64) {
        let Self { errors, largest, within, all, is_component } = self;
        errors.push(error, |value| {
            let magnitude = value.norm();
            largest.add(magnitude);
            *within += u64::from(magnitude <= limit);
            if let Some(all) = all {
                // The other components are 0.
                all.push(if *is_component { value.sum() } else { magnitude });
            }
        });
    }
}

impl RequirementMetrics {
    /// Creates an empty collector for runs of a scenario.
    pub fn new(scenario: &Scenario) -> Self {
        let values = |requirement: &AssessedRequirement| RequirementValues {
            unit: requirement.unit,
            limit: requirement.limit,
            source: match &requirement.source {
                RequirementSource::Metric(name, element) => ValueSource::Metric(name.clone(), *element),
                RequirementSource::Error(error) => ValueSource::Index(Box::new(IndexValues::new(
                    requirement,
                    error,
                    error.is_component(scenario.axis_count()),
                ))),
                RequirementSource::Formula(formula) => ValueSource::Formula(None, formula.scale),
            },
        };
        Self(scenario.study.requirements.iter().map(values).collect())
    }

    /// Returns true if the scenario has no requirements.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Returns the collector with all values of the indices kept.
    #[must_use]
    pub fn with_all_values(mut self) -> Self {
        for values in &mut self.0 {
            if let ValueSource::Index(values) = &mut values.source {
                values.all = Some(Vec::new());
            }
        }
        self
    }

    /// Returns the values of the index of each requirement that are kept; empty for a metric.
    pub fn into_values(self) -> Vec<Vec<f64>> {
        let values = |source| match source {
            ValueSource::Index(values) => values.all.unwrap_or_default(),
            ValueSource::Metric(..) | ValueSource::Formula(..) => Vec::new(),
        };
        self.0.into_iter().map(|of| values(of.source)).collect()
    }

    /// Returns the metrics that are required.
    pub fn required_metrics(&self) -> impl Iterator<Item = &'static str> {
        let names = self.0.iter().filter_map(|values| match &values.source {
            ValueSource::Metric(name, _) => Some(name.as_str()),
            ValueSource::Index(_) | ValueSource::Formula(..) => None,
        });
        names.filter_map(|name| Some(metric_descriptions::meaning(name, None)?.name))
    }

    /// Records sampled errors.
    pub fn observe(&mut self, errors: &RequirementErrors) {
        for sampled in &errors.0 {
            if let Some(RequirementValues { source: ValueSource::Index(values), limit, .. }) =
                self.0.get_mut(sampled.requirement)
            {
                values.push(Vector::from(sampled.error), *limit);
            }
        }
    }

    /// Records that requirements begin or cease to count.
    pub fn observe_scopes(&mut self, scopes: &[RequirementScope]) {
        for scope in scopes {
            if let Some(RequirementValues { source: ValueSource::Index(values), .. }) =
                self.0.get_mut(scope.requirement)
            {
                values.errors.set_counts(scope.counts);
            }
        }
    }

    /// Records the robustness of the requirements over time.
    pub fn observe_robustness(&mut self, all: &[RequirementRobustness]) {
        for own in all {
            if let Some(RequirementValues { source: ValueSource::Formula(found, _), .. }) =
                self.0.get_mut(own.requirement)
            {
                *found = Some(*own);
            }
        }
    }

    /// Records a sample of a line of sight.
    pub fn observe_line(&mut self, now: Instant, sample: &LineOfSightSample) {
        for RequirementValues { source, limit, .. } in &mut self.0 {
            if let ValueSource::Index(values) = source
                && values.errors.takes_line(now, sample)
            {
                values.push(Vector::from_iterator(sample.axes.iter().map(|axis| axis.error_rad)), *limit);
            }
        }
    }

    /// Returns the metrics of the run that has ended, from its other metrics; empty without requirements.
    pub fn finish(self, metrics: &Metrics) -> Vec<NamedMetric> {
        if self.0.is_empty() {
            return Vec::new();
        }
        let (mut values, mut shares, mut times, mut is_met) = (Vec::new(), Vec::new(), Vec::new(), true);
        let has_formula = self.0.iter().any(|own| matches!(own.source, ValueSource::Formula(..)));
        for RequirementValues { unit, limit, source } in self.0 {
            let mut time = f64::NAN;
            let (value, share) = match source {
                ValueSource::Metric(name, element) => {
                    let value = metric_value(metrics, &name, element);
                    let share = if value.is_nan() { f64::NAN } else { f64::from(u8::from(value <= limit)) };
                    (value, share)
                }
                ValueSource::Index(values) => {
                    let count = values.largest.count();
                    let is_idle = count == 0 && values.errors.error.scope.is_some();
                    // Without values the share is 0/0: NaN.
                    let share = if is_idle { 1.0 } else { values.within as f64 / count as f64 };
                    (values.largest.finish(), share)
                }
                ValueSource::Formula(found, scale) => {
                    let (robustness, at) = found.map_or((None, f64::NAN), |own| (own.decided(), own.at));
                    match robustness {
                        Some(f64::INFINITY) => (f64::NAN, 1.0),
                        Some(robustness) => {
                            time = at;
                            (limit - robustness * scale, f64::from(u8::from(robustness >= 0.0)))
                        }
                        None => (f64::NAN, f64::NAN),
                    }
                }
            };
            // A value that is missing meets no limit, unless nothing in the run was to meet it.
            is_met &= value <= limit || is_not_exercised(value, share);
            times.push(time);
            values.push(NumberWithUnit { value, unit: unit.to_owned() });
            shares.push(share);
        }
        let mut all = vec![
            (&REQUIREMENT, MetricValue::Word(goal::word(is_met))),
            (&REQUIREMENT_VALUES, MetricValue::Quantities(values)),
            (&REQUIREMENT_SHARES, MetricValue::Numbers(shares)),
        ];
        if has_formula {
            all.push((&REQUIREMENT_TIMES, MetricValue::Numbers(times)));
        }
        all
    }
}

/// True if, by its value and share, nothing in a run was to meet a requirement.
pub fn is_not_exercised(value: f64, share: f64) -> bool {
    value.is_nan() && share == 1.0
}

/// Returns a metric, an element of a list, or its largest element; NaN if there is none.
pub fn metric_value(metrics: &Metrics, name: &str, element: Option<usize>) -> f64 {
    match (metrics.get(name), element) {
        (Some(MetricValue::Count(count)), None) => *count as f64,
        (Some(MetricValue::Number(number)), None) => *number,
        (Some(list @ (MetricValue::Numbers(_) | MetricValue::Quantities(_))), element) => {
            let list = list.numbers();
            match element {
                Some(index) => list.get(index).copied().unwrap_or(f64::NAN),
                None if list.iter().any(|value| value.is_nan()) => f64::NAN,
                None => list.into_iter().fold(f64::NAN, f64::max),
            }
        }
        _ => f64::NAN,
    }
}
