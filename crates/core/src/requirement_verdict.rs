//! Verdicts on the requirements of a scenario, over one run or the runs of a campaign.

use flexsc_formats::count::counted;
use flexsc_formats::document::{ConfigError, nearest};
use flexsc_formats::reader_units::{percent, percent_against};
use serde::Serialize;
use serde_json::{Value as Json, json};

use crate::metrics::{MetricValue, Metrics, MetricsCollector, is_not_exercised};
use crate::statistics::wilson;
use flexsc_numerics::order_statistics::{confidence, order_rank, order_statistic, runs_needed};
use flexsc_scenario::{AssessedRequirement, Interpretation, RequirementSource, Scenario};

/// Part of a level by which a mean of shares may be below it because of rounding.
const ROUNDING: f64 = 1e-12;

/// Verdict on a requirement.
#[derive(Clone, Debug, PartialEq)]
pub struct RequirementVerdict {
    /// Requirement.
    pub requirement: AssessedRequirement,
    /// Decision.
    pub decision: Decision,
    /// Value that is compared with the limit; NaN without one, and for the mixed interpretation of several runs, which
    /// compares the share.
    pub value: f64,
    /// Mean over the runs of the share of values within the limit; NaN if a run has no value.
    pub share: f64,
    /// Number of runs in which something was to meet the requirement.
    pub runs: u64,
    /// Number of runs whose own value is within the limit.
    pub runs_met: u64,
    /// Number of runs that end before they decide.
    pub runs_undecided: u64,
    /// Number of runs in which nothing was to meet the requirement; `runs` does not count them.
    pub runs_not_exercised: u64,
    /// Confidence of a level below 1 of the ensemble.
    pub confidence: Option<Confidence>,
    /// Run with the largest value, or the first one without a value: its number, and the value.
    pub worst: (u64, f64),
}

/// Decision on a requirement.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Decision {
    /// Value within the limit, with the wanted confidence.
    Met,
    /// Value within the limit, by too few runs for the wanted confidence; over time, a run that ends too early.
    Undecided,
    /// Value beyond the limit, or no value.
    Missed,
    /// No run in which anything was to meet the requirement.
    NotExercised,
}

impl Decision {
    /// Returns the word of the decision.
    pub fn word(self) -> &'static str {
        match self {
            Self::Met => "met",
            Self::Undecided => "undecided",
            Self::Missed => "missed",
            Self::NotExercised => "not exercised",
        }
    }

    /// True if the requirement is missed or undecided.
    pub fn fails(self) -> bool {
        matches!(self, Self::Missed | Self::Undecided)
    }

    /// Returns the mark of the decision before a line.
    pub fn mark(self) -> &'static str {
        match self {
            Self::Met => "✓",
            Self::Undecided => "?",
            Self::Missed => "✗",
            Self::NotExercised => "-",
        }
    }
}

/// Confidence in a level of the ensemble (Clopper-Pearson, one-sided).
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Confidence {
    /// Confidence that the runs give.
    pub reached: f64,
    /// Confidence that is wanted; `None` if none is.
    pub wanted: Option<f64>,
    /// Number of runs that give the wanted confidence if as many runs exceed the limit; of no wanted one, `None`.
    pub runs_needed: Option<u64>,
}

/// Values of the requirements of runs.
#[derive(Clone, Debug, Default)]
pub struct RequirementRuns {
    requirements: Vec<AssessedRequirement>,
    /// Numbers of the runs.
    runs: Vec<u64>,
    /// Values and shares of each requirement, one of each run.
    values: Vec<Vec<f64>>,
    shares: Vec<Vec<f64>>,
    /// Number of runs in which something was to meet each requirement, and of those that do not.
    counts: Vec<[u64; 2]>,
    /// True for a run that failed.
    failed: Vec<bool>,
}

impl RequirementRuns {
    /// Creates an empty collector for runs of a scenario.
    pub fn new(scenario: &Scenario) -> Self {
        let requirements = scenario.study.requirements.clone();
        let empty = vec![Vec::new(); requirements.len()];
        let counts = vec![[0; 2]; requirements.len()];
        Self {
            requirements,
            runs: Vec::new(),
            values: empty.clone(),
            shares: empty,
            counts,
            failed: Vec::new(),
        }
    }

