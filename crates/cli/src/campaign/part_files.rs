//! A campaign as a directory of parts, which can be continued after an interruption, and its results.

use std::io::Write;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use flexsc_core::campaign::{
    Campaign, CampaignRun, CampaignSummary, ColumnCells, Directory, DirectoryError, Manifest, RunError,
    RunOutcome, RunRows, STATISTICS,
};
use flexsc_core::formats::count::counted;
use flexsc_core::metrics::Metrics;

use super::points::{self, Points};
use super::progress_table::LiveStatistics;
use super::{CampaignJob, CampaignReport, interruption, object, scheduler, write_statistics};
use crate::error::CliError;
use crate::results::print_lines;
use crate::{requirements, say, stop};

/// Hint of the errors about a directory with another campaign.
const HINT: &str = "hint: give another directory with -o, or use --force to replace what is there";
/// Name of the table of the verdicts on the requirements.
const REQUIREMENTS: &str = "requirements.csv";

/// Converts an error of a campaign's directory to a failure of the command.
pub fn failure(error: DirectoryError) -> CliError {
    match error {
        DirectoryError::Other { .. } | DirectoryError::More { .. } => {
            CliError::Arguments(format!("{error}\n\n{HINT}"))
        }
        DirectoryError::Wrong { .. } => CliError::Arguments(error.to_string()),
        DirectoryError::Busy { path } => CliError::Busy { path },
        DirectoryError::Io { path, source } => CliError::write(&path)(source),
        DirectoryError::Scenario(error) => CliError::Scenario(error),
        DirectoryError::Interrupted => CliError::Interrupted(String::new()),
    }
}

/// Creates a campaign's directory, or opens it to continue.
pub fn create(path: &Path, manifest: Manifest, job: &CampaignJob<'_>) -> Result<Directory, CliError> {
    let create = if job.part { Directory::create } else { Directory::create_whole };
    create(path, manifest, job.force).map_err(failure)
}

/// Opens the directory of a campaign's runs, of any number and with any of the metrics.
///
/// # Errors
/// A directory of another campaign.
pub fn open(campaign: &Campaign, path: &Path) -> Result<Directory, CliError> {
    let directory = Directory::open(path).map_err(failure)?;
    let work = directory.work();
    let same = Manifest::new(campaign, work.manifest.runs(), &work.selection)
        .map_err(|why| CliError::Arguments(format!("{}: {why}", campaign.scenario().name)))?;
    match work.manifest.first_difference(&same) {
        None => Ok(directory),
        Some(what) => {
            Err(CliError::Arguments(format!("{}: is a campaign of another scenario: {what}", path.display())))
        }
    }
}

/// Makes the missing runs of a job.
pub fn run(
    campaign: &Arc<Campaign>,
    job: &CampaignJob<'_>,
    path: &Path,
    work: impl Fn(&CampaignRun) -> Result<Metrics, RunError> + Send + Sync + 'static,
) -> Result<CampaignReport, CliError> {
    let mut manifest = Manifest::new(campaign, job.range.clone(), &job.selection)
        .map_err(|why| CliError::Arguments(format!("{}: {why}", campaign.scenario().name)))?;
    if job.scheduler.is_some() {
        manifest.limit_part_size(scheduler::TASK_S);
    }
    let is_new = !Directory::is_campaign_directory(path);
    let directory = create(path, manifest, job)?;
    let missing = directory.missing_among(job.range.clone()).map_err(failure)?;
    let count = |ranges: &[Range<u64>]| ranges.iter().map(|runs| runs.end - runs.start).sum::<u64>();
    let (all, remaining) = (job.range.end - job.range.start, count(&missing));
    if remaining < all && !job.json {
        say!("{}: {} of {} are there", path.display(), all - remaining, counted(all, "run"));
    }
    if let Some(address) = job.scheduler {
        // The process that hands out the runs needs the lock.
        drop(directory);
        if let Err(error) = scheduler::make(path, address) {
            if is_new {
                // What the scheduler's failure leaves without a run is no campaign.
                Directory::remove_empty(path).map_err(failure)?;
            }
            return Err(error);
        }
        return summary(&Directory::open(path).map_err(failure)?, &job.range);
    }
    let work = Arc::new(work);
    let mut making = PartProgress {
        directory: &directory,
        job,
        live: LiveStatistics::new(all, all - remaining),
        part: None,
        next: 0,
        made: 0,
    };
    for gap in gaps(&missing) {
        let inside = |part: &&Range<u64>| gap.start <= part.start && part.end <= gap.end;
        let mut parts = missing.iter().filter(inside);
        let work = work.clone();
        // The runs are those of the manifest, here as on any other machine.
        let campaign = &directory.work().campaign;
        let (range, threads) = (gap.clone(), job.threads());
        let work = move |run: &CampaignRun| work(run);
        let report = |outcome| making.append_runs(outcome, &mut parts);
        let done = if job.plain {
            campaign.for_each_run_in_batches(range, threads, &job.selection, work, report)
        } else {
            campaign.for_each_run(range, threads, work, report)
        };
        if let Err(failure) = done {
            let made = all - remaining + making.made;
            drop(making);
            return Err(match failure {
                CliError::Interrupted(text) => CliError::Interrupted(format!(
                    "{text}; {} holds {made} of {}, and the same command continues",
                    path.display(),
                    counted(all, "run")
                )),
                failure => failure,
            });
        }
    }
    drop(making);
    summary(&directory, &job.range)
}

