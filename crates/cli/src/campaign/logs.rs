//! Simulation of runs with their logs: one run, or each run of a campaign.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{Arc, PoisonError};

use clap::ValueEnum;
use flexsc_core::SimulationError;
use flexsc_core::answer::RunObserver;
use flexsc_core::campaign::{Campaign, CampaignRun};
use flexsc_core::metrics::Metrics;
use flexsc_core::record::{Detail, ExistingLog, LogFile, Record, RecordError, RunEnd, existing_log};
use flexsc_core::requirement_verdict::RequirementVerdict;
use flexsc_view::scene::Scene;
use flexsc_view::with_layout;

use super::{CampaignJob, run as run_all};
use crate::error::{CliError, NotReplaced};
use crate::say;
use crate::stop::{self, stop_flag};

/// Contents of a log.
#[derive(Copy, Clone, PartialEq, ValueEnum)]
pub enum LogDetail {
    /// No log
    None,
    /// Events: switchings, window means, adaptation
    Events,
    /// Events, and the motion at every log period and every switching
    Full,
    /// All of this, and the 3-D scene for viewers: frames, shapes, plumes
    Scene,
}

impl LogDetail {
    /// Returns the level of detail of the log; `None` for no log.
    pub fn detail(self) -> Option<Detail> {
        match self {
            Self::None => None,
            Self::Events => Some(Detail::Events),
            Self::Full => Some(Detail::Full),
            Self::Scene => Some(Detail::Scene),
        }
    }
}

/// Runs a campaign; if a detail is given, the log of each run is NAME-NUMBER.mcap beside the tables.
///
/// Returns the verdicts on the requirements.
pub fn run(
    campaign: &Arc<Campaign>,
    job: &CampaignJob<'_>,
    detail: Option<Detail>,
) -> Result<Vec<RequirementVerdict>, CliError> {
    let directory = job.table.map(Path::to_owned).unwrap_or_default();
    let (name, force) = (campaign.scenario().name.clone(), job.force);
    let log = move |number: u64| -> PathBuf { directory.join(format!("{name}-{number}.mcap")) };
    let verdicts = run_all(campaign, job, {
        let (log, selection) = (log.clone(), job.selection.clone());
        let (observed, is_single) = (Arc::clone(&job.observed), job.is_single());
        move |run| match detail {
            // Runs that had not started before the interruption have no log.
            _ if stop::stop_requested() => Err(stop::interrupted().into()),
            None if is_single => {
                let mut observer = RunObserver::new(&run.scenario);
                let metrics = Campaign::simulate_metrics(run, &selection, (stop_flag(), &mut observer))?;
                *observed.lock().unwrap_or_else(PoisonError::into_inner) = Some(observer.finish());
                Ok(metrics)
            }
            None => Ok(Campaign::simulate_metrics(run, &selection, stop_flag())?),
            Some(detail) => {
                Ok(selection.select(simulate_to_log(run, &log(run.number), (detail, force), stop_flag())?.0))
            }
        }
    })?;
    if detail.is_some() && !job.json {
        let (first, last) = (log(job.range.start), log(job.range.end - 1));
        if first == last {
            say!("  log            {}", first.display());
        } else {
            say!("  logs           {} to {}", first.display(), last.display());
        }
    }
    Ok(verdicts)
}

/// Simulates a run with its log file, and returns the file's size. An interrupted or a failed run leaves a finished
/// log, and a log that cannot be written leaves no file.
pub fn simulate_to_log(
    run: &CampaignRun,
    path: &Path,
    (detail, force): (Detail, bool),
    record: impl Record,
) -> Result<(Metrics, u64), SimulationError> {
    let provenance = with_layout(Campaign::provenance(run), &run.scenario, detail);
    let mut log = LogFile::create(path, &provenance, detail)?;
    // From here on, this process has the file to itself.
    if let (ExistingLog::Other(description), false) = (existing_log(path, &provenance), force) {
        let text = format!(
            "{}: {description}\n\nhint: give another directory with -o, or use --force to replace it",
            path.display()
        );
        return Err(RecordError::Io(NotReplaced(text).into()).into());
    }
    let scene = Scene::for_detail(&run.scenario, detail);
    match Campaign::simulate(run, ((&mut log, scene), record)) {
        Ok(metrics) => {
            let bytes = log.finish(&metrics, RunEnd::Complete)?;
            Ok((metrics, bytes))
        }
        // The incomplete log is removed.
        Err(SimulationError::Record(RecordError::Io(error))) => Err(RecordError::Io(error).into()),
        Err(error) => {
            let interrupted = matches!(error, SimulationError::Record(RecordError::Interrupted));
            let end = if interrupted { RunEnd::Interrupted } else { RunEnd::Failed };
            log.finish(&Metrics::default(), end)?;
            Err(error)
        }
    }
}