    /// Returns the values of a requirement, one of each run.
    pub fn values(&self, requirement: usize) -> &[f64] {
        &self.values[requirement]
    }

    /// True if the run in a row meets a requirement, or nothing in it was to meet it.
    pub fn is_met(&self, requirement: usize, row: usize) -> bool {
        self.values[requirement][row] <= self.requirements[requirement].limit
            || self.is_not_exercised(requirement, row)
    }

    /// True if nothing in the run in a row was to meet a requirement.
    fn is_not_exercised(&self, requirement: usize, row: usize) -> bool {
        is_not_exercised(self.values[requirement][row], self.shares[requirement][row])
    }

    /// Returns the runs in the rows that are wanted.
    #[must_use]
    pub fn in_rows(&self, is_wanted: impl Fn(usize) -> bool) -> Self {
        let empty = vec![Vec::new(); self.values.len()];
        let mut own = Self {
            requirements: self.requirements.clone(),
            counts: vec![[0; 2]; empty.len()],
            values: empty.clone(),
            shares: empty,
            ..Self::default()
        };
        for row in (0..self.runs.len()).filter(|row| is_wanted(*row)) {
            let in_row = |all: &[Vec<f64>]| all.iter().map(|list| list[row]).collect::<Vec<f64>>();
            let values = if self.failed[row] { Vec::new() } else { in_row(&self.values) };
            own.add_values(self.runs[row], &values, &in_row(&self.shares));
        }
        own
    }

    /// Returns the numbers of the runs.
    pub fn numbers(&self) -> &[u64] {
        &self.runs
    }

    /// Returns true if the scenario has no requirement.
    pub fn is_empty(&self) -> bool {
        self.requirements.is_empty()
    }

    /// Adds a run of this number by its metrics; one that failed has none.
    pub fn add(&mut self, run: u64, metrics: Option<&Metrics>) {
        let list =
            |name: &str| metrics.and_then(|run| run.get(name)).map_or_else(Vec::new, MetricValue::numbers);
        self.add_values(run, &list("requirement_values"), &list("requirement_shares"));
    }

    /// Adds a run of this number by the lists of its values and shares.
    pub fn add_values(&mut self, run: u64, values: &[f64], shares: &[f64]) {
        self.runs.push(run);
        self.failed.push(values.is_empty());
        let at = |list: &[f64], index: usize| list.get(index).copied().unwrap_or(f64::NAN);
        let each = self.values.iter_mut().zip(&mut self.shares);
        for (index, (of_values, of_shares)) in each.enumerate() {
            of_values.push(at(values, index));
            of_shares.push(at(shares, index));
        }
        let row = self.runs.len() - 1;
        for index in 0..self.counts.len() {
            let is_exercised = !self.is_not_exercised(index, row);
            self.counts[index][0] += u64::from(is_exercised);
            self.counts[index][1] += u64::from(!self.is_met(index, row));
        }
    }

    /// True if the runs that remain of a campaign of `total` cannot change whether it meets each requirement.
    pub fn are_decided(&self, total: u64) -> bool {
        let decided = |(index, requirement): (usize, &AssessedRequirement)| {
            let level = match requirement.interpretation {
                Interpretation::Mixed => return false,
                Interpretation::Temporal => 1.0,
                Interpretation::Ensemble => requirement.level,
            };
            let [runs, beyond] = self.counts[index];
            let remaining = total - self.runs.len() as u64;
            let all = runs + remaining;
            let holds = |beyond: u64| {
                let shown = |wanted: f64| confidence(level, beyond, all) >= wanted;
                beyond + order_rank(level, all) <= all
                    && (level == 1.0 || requirement.confidence.is_none_or(shown))
            };
            holds(beyond) == holds(beyond + remaining)
        };
        self.requirements.iter().enumerate().all(decided)
    }

    /// Returns the verdicts, in the order of the requirements; none without a run.
    pub fn finish(self) -> Vec<RequirementVerdict> {
        if self.runs.is_empty() {
            return Vec::new();
        }
        let each = self.requirements.into_iter().zip(self.values.into_iter().zip(self.shares));
        let runs = &self.runs;
        each.map(|(requirement, (values, shares))| {
            verdict(requirement, (runs, &self.failed), (values, &shares))
        })
        .collect()
    }
}

