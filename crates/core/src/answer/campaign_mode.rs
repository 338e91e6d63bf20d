//! Mode of operation over the runs of a campaign: time, time at a limit, and the runs that lose its target.

use flexsc_control::operation::OperatingMode;
use flexsc_scenario::Scenario;
use serde::Serialize;

use super::campaign_warning::CampaignWarning;
use super::mode_answer::LIMIT_TIMES;
use super::warning::WarningKind;
use crate::campaign::CampaignRuns;
use crate::metrics::MetricValue;
use crate::statistics::quantile;

/// Mode of operation over the runs of a campaign.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CampaignMode {
    /// Name.
    pub mode: String,
    /// Number of the runs that enter it.
    pub runs: u64,
    /// Time in the mode, over these runs (s); absent if none enters it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_s: Option<RunSpread>,
    /// Longest time with actuators at limits of one kind, over these runs (s); absent if none reaches a limit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at_limit_s: Option<RunSpread>,
    /// Number of the runs that lose its target.
    pub runs_lost: u64,
}

/// Values of a quantity over runs.
#[derive(Copy, Clone, Debug, PartialEq, Serialize)]
pub struct RunSpread {
    /// Median.
    pub median: f64,
    /// Value that is not exceeded in 95 % of the runs.
    pub p95: f64,
    /// Largest value.
    pub largest: f64,
}

impl RunSpread {
    fn from_values(mut values: Vec<f64>) -> Option<Self> {
        values.sort_by(f64::total_cmp);
        let largest = *values.last()?;
        Some(Self { median: quantile(&values, 0.5), p95: quantile(&values, 0.95), largest })
    }
}

/// Returns each mode of operation over runs.
pub(super) fn campaign_modes(
    scenario: &Scenario,
    runs: &CampaignRuns,
    warnings: &[CampaignWarning],
) -> Vec<CampaignMode> {
    if scenario.mode.is_empty() {
        return Vec::new();
    }
    let mut times = vec![Vec::new(); scenario.mode.len()];
    let mut limits = times.clone();
    for row in 0..runs.requirements.numbers().len() {
        let metrics = runs.answer_metrics(row);
        let list = |name: &str| metrics.get(name).map_or_else(Vec::new, MetricValue::numbers);
        let [visits, own_times] = ["mode_visits", "mode_times_s"].map(list);
        let own_limits = LIMIT_TIMES.map(|(name, _)| list(name));
        for index in (0..times.len()).filter(|index| visits.get(*index).is_some_and(|visits| *visits > 0.0)) {
            times[index].extend(own_times.get(index));
            limits[index].push(own_limits.iter().filter_map(|of| of.get(index).copied()).fold(0.0, f64::max));
        }
    }
    let mode = |((mode, times), limits): ((&OperatingMode, Vec<f64>), Vec<f64>)| {
        let lost = |own: &&CampaignWarning| {
            own.kind == WarningKind::TargetLost && own.mode.as_ref() == Some(&mode.name)
        };
        CampaignMode {
            mode: mode.name.clone(),
            runs: times.len() as u64,
            time_s: RunSpread::from_values(times),
            at_limit_s: RunSpread::from_values(limits).filter(|own| own.largest > 0.0),
            runs_lost: warnings.iter().find(lost).map_or(0, |own| own.runs),
        }
    };
    scenario.mode.iter().zip(times).zip(limits).map(mode).collect()
}
