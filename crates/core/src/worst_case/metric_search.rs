//! Worst case of a metric or of a requirement, by runs.

use std::sync::Arc;

use flexsc_formats::document::{ConfigError, ScenarioError, nearest};

use super::box_search::{Assessed, BoxSearch};
use super::{UncertainKey, WorstCase, WorstCaseFault, uncertain_box};
use crate::campaign::{Campaign, CampaignRun, RunError};
use crate::metrics::{self, Metrics, Selection, is_not_exercised, list_element, metric_value};
use flexsc_scenario::Scenario;
use flexsc_scenario::metric_descriptions;

/// Quantity of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RunQuantity {
    /// Metric by its name, or element `NAME[i]` of a list; of a list without an index, the largest element.
    Metric(String),
    /// Requirement by its name: the value that is compared with its limit.
    Requirement(String),
}

/// Search for the worst value of a quantity of runs.
#[derive(Clone, Debug)]
pub struct MetricSearch {
    /// Quantity.
    pub quantity: RunQuantity,
    /// True if small values are bad.
    pub is_least: bool,
    /// Largest number of runs.
    pub most_runs: usize,
    /// Number of threads; 0 for one per core.
    pub threads: usize,
    /// Values of the uncertain keys at the points from which the search starts; none: points spread over the ranges.
    pub starts: Vec<Vec<f64>>,
}

/// Quantity that was looked up in a scenario.
enum Looked {
    Metric { name: String, element: Option<usize>, unit: String },
    Requirement { index: usize, name: String, unit: String },
}

impl Looked {
    fn new(quantity: &RunQuantity, scenario: &Scenario) -> Result<Self, WorstCaseFault> {
        match quantity {
            RunQuantity::Metric(text) => {
                // The selection refuses what is no metric.
                Selection::from_names([text]).map_err(WorstCaseFault::Request)?;
                let (name, element) =
                    list_element(text).map_or((text.as_str(), None), |(list, index)| (list, Some(index)));
                if metric_descriptions::is_word(name) {
                    return Err(WorstCaseFault::Request(format!(
                        "metric `{name}` is a word: it has no worst value"
                    )));
                }
                let unit =
                    metrics::meaning(name, Some(scenario)).map_or_else(String::new, |of| of.unit.to_owned());
                Ok(Self::Metric { name: name.to_owned(), element, unit })
            }
            RunQuantity::Requirement(name) => {
                let all = &scenario.study.requirements;
                let Some(index) = all.iter().position(|requirement| requirement.name == *name) else {
                    let names: Vec<&str> = all.iter().map(|requirement| requirement.name.as_str()).collect();
                    let hint = nearest(name, &names).map_or_else(
                        || {
                            if names.is_empty() {
                                "it has none".to_owned()
                            } else {
                                format!("it has {}", names.join(", "))
                            }
                        },
                        |close| format!("did you mean `{close}`?"),
                    );
                    return Err(WorstCaseFault::Request(format!(
                        "the scenario has no requirement `{name}`\n\nhint: {hint}"
                    )));
                };
                Ok(Self::Requirement { index, name: name.clone(), unit: all[index].unit.to_owned() })
            }
        }
    }

    fn name(&self) -> String {
        match self {
            Self::Metric { name, element: None, .. } | Self::Requirement { name, .. } => name.clone(),
            Self::Metric { name, element: Some(index), .. } => format!("{name}[{index}]"),
        }
    }

    fn unit(&self) -> &str {
        match self {
            Self::Metric { unit, .. } | Self::Requirement { unit, .. } => unit,
        }
    }

    /// Returns the metrics that the value needs.
    fn selection(&self) -> Selection {
        match self {
            Self::Metric { name, .. } => Selection::from_names([name]).unwrap_or(Selection::ALL),
            Self::Requirement { .. } => Selection::from_names([""; 0]).unwrap_or(Selection::ALL),
        }
    }

    fn value(&self, metrics: &Metrics) -> f64 {
        match self {
            Self::Metric { name, element, .. } => metric_value(metrics, name, *element),
            Self::Requirement { index, .. } => {
                let element = |name: &str| metric_value(metrics, name, Some(*index));
                let value = element(metric_descriptions::REQUIREMENT_VALUES.name);
                // A run in which nothing was to meet the requirement is the best.
                let share = element(metric_descriptions::REQUIREMENT_SHARES.name);
                if is_not_exercised(value, share) { f64::NEG_INFINITY } else { value }
            }
        }
    }