/// Checks that runs of a scenario have the metrics that its requirements limit.
///
/// # Errors
/// A requirement on a metric that they do not have.
pub fn validate_metrics(scenario: &Scenario) -> Result<(), ConfigError> {
    let metric = |requirement: &AssessedRequirement| match &requirement.source {
        RequirementSource::Metric(name, _) => Some((requirement.name.clone(), name.clone())),
        RequirementSource::Error(_) | RequirementSource::Formula(_) => None,
    };
    let mut limited = scenario.study.requirements.iter().filter_map(metric).peekable();
    if limited.peek().is_none() {
        return Ok(());
    }
    // A collector without samples has the metrics of a run.
    let known = MetricsCollector::new(scenario).finish(scenario);
    let Some((name, metric)) = limited.find(|(_, metric)| known.get(metric).is_none()) else { return Ok(()) };
    let names: Vec<&str> = known.0.iter().map(|(meaning, _)| meaning.name).collect();
    let hint =
        nearest(&metric, &names).map_or_else(String::new, |close| format!("; did you mean `{close}`?"));
    let why = format!("is a metric that runs of this scenario do not have, got `{metric}`{hint}");
    Err(ConfigError::new(scenario.requirement_key(&name), why))
}

/// Returns the verdicts on one run, of which no confidence is asked for.
pub fn run_verdicts(scenario: &Scenario, metrics: &Metrics) -> Vec<RequirementVerdict> {
    let mut runs = RequirementRuns::new(scenario);
    runs.requirements.iter_mut().for_each(|requirement| requirement.confidence = None);
    runs.add(0, Some(metrics));
    runs.finish()
}

fn verdict(
    requirement: AssessedRequirement,
    (numbers, failed): (&[u64], &[bool]),
    (values, shares): (Vec<f64>, &[f64]),
) -> RequirementVerdict {
    let (limit, level) = (requirement.limit, requirement.level);
    let all = values.len() as u64;
    let exercised: Vec<usize> =
        (0..values.len()).filter(|row| !is_not_exercised(values[*row], shares[*row])).collect();
    let of = |list: &[f64]| exercised.iter().map(|row| list[*row]).collect::<Vec<f64>>();
    let (mut values, shares) = (of(&values), of(shares));
    let numbers: Vec<u64> = exercised.iter().map(|row| numbers[*row]).collect();
    let failed: Vec<bool> = exercised.iter().map(|row| failed[*row]).collect();
    let runs = values.len() as u64;
    let is_timed = matches!(requirement.source, RequirementSource::Formula(_));
    let is_undecided = |(value, failed): (&f64, &bool)| is_timed && value.is_nan() && !failed;
    let undecided = values.iter().zip(&failed).filter(|own| is_undecided(*own)).count() as u64;
    // The values if all runs that end too early meet the limit.
    let decided = values.iter().zip(&failed).map(|own| if is_undecided(own) { limit } else { *own.0 });
    let mut decided: Vec<f64> =
        decided.map(|value| if value.is_nan() { f64::INFINITY } else { value }).collect();
    decided.sort_by(f64::total_cmp);
    let runs_met = values.iter().filter(|value| **value <= limit).count() as u64;
    let share = shares.iter().sum::<f64>() / runs as f64;
    let mut worst = (0, if runs == 0 { f64::NAN } else { f64::NEG_INFINITY });
    for (number, value) in numbers.iter().zip(&values) {
        // A run without a value is the worst.
        if *value > worst.1 || value.is_nan() && !f64::is_nan(worst.1) {
            worst = (*number, *value);
        }
    }
    // A run without a value is beyond every limit.
    values.iter_mut().filter(|value| value.is_nan()).for_each(|value| *value = f64::INFINITY);
    values.sort_by(f64::total_cmp);
    let (value, is_within) = match requirement.interpretation {
        Interpretation::Mixed if runs > 1 => (f64::NAN, share >= level * (1.0 - ROUNDING)),
        _ if runs == 0 => (f64::NAN, false),
        Interpretation::Ensemble => {
            let value = order_statistic(&values, level);
            (value, value <= limit)
        }
        Interpretation::Temporal | Interpretation::Mixed => {
            let value = order_statistic(&values, 1.0);
            (value, value <= limit)
        }
    };
    let has_level = requirement.interpretation == Interpretation::Ensemble && level < 1.0;
    let confidence = has_level.then(|| Confidence {
        reached: confidence(level, runs - runs_met, runs),
        wanted: requirement.confidence,
        runs_needed: requirement.confidence.map(|wanted| runs_needed(level, wanted, runs - runs_met)),
    });
    let is_shown = confidence.is_none_or(|shown| shown.wanted.is_none_or(|wanted| shown.reached >= wanted));
    let decision = match (is_within, is_shown) {
        (true, true) => Decision::Met,
        (true, false) => Decision::Undecided,
        _ if runs == 0 => Decision::NotExercised,
        _ if undecided > 0 && order_statistic(&decided, level) <= limit => Decision::Undecided,
        (false, _) => Decision::Missed,
    };
    let value = if value.is_finite() { value } else { f64::NAN };
    RequirementVerdict {
        requirement,
        decision,
        value,
        share,
        runs,
        runs_met,
        runs_undecided: undecided,
        runs_not_exercised: all - runs,
        confidence,
        worst,
    }
}

