//! Values of the runs of a campaign: of its requirements, its goal and its uncertain keys.

use toml::Value;

use super::{Campaign, ColumnCells, ERROR, RUN, RowMaker};
use crate::metrics::{MetricDescription, Metrics, Selection, goal, meaning};
use crate::requirement_verdict::{RequirementRuns, RequirementVerdict};
use flexsc_scenario::ACTIVE_FAULT;

/// Name of the metric that says whether a run meets its goal.
const GOAL: &str = goal::NAMES[0];

/// Columns of requirements and the goal.
const COLUMNS: [&str; 5] = [RUN, ERROR, GOAL, "requirement_values", "requirement_shares"];

/// Metrics, apart from requirements and the goal, from which the answer of a campaign is made: warnings and modes of operation.
const ANSWER_METRICS: [&str; 22] = [
    "mode_times_s",
    "mode_visits",
    "angle_error_peak_rad",
    "spectral_radius",
    "wheel_momentum_limit_share",
    "actuator_end",
    "actuator_limit_late_share",
    "wheel_torque_limit_times_s",
    "wheel_momentum_limit_times_s",
    "moment_limit_times_s",
    "jet_limit_times_s",
    "gimbal_rate_limit_times_s",
    "target_losses",
    "target_loss_modes",
    "target_loss_limits",
    "target_loss_starts_s",
    "target_loss_times_s",
    "target_loss_errors_before_rad",
    "target_loss_errors_rad",
    "nees_mean",
    "nis_mean",
    "lock_lost_at_s",
];

/// Largest number of metrics of campaigns that are printed and compared unless all are wanted.
pub const MOST_METRICS: usize = 7;
/// Metrics that a campaign prints, draws and compares if none is named: the first ones of this list that vary.
pub const MAIN_METRICS: [&str; 24] = [
    "goal",
    "target_losses",
    "envelope_late_mean_rad",
    "gain_final",
    "cycle_period_s",
    "torque_impulse_per_hour_nm_s",
    "switchings",
    "settling_time_s",
    "time_outside_s",
    "angle_error_late_rad",
    "angle_residual_rad",
    "frequency_error_rms_rad_s",
    "nees_mean",
    "peak_torque_nm",
    "angle_error_peak_rad",
    "spectral_radius",
    "pointing_rms_rad",
    "pointing_error_end_rad",
    "elastic_rate_rms_rad_s",
    "fuel_kg",
    "elastic_energy_end_j",
    "elastic_energy_peak_j",
    "energy_below_10pct_at_s",
    "firings",
];