/// Merges adjacent ranges.
fn gaps(parts: &[Range<u64>]) -> Vec<Range<u64>> {
    let mut gaps: Vec<Range<u64>> = Vec::new();
    for part in parts {
        match gaps.last_mut() {
            Some(gap) if gap.end == part.start => gap.end = part.end,
            _ => gaps.push(part.clone()),
        }
    }
    gaps
}

/// Progress of a job: its parts are written in order.
struct PartProgress<'a> {
    directory: &'a Directory,
    job: &'a CampaignJob<'a>,
    live: LiveStatistics,
    /// Runs and rows of the unfinished part.
    part: Option<(Range<u64>, RunRows)>,
    /// Number of the next expected run.
    next: u64,
    /// Number of runs in written parts.
    made: u64,
}

impl PartProgress<'_> {
    fn append_runs<'r>(
        &mut self,
        outcome: Option<RunOutcome>,
        parts: &mut impl Iterator<Item = &'r Range<u64>>,
    ) -> Result<(), CliError> {
        let Some(outcome) = outcome else {
            self.live.show();
            return if stop::stop_requested() { Err(interruption(self.next)) } else { Ok(()) };
        };
        self.next = outcome.number + 1;
        let outcome = super::accepted(outcome)?;
        if let (Err(error), true) = (&outcome.metrics, self.job.fail_fast) {
            return Err(CliError::First { number: outcome.number, why: error.to_string() });
        }
        let campaign = &self.directory.work().campaign;
        if self.job.json {
            let RunOutcome { number, drawn, metrics, .. } = &outcome;
            print_lines(&[object(campaign, *number, drawn, metrics.as_ref())])?;
        }
        self.live.add(&outcome);
        if self.part.is_none() {
            self.part = parts.next().map(|runs| (runs.clone(), self.directory.work().rows()));
        }
        let Some((runs, rows)) = &mut self.part else { return Ok(()) };
        rows.push(campaign, &outcome);
        if self.next == runs.end {
            self.directory.write(runs, rows).map_err(failure)?;
            self.made += runs.end - runs.start;
            self.part = None;
        }
        Ok(())
    }
}

/// Returns the results of a directory and writes the table of its statistics; of a sweep, with the points in `range`.
pub fn summary(directory: &Directory, range: &Range<u64>) -> Result<CampaignReport, CliError> {
    let CampaignSummary { runs, failed, statistics, values } = directory.summary().map_err(failure)?;
    write_statistics(&directory.path().join(STATISTICS), &statistics)?;
    let work = directory.work();
    let shown = points::runs(&work.campaign, range);
    let present = directory.parts().map_err(failure)?;
    let within = |runs: &Range<u64>, part: &Range<u64>| runs.start.max(part.start)..runs.end.min(part.end);
    let column = |name: &str| -> Result<_, CliError> {
        let Some(field) = work.fields().iter().find(|field| field.name == name) else { return Ok(None) };
        let mut all = ColumnCells::empty(field.kind);
        for (runs, part) in shown.iter().flat_map(|runs| present.iter().map(move |part| (runs, part))) {
            let runs = within(runs, part);
            if !runs.is_empty() {
                let cells = directory.columns_of(part, &[name]).map_err(failure)?.remove(0);
                let from = (runs.start - part.start) as usize;
                all.append(cells.slice(from..from + (runs.end - runs.start) as usize));
            }
        }
        Ok(Some(all))
    };
    // A sweep with missing runs is not printed point by point.
    let is_whole = directory.missing_among(range.clone()).map_err(failure)?.is_empty();
    let points = Points::new((&work.campaign, range), (&statistics, &work.selection), column)?;
    let (points, table) = (points.filter(|_| is_whole), Some(directory.path().to_owned()));
    let requirements = values.verdicts();
    if !requirements.is_empty() {
        requirements::write_table(&directory.path().join(REQUIREMENTS), &requirements)?;
    }
    Ok(CampaignReport {
        runs,
        statistics,
        requirements,
        values,
        points,
        failed,
        only: None,
        nominal: None,
        table,
    })
}

/// Writes the table of the statistics of a directory.
pub fn write_statistics_of(directory: &Directory) -> Result<(), CliError> {
    let CampaignSummary { statistics, .. } = directory.summary().map_err(failure)?;
    write_statistics(&directory.path().join(STATISTICS), &statistics)
}
