//! Warnings about the runs of a campaign: how many runs have each, and what it says of the gravest one.

use std::collections::BTreeMap;

use flexsc_formats::count::counted;
use flexsc_formats::reader_units::ReaderUnits;
use flexsc_scenario::Scenario;
use serde::Serialize;

use super::lines::RunData;
use super::warning::{self, Warning, WarningKind};
use crate::campaign::CampaignRuns;

/// Warning about some runs of a campaign.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CampaignWarning {
    /// Kind.
    pub kind: WarningKind,
    /// Name of the mode of operation that it is about.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mode: Option<String>,
    /// Number of the runs with this warning.
    pub runs: u64,
    /// Number of the gravest of them.
    pub worst_run: u64,
    /// Words.
    pub text: String,
    /// Words of a verdict on runs that meet their requirements; absent if the warning leaves it as it is.
    #[serde(skip)]
    pub(super) reason: Option<String>,
}

/// Runs with a warning.
struct WarnedRuns {
    runs: u64,
    worst: (u64, Warning),
}

/// Returns the warnings about runs, the gravest kind first.
pub(super) fn campaign_warnings(
    scenario: &Scenario,
    runs: &CampaignRuns,
    units: ReaderUnits,
) -> Vec<CampaignWarning> {
    let mut all: BTreeMap<(WarningKind, Option<String>), WarnedRuns> = BTreeMap::new();
    for (row, run) in runs.requirements.numbers().iter().enumerate() {
        let metrics = runs.answer_metrics(row);
        let own = RunData { scenario, metrics: &metrics, observed: None, units };
        for warning in warning::warnings(&own, &[]) {
            match all.get_mut(&(warning.kind, warning.mode.clone())) {
                Some(known) => {
                    known.runs += 1;
                    if warning.severity > known.worst.1.severity {
                        known.worst = (*run, warning);
                    }
                }
                None => {
                    all.insert(
                        (warning.kind, warning.mode.clone()),
                        WarnedRuns { runs: 1, worst: (*run, warning) },
                    );
                }
            }
        }
    }
    let total = counted(runs.runs, "run");
    let texts = |((kind, mode), WarnedRuns { runs, worst: (run, warning) })| CampaignWarning {
        kind,
        mode,
        runs,
        worst_run: run,
        text: format!("{runs} of {total}, worst run {run}: {}", warning.text),
        reason: kind.reason(&warning).map(|reason| format!("{reason} in {}", counted(runs, "run"))),
    };
    all.into_iter().map(texts).collect()
}