impl RequirementVerdict {
    /// Returns the 95 % interval of the probability that a run meets the requirement (Wilson).
    pub fn interval(&self) -> [f64; 2] {
        wilson(self.runs_met, self.runs).into()
    }

    /// Returns how many runs meet the requirement, of those in which something was to meet it, and how many are undecided.
    pub fn runs_met_text(&self) -> String {
        let idle = match self.runs_not_exercised {
            0 => String::new(),
            count => format!(", {count} not exercised"),
        };
        let open = match self.runs_undecided {
            0 => String::new(),
            count => format!(", {count} undecided"),
        };
        format!("{} of {}{open}{idle}", self.runs_met, self.runs)
    }

    /// Returns a line on the level of the ensemble or on the share of all values, if the requirement has one.
    pub fn note(&self) -> Option<String> {
        let Self { requirement, decision, value, share, confidence, .. } = self;
        let name = &requirement.name;
        let least = percent(requirement.level);
        if !value.is_finite() && share.is_finite() {
            return Some(format!(
                "{name}: within its limit for {} of all values, at least {least}",
                percent_against(*share, requirement.level)
            ));
        }
        let shown = confidence.as_ref()?;
        let mut text = format!(
            "{name}: {} at {least} of the runs; confidence {}",
            decision.word(),
            percent_against(shown.reached, shown.wanted.unwrap_or(1.0))
        );
        if let (Some(wanted), Some(needed)) = (shown.wanted, shown.runs_needed) {
            let wanted_part = percent(wanted);
            let more = if shown.reached >= wanted {
                format!(", at least {wanted_part}")
            } else if *decision == Decision::Missed {
                // More runs are no remedy.
                format!(", below {wanted_part}")
            } else {
                format!(", {} needed for {wanted_part}", counted(needed, "run"))
            };
            text.push_str(&more);
        }
        Some(text)
    }

    /// Returns the verdict as JSON, with null for NaN.
    pub fn to_json(&self) -> Json {
        let Self { requirement, decision, value, share, runs, runs_met, confidence, .. } = self;
        json!({
            "name": requirement.name,
            "verdict": decision.word(),
            "description": requirement.description(),
            "value": value,
            "limit": requirement.limit,
            "unit": requirement.unit,
            "level": requirement.level,
            "interpretation": requirement.interpretation.word(),
            "share": share,
            "runs": runs,
            "runs_met": runs_met,
            "runs_undecided": self.runs_undecided,
            "runs_not_exercised": self.runs_not_exercised,
            "interval": self.interval(),
            "confidence": confidence.map(|shown| shown.reached),
            "confidence_wanted": requirement.confidence,
            "runs_needed": confidence.and_then(|shown| shown.runs_needed),
        })
    }
}

#[cfg(test)]
mod tests;
