//! Answer of a campaign: how many runs meet what was asked, the distribution of each requirement, the worst run, and what
//! drives it.

use flexsc_formats::count::counted;
use flexsc_formats::reader_units::{ReaderUnit, ReaderUnits, percent};
use flexsc_scenario::Scenario;
use serde::Serialize;

use super::campaign_mode::{CampaignMode, campaign_modes};
use super::campaign_warning::{CampaignWarning, campaign_warnings};
use super::driving_key::{DrivingKey, driving_keys};
use super::fault_answer::{FaultAnswer, LeastRobust};
use super::requirement_answer::{margin_text, requirement_id};
use super::{Answer, RunVerdict, SCHEMA};
use crate::campaign::CampaignRuns;
use crate::metrics::MetricDescription;
use crate::requirement_verdict::{Decision, RequirementVerdict};
use crate::statistics::{quantile, wilson};

/// Confidence of the intervals of shares.
const CONFIDENCE: f64 = 0.95;
/// Distance from 0 or 1 by which rounding may move the end of an interval.
const ROUNDING: f64 = 1e-12;

/// Answer of a campaign.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CampaignAnswer {
    /// Name and version of the structure, which changes when a field changes its meaning.
    pub schema: &'static str,
    /// `campaign`.
    pub kind: &'static str,
    /// Name of the scenario.
    pub scenario: String,
    /// Number of runs.
    pub runs: u64,
    /// Number of runs that failed.
    pub failed: u64,
    /// Verdict.
    pub verdict: RunVerdict,
    /// Verdict in words.
    pub verdict_text: String,
    /// Number of runs that meet all requirements, or the goal, with its share; absent if nothing is asked.
    #[serde(flatten)]
    pub met: Option<MetShare>,
    /// Requirements, missed ones first, then by margin.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub requirements: Vec<CampaignRequirement>,
    /// Main metrics that vary, of a campaign without requirements.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub metrics: Vec<MetricSpread>,
    /// Warnings about runs, the gravest first.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<CampaignWarning>,
    /// Modes of operation, in the order of the scenario.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub by_mode: Vec<CampaignMode>,
    /// Faults, each with the requirements in its runs, of a campaign that varies `active_fault`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub by_fault: Vec<FaultAnswer>,
    /// Run with the least margin of these.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub least_robust: Option<LeastRobust>,
    /// Command that repeats the worst run of the first requirement; absent without a directory of the runs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub repeat: Option<String>,
}

/// Metric over the runs of a campaign that have a value.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MetricSpread {
    /// Name of the metric.
    pub name: &'static str,
    /// SI unit of all values.
    pub unit: &'static str,
    /// Median.
    pub median: f64,
    /// Value that is not exceeded in 95 % of the runs.
    pub p95: f64,
    /// Largest value.
    pub largest: f64,
}

impl MetricSpread {
    /// Returns the main metrics that vary from run to run.
    fn all(runs: &CampaignRuns) -> Vec<Self> {
        let spread = |(meaning, values): &(&'static MetricDescription, Vec<f64>)| {
            let sorted = sorted_finite(values);
            let (least, largest) = (*sorted.first()?, *sorted.last()?);
            let [median, p95] = [0.5, 0.95].map(|part| quantile(&sorted, part));
            (least < largest).then_some(Self { name: meaning.name, unit: meaning.unit, median, p95, largest })
        };
        runs.main_metrics.iter().filter_map(spread).collect()
    }
}

/// Share of the runs that meet something.
#[derive(Copy, Clone, Debug, PartialEq, Serialize)]
pub struct MetShare {
    /// Number of runs that meet it.
    pub runs_met: u64,
    /// Part of the runs.
    pub share: f64,
    /// Interval of the probability (Wilson).
    pub share_interval: [f64; 2],
    /// Confidence of the interval.
    pub confidence: f64,
}