/// Values of runs, as they are collected.
#[derive(Clone, Debug)]
pub struct CampaignRuns {
    pub(crate) requirements: RequirementRuns,
    /// Uncertain keys, each with its value in the scenario and in every run.
    pub(crate) keys: Vec<UncertainValues>,
    /// Number of runs that meet the goal, and of those that have one.
    pub(crate) goals: [u64; 2],
    /// Number of runs, and of those that failed.
    pub(crate) runs: u64,
    pub(crate) failed: u64,
    /// Metrics from which warnings and modes of operation follow, each with a cell for every run.
    answer_metrics: Vec<(&'static MetricDescription, ColumnCells)>,
    /// Main metrics that are numbers, each with its value in every run; none beside requirements.
    pub(crate) main_metrics: Vec<(&'static MetricDescription, Vec<f64>)>,
    /// Name of the active fault in each run, if that varies.
    pub(crate) faults: Option<Vec<String>>,
    /// Place of the active fault among the keys that vary.
    fault_place: Option<usize>,
    /// Number of varied keys before the uncertain ones.
    designed: usize,
}

/// Values of an uncertain key.
#[derive(Clone, Debug)]
pub(crate) struct UncertainValues {
    pub key: String,
    pub design: f64,
    pub values: Vec<f64>,
}

/// Returns the value of a key as a number; NaN without one.
fn number(value: &Value) -> f64 {
    value.as_float().or_else(|| value.as_integer().map(|integer| integer as f64)).unwrap_or(f64::NAN)
}

impl CampaignRuns {
    /// Returns true if the active fault varies from run to run.
    pub fn varies_faults(&self) -> bool {
        self.faults.is_some()
    }

    /// Creates an empty collector for runs of a campaign.
    pub fn new(campaign: &Campaign) -> Self {
        let scenario = campaign.scenario();
        let uncertain = |key: &String| UncertainValues {
            key: key.clone(),
            design: number(&campaign.nominal(key)),
            values: Vec::new(),
        };
        let keys: Vec<UncertainValues> = scenario.uncertain.keys().map(uncertain).collect();
        let fields = campaign.fields(&Selection::ALL);
        let metric = |name: &str| {
            let field = fields.iter().find(|field| field.name == name)?;
            Some((meaning(name, Some(scenario))?, ColumnCells::empty(field.kind)))
        };
        let is_asked = !scenario.study.requirements.is_empty();
        let main = MAIN_METRICS.into_iter().filter(|_| !is_asked).filter_map(metric);
        let is_number =
            |cells: &ColumnCells| matches!(cells, ColumnCells::Numbers(_) | ColumnCells::Integers(_));
        let fault_place = campaign.keys().position(|key| key == ACTIVE_FAULT);
        Self {
            main_metrics: main.filter(|own| is_number(&own.1)).map(|own| (own.0, Vec::new())).collect(),
            answer_metrics: ANSWER_METRICS.into_iter().filter_map(metric).collect(),
            requirements: RequirementRuns::new(scenario),
            designed: campaign.keys().count() - keys.len(),
            keys,
            faults: fault_place.map(|_| Vec::new()),
            fault_place,
            goals: [0; 2],
            runs: 0,
            failed: 0,
        }
    }

    /// Returns the names of the columns of a table from which the answer of a campaign is made, besides its varied keys.
    pub fn columns() -> impl Iterator<Item = &'static str> {
        COLUMNS.into_iter().chain(ANSWER_METRICS).chain(MAIN_METRICS)
    }

    /// Adds a run of this number by the values of all keys that vary and by its metrics; one that failed has none.
    pub fn add(&mut self, run: u64, drawn: &[Value], metrics: Option<&Metrics>) {
        self.requirements.add(run, metrics);
        for (own, value) in self.keys.iter_mut().zip(drawn.iter().skip(self.designed)) {
            own.values.push(number(value));
        }
        if let Some((faults, place)) = self.faults.as_mut().zip(self.fault_place) {
            faults.push(drawn.get(place).and_then(Value::as_str).unwrap_or_default().to_owned());
        }
        for (meaning, cells) in &mut self.answer_metrics {
            cells.push_metric(metrics.and_then(|metrics| metrics.get(meaning.name)));
        }
        for (meaning, values) in &mut self.main_metrics {
            values.push(metrics.and_then(|metrics| metrics.number(meaning.name)).unwrap_or(f64::NAN));
        }
        self.add_goal(metrics.and_then(|metrics| metrics.word(GOAL)).and_then(goal::score));
        self.runs += 1;
        self.failed += u64::from(metrics.is_none());
    }

    /// Returns the number of runs.
    pub fn count(&self) -> u64 {
        self.runs
    }

    /// True if the runs that remain of a campaign of `total` cannot change whether it meets each requirement.
    pub fn are_decided(&self, total: u64) -> bool {
        !self.requirements.is_empty() && self.requirements.are_decided(total)
    }

    /// Returns the verdicts on the requirements, in their order; none without a run.
    pub fn verdicts(&self) -> Vec<RequirementVerdict> {
        self.requirements.clone().finish()
    }

    /// Returns the metrics of the run in a row from which warnings and modes of operation follow.
    pub(crate) fn answer_metrics(&self, row: usize) -> Metrics {
        let metric = |(meaning, cells): &(&'static MetricDescription, ColumnCells)| {
            Some((*meaning, cells.metric_value(row)?))
        };
        Metrics(self.answer_metrics.iter().filter_map(metric).collect())
    }

    fn add_goal(&mut self, score: Option<f64>) {
        if let Some(score) = score {
            self.goals[0] += u64::from(score > 0.5);
            self.goals[1] += 1;
        }
    }
}

impl RowMaker {
    /// Returns the values of runs from their rows; `columns` returns columns by their names, `None` for a missing one.
    pub fn campaign_runs<E>(
        &self,
        columns: impl Fn(&[&str]) -> Result<Vec<Option<ColumnCells>>, E>,
    ) -> Result<CampaignRuns, E> {
        let mut all = CampaignRuns::new(&self.campaign);
        let keys: Vec<String> = all.keys.iter().map(|own| own.key.clone()).collect();
        let mut names: Vec<&str> = COLUMNS.to_vec();
        names.push(ACTIVE_FAULT);
        names.extend(keys.iter().map(String::as_str));
        names.extend(all.answer_metrics.iter().map(|(meaning, _)| meaning.name));
        let answer = names.len();
        names.extend(all.main_metrics.iter().map(|(meaning, _)| meaning.name));
        let mut found = columns(&names)?;
        for ((_, own), cells) in all.main_metrics.iter_mut().zip(found.drain(answer..)) {
            *own = cells.map_or_else(Vec::new, |cells| cells.numbers());
        }
        let metrics = found.drain(COLUMNS.len() + 1 + keys.len()..);
        for ((_, own), cells) in all.answer_metrics.iter_mut().zip(metrics) {
            // A table may have only some of the metrics.
            *own = cells.unwrap_or_else(|| ColumnCells::Numbers(Vec::new()));
        }
        for (own, cells) in all.keys.iter_mut().zip(found.drain(COLUMNS.len() + 1..)) {
            own.values = cells.map_or_else(Vec::new, |cells| cells.numbers());
        }
        if let (Some(faults), Some(ColumnCells::Text(cells))) = (&mut all.faults, found[COLUMNS.len()].take())
        {
            *faults = cells.into_iter().map(Option::unwrap_or_default).collect();
        }
        let [runs, errors, goals, values, shares] = [0, 1, 2, 3, 4].map(|place| found[place].take());
        let Some(ColumnCells::Integers(runs)) = runs else { return Ok(all) };
        let list = |cells: &Option<ColumnCells>, row: usize| match cells {
            Some(ColumnCells::Lists(cells)) => cells.get(row).cloned().flatten().unwrap_or_default(),
            _ => Vec::new(),
        };
        let has_values = values.is_some() || all.requirements.is_empty();
        for (row, run) in runs.iter().enumerate() {
            if has_values {
                let run = run.unwrap_or_default().cast_unsigned();
                all.requirements.add_values(run, &list(&values, row), &list(&shares, row));
            }
            all.runs += 1;
        }
        for score in goals.map_or_else(Vec::new, |goals| goals.numbers()) {
            all.add_goal(Some(score).filter(|score| score.is_finite()));
        }
        if let Some(ColumnCells::Text(errors)) = errors {
            all.failed = errors.iter().flatten().filter(|error| !error.is_empty()).count() as u64;
        }
        Ok(all)
    }
}