    /// Returns the value of a run, with the badness of one that is missing: a requirement is missed without a value.
    fn assessed(&self, value: f64, is_least: bool) -> Assessed {
        let badness = match self {
            Self::Requirement { .. } if value.is_nan() => f64::INFINITY,
            _ if is_least => -value,
            _ => value,
        };
        Assessed { badness, value }
    }
}

impl MetricSearch {
    /// Searches for the worst value over the uncertain keys of a scenario. `work` simulates one run for some metrics, on
    /// any thread; `interrupted` returns true to stop the search.
    ///
    /// # Errors
    /// A quantity that the scenario does not have, a scenario without uncertain keys, no run with a value, and an
    /// interruption.
    pub fn run(
        &self,
        scenario: &Scenario,
        origin: &str,
        work: impl Fn(&CampaignRun, &Selection) -> Result<Metrics, RunError> + Clone + Send + Sync + 'static,
        mut interrupted: impl FnMut() -> bool,
    ) -> Result<WorstCase, WorstCaseFault> {
        let looked = Looked::new(&self.quantity, scenario)?;
        let ranges = uncertain_box(scenario)?;
        let selection = looked.selection();
        let (mut failed, mut first_failure) = (0, None);
        let mut assess = |points: &[Vec<f64>]| -> Result<Vec<Assessed>, WorstCaseFault> {
            let numbers = points
                .iter()
                .map(|parts| ranges.keys.iter().zip(parts).map(|(own, part)| own.number_at(*part)).collect());
            let campaign = Arc::new(Campaign::at_points(scenario, origin, numbers.collect())?);
            let mut assessed = Vec::with_capacity(points.len());
            let (simulate, wanted) = (work.clone(), selection.clone());
            let simulate = move |run: &CampaignRun| simulate(run, &wanted);
            campaign.for_each_run_in_batches(
                0..points.len() as u64,
                self.threads,
                &selection,
                simulate,
                |outcome| {
                    if interrupted() {
                        return Err(WorstCaseFault::Interrupted);
                    }
                    let Some(outcome) = outcome else { return Ok(()) };
                    let value = match &outcome.metrics {
                        Ok(metrics) => looked.value(metrics),
                        Err(error) => {
                            first_failure.get_or_insert_with(|| error.to_string());
                            f64::NAN
                        }
                    };
                    failed += usize::from(value.is_nan());
                    assessed.push(looked.assessed(value, self.is_least));
                    Ok(())
                },
            )?;
            Ok(assessed)
        };
        let search = BoxSearch { keys: ranges.keys.len(), most: self.most_runs, seed: scenario.seed };
        let own: Vec<f64> = ranges.keys.iter().map(UncertainKey::nominal_fraction).collect();
        let parts = |values: &Vec<f64>| {
            ranges.keys.iter().zip(values).map(|(own, value)| own.fraction(*value)).collect()
        };
        let starts = self.starts.iter().map(parts).collect();
        let (points, worst) = search.run(own.clone(), starts, &mut assess)?;
        let Some(worst) = worst else {
            let reason = first_failure.map_or_else(String::new, |why| format!(": {why}"));
            return Err(WorstCaseFault::Request(format!(
                "{} has no value in any run{reason}",
                looked.name()
            )));
        };
        let at_worst =
            ranges.keys.iter().zip(&points[worst].parts).map(|(own, part)| own.number_at(*part)).collect();
        let witness = Campaign::at_points(scenario, origin, vec![at_worst])?.run(0)?.scenario;
        Ok(WorstCase {
            quantity: looked.name(),
            unit: looked.unit().to_owned(),
            is_least: self.is_least,
            ranges,
            points,
            worst,
            is_unstable: false,
            failed,
            first_failure,
            witness,
        })
    }
}

impl From<ScenarioError> for WorstCaseFault {
    fn from(error: ScenarioError) -> Self {
        Self::Scenario(error)
    }
}

impl From<ConfigError> for WorstCaseFault {
    fn from(fault: ConfigError) -> Self {
        Self::Key(fault)
    }
}