/// Requirement over the runs of a campaign.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CampaignRequirement {
    /// Identifier: R and the place in the scenario, from 1.
    pub id: String,
    /// Name.
    pub name: String,
    /// Required quantity, with its index and time, in words.
    pub description: String,
    /// SI unit of all values.
    pub unit: &'static str,
    /// Largest accepted value.
    pub limit: f64,
    /// Value of the scenario without drawn keys, if it is known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nominal: Option<f64>,
    /// Median of the runs; absent if no run has a value.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub median: Option<f64>,
    /// Value that is not exceeded in 95 % of the runs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub p95: Option<f64>,
    /// Run with the largest value, or the first one without a value.
    pub worst: WorstRun,
    /// Margins of the runs; absent if no run has a value.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub margin: Option<MarginSpread>,
    /// Share of the runs whose own value is within the limit.
    #[serde(flatten)]
    pub met_share: MetShare,
    /// Level of the requirement.
    pub level: f64,
    /// Interpretation of the level: `temporal`, `ensemble` or `mixed`.
    pub interpretation: &'static str,
    /// `met`, `undecided` (too few runs for its confidence) or `missed`.
    pub decision: Decision,
    /// Whether the requirement is met.
    pub met: bool,
    /// Uncertain keys that it depends on, the first one most.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub driven_by: Vec<DrivingKey>,
    /// Numbers in the unit of the limit.
    pub text: CampaignRequirementText,
}

/// Worst run of a requirement.
#[derive(Copy, Clone, Debug, PartialEq, Serialize)]
pub struct WorstRun {
    /// Value; absent if the run has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub value: Option<f64>,
    /// Number of the run.
    pub run: u64,
}

/// Margins of a requirement over runs: (limit - value)/limit.
#[derive(Copy, Clone, Debug, PartialEq, Serialize)]
pub struct MarginSpread {
    /// Median.
    pub median: f64,
    /// Margin that 5 % of the runs do not reach.
    pub p05: f64,
    /// Least margin.
    pub worst: f64,
}

/// Texts of a requirement of a campaign, in the unit of its limit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CampaignRequirementText {
    /// Unit.
    pub unit: String,
    /// Limit as it was written.
    pub limit: String,
    /// Value without drawn keys; absent if it is not known.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub nominal: String,
    /// Median; absent if no run has a value.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub median: String,
    /// 95 % of the runs; absent if no run has a value.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub p95: String,
    /// Largest value on its side of the limit, with its run.
    pub worst: String,
    /// Least margin; absent if no run has a value.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub margin: String,
    /// Runs that meet it: `199 of 200`.
    pub met: String,
    /// Interval of their share: `97.2 to 99.9 %`; absent if no run was to meet it.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub share_interval: String,
    /// Level of the ensemble or share of all values, in words; absent without one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
}

impl MetShare {
    fn new(met: u64, runs: u64) -> Self {
        Self {
            runs_met: met,
            share: met as f64 / runs as f64,
            share_interval: wilson(met, runs).into(),
            confidence: CONFIDENCE,
        }
    }

    /// Returns the interval as text, with digits that keep it from 0 and 100 %; empty without a run.
    fn interval_text(&self) -> String {
        if self.share.is_nan() {
            return String::new();
        }
        // Rounding may leave an end that is 0 or 1 just off it.
        let whole = |end: f64| if (end - end.round()).abs() < ROUNDING { end.round() } else { end };
        let [low, high] = self.share_interval.map(|end| percent(whole(end)));
        format!("{} to {high}", low.trim_end_matches(" %"))
    }
}

impl CampaignAnswer {
    /// Returns the answer of runs of a scenario: with the values of the run without drawn keys, if they are known, and the
    /// directory of the runs, if there is one.
    pub fn new(
        scenario: &Scenario,
        runs: &CampaignRuns,
        nominal: Option<&Answer>,
        directory: Option<&str>,
        units: ReaderUnits,
    ) -> Self {
        let verdicts = runs.verdicts();
        let own = |(index, verdict): (usize, &RequirementVerdict)| {
            let id = requirement_id(index);
            let nominal = nominal.and_then(|answer| answer.requirements.iter().find(|own| own.id == id));
            let nominal = nominal.map(|own| own.value).filter(|value| value.is_finite());
            requirement(scenario, runs, (index, verdict), nominal, units)
        };
        let mut requirements: Vec<CampaignRequirement> = verdicts.iter().enumerate().map(own).collect();
        let worst_margin = |own: &CampaignRequirement| own.margin.map_or(f64::NEG_INFINITY, |own| own.worst);
        requirements.sort_by(|a, b| {
            b.decision.fails().cmp(&a.decision.fails()).then(worst_margin(a).total_cmp(&worst_margin(b)))
        });
        let met = if requirements.is_empty() {
            let has_goal = scenario.reference.band.is_some() && runs.goals[1] > 0;
            has_goal.then(|| MetShare::new(runs.goals[0], runs.runs))
        } else {
            Some(MetShare::new(runs.count_meeting_all(verdicts.len()), runs.runs))
        };
        let warnings = campaign_warnings(scenario, runs, units);
        let but = warnings.iter().find_map(|own| own.reason.as_deref());
        let (verdict, verdict_text) = verdict(&requirements, met.as_ref(), runs.runs, but);
        let by_fault = runs.faults(scenario);
        let least_robust = LeastRobust::among(&by_fault);
        let worst =
            least_robust.as_ref().map(|own| own.run).or(requirements.first().map(|own| own.worst.run));
        let repeat = directory
            .zip(worst)
            .map(|(directory, run)| format!("flexsc simulate --from {directory} --row {run} -o run-{run}"));
        Self {
            schema: SCHEMA,
            kind: "campaign",
            scenario: scenario.name.clone(),
            runs: runs.runs,
            failed: runs.failed,
            verdict,
            verdict_text,
            met,
            requirements,
            metrics: MetricSpread::all(runs),
            by_mode: campaign_modes(scenario, runs, &warnings),
            warnings,
            by_fault,
            least_robust,
            repeat,
        }
    }
}

impl CampaignRuns {
    /// Returns the number of runs that meet all requirements.
    fn count_meeting_all(&self, verdicts: usize) -> u64 {
        let meets = |row: usize| (0..verdicts).all(|index| self.requirements.is_met(index, row));
        (0..self.requirements.numbers().len()).filter(|row| meets(*row)).count() as u64
    }
}

fn verdict(
    requirements: &[CampaignRequirement],
    met: Option<&MetShare>,
    runs: u64,
    but: Option<&str>,
) -> (RunVerdict, String) {
    let Some(share) = met else { return (RunVerdict::NotAsked, "no requirement".to_owned()) };
    let shown = |what: &str| {
        let verb = if runs == 1 { "meets" } else { "meet" };
        format!(
            "{} of {} {verb} {what}, {} ({})",
            share.runs_met,
            counted(runs, "run"),
            percent(share.share),
            share.interval_text()
        )
    };
    let what = match requirements.len() {
        0 => {
            let verdict = if share.runs_met == runs { RunVerdict::GoalMet } else { RunVerdict::GoalMissed };
            return (verdict, shown("the goal"));
        }
        1 => "the requirement".to_owned(),
        all => format!("all {all} requirements"),
    };
    let has = |decision: Decision| requirements.iter().any(|own| own.decision == decision);
    match (has(Decision::Missed), has(Decision::Undecided)) {
        (true, _) => (RunVerdict::Missed, format!("MISSED: {}", shown(&what))),
        (false, true) => (RunVerdict::Missed, format!("undecided: {}", shown(&what))),
        (false, false) => match but {
            Some(why) => (RunVerdict::MetBut, format!("{}, but {why}", shown(&what))),
            None => (RunVerdict::Met, shown(&what)),
        },
    }
}

/// Returns the finite ones of some values in ascending order.
fn sorted_finite(values: &[f64]) -> Vec<f64> {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    sorted
}

fn requirement(
    scenario: &Scenario,
    runs: &CampaignRuns,
    (index, verdict): (usize, &RequirementVerdict),
    nominal: Option<f64>,
    units: ReaderUnits,
) -> CampaignRequirement {
    let RequirementVerdict { requirement, decision, runs_met, worst: (run, worst), .. } = verdict;
    let limit = requirement.limit;
    let written = requirement.written_limit.as_deref();
    let unit = units.as_written(written, limit, requirement.unit);
    let values = runs.requirements.values(index);
    let sorted = sorted_finite(values);
    let quantile = |q: f64| Some(quantile(&sorted, q)).filter(|value| value.is_finite());
    let margin_of = |value: f64| (limit - value) / limit;
    // A run without a value is the worst, and has no margin.
    let worst_value = Some(*worst).filter(|value| value.is_finite());
    let margin =
        quantile(0.5).zip(quantile(0.95)).zip(worst_value.or(quantile(1.0))).map(|((median, p95), worst)| {
            MarginSpread { median: margin_of(median), p05: margin_of(p95), worst: margin_of(worst) }
        });
    let met_share = MetShare::new(*runs_met, verdict.runs);
    let row = runs.requirements.numbers().iter().position(|number| number == run);
    let met: Vec<bool> = (0..values.len()).map(|row| runs.requirements.is_met(index, row)).collect();
    let driven_by = driving_keys(&runs.keys, values, &met, row.zip(Some(*run)), |key, size| {
        scenario.reader_unit(key, size, units).quantity(size)
    });
    CampaignRequirement {
        id: requirement_id(index),
        name: requirement.name.clone(),
        description: requirement.description(),
        unit: requirement.unit,
        limit,
        nominal,
        median: quantile(0.5),
        p95: quantile(0.95),
        worst: WorstRun { value: worst_value, run: *run },
        margin,
        level: requirement.level,
        interpretation: requirement.interpretation.word(),
        decision: *decision,
        met: *decision == Decision::Met,
        text: texts(
            &unit,
            limit,
            written,
            [nominal, quantile(0.5), quantile(0.95)],
            (worst_value, *run),
            margin,
        )
        .with_share(&met_share, verdict),
        met_share,
        driven_by,
    }
}

fn texts(
    unit: &ReaderUnit,
    limit: f64,
    written: Option<&str>,
    middle: [Option<f64>; 3],
    (worst, run): (Option<f64>, u64),
    margin: Option<MarginSpread>,
) -> CampaignRequirementText {
    let [nominal, median, p95] =
        middle.map(|value| value.map_or_else(String::new, |value| unit.number_against(value, limit)));
    let worst = worst.map_or_else(|| "no value".to_owned(), |value| unit.number_against(value, limit));
    CampaignRequirementText {
        unit: unit.name.to_string(),
        limit: unit.limit(limit, written),
        nominal,
        median,
        p95,
        worst: format!("{worst}, run {run}"),
        margin: margin.map_or_else(String::new, |own| margin_text(own.worst, 1.0 - own.worst)),
        met: String::new(),
        share_interval: String::new(),
        note: None,
    }
}

impl CampaignRequirementText {
    fn with_share(self, share: &MetShare, verdict: &RequirementVerdict) -> Self {
        Self {
            met: verdict.runs_met_text(),
            share_interval: share.interval_text(),
            note: verdict.note(),
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_end_at_whole_numbers_only_where_they_do() {
        // scipy.stats.binomtest(met, runs).proportion_ci(0.95, "wilson"): 0.7225 to 1, and 0.9722 to 0.9991.
        assert_eq!(MetShare::new(10, 10).interval_text(), "72 to 100 %");
        assert_eq!(MetShare::new(199, 200).interval_text(), "97 to 99.9 %");
        assert_eq!(MetShare::new(0, 10).interval_text(), "0 to 28 %");
    }
}
