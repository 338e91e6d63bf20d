//! Execution of a campaign: the row of each run, and the statistics.

mod campaign_record;
pub mod file;
pub mod logs;
pub mod options;
pub mod part_files;
mod points;
mod progress_table;
mod report;
mod scheduler;

use std::io::Write;
use std::ops::Range;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant as WallInstant;

use flexsc_core::SimulationError;
use flexsc_core::answer::{Answer, LeastRobust, Observed, RunVerdict};
use flexsc_core::campaign::{
    Campaign, CampaignRun, CampaignRuns, Directory, Manifest, RowMaker, RunError, RunOutcome, RunRows,
    Sampling,
};
use flexsc_core::formats::reader_units::ReaderUnits;
use flexsc_core::metrics::{Metrics, Selection};
use flexsc_core::record::RecordError;
use flexsc_core::requirement_verdict::{self, RequirementVerdict};
use flexsc_core::statistics::MetricColumns;
use serde::Serialize;
use serde_json::{Map, Value as Json, json};

use crate::answer::AnswerArgs;
use crate::error::CliError;
use crate::results::{print_lines, with_scenario_name};
use crate::runs_table::RunsTable;
use crate::{files, requirements, say, stop};
use campaign_record::CampaignRecord;
pub use campaign_record::SCENARIO;
pub use options::{CampaignOptions, TableFormat};
use points::Points;
use progress_table::LiveStatistics;
pub use progress_table::{RunningMean, table as table_so_far};
use report::{CampaignReport, are_alike, verdict, write_statistics};

/// Name of the file with the least robust run of a campaign over faults.
const LEAST_ROBUST: &str = "least-robust.toml";

/// Runs of a campaign to make, and their outputs.
#[expect(clippy::struct_excessive_bools, reason = "each is an option of the command")]
pub struct CampaignJob<'a> {
    /// Range of the runs.
    pub range: Range<u64>,
    /// True if the runs are only a part of the campaign: the tables are then named by the range.
    pub part: bool,
    /// Directory of the tables, or file of the rows, if any.
    pub table: Option<&'a Path>,
    /// True if `table` is a file.
    pub is_file: bool,
    /// File format of the rows.
    pub kind: TableFormat,
    /// Selected metrics of the rows.
    pub selection: Selection,
    /// True if the first failed run ends the campaign.
    pub fail_fast: bool,
    /// True if the campaign ends where its other runs cannot change a verdict.
    pub until_decided: bool,
    /// Prefix of the tables' names, if several campaigns share a directory.
    pub prefix: Option<&'a str>,
    /// True if tables of another campaign, or another file, are replaced.
    pub force: bool,
    /// Number of threads.
    pub jobs: Option<u16>,
    /// True if each run is printed as JSON.
    pub json: bool,
    /// Options of the answer.
    pub answer: AnswerArgs,
    /// Observations of every control cycle, of a campaign of one run.
    pub observed: Arc<Mutex<Option<Observed>>>,
    /// Address of the scheduler whose workers make the runs, if any.
    pub scheduler: Option<&'a str>,
    /// True if runs are simulated without a log: many of them are then simulated together in batches.
    pub plain: bool,
}

/// Runs a campaign, and returns the verdicts on the requirements; `work` simulates a single run.
pub fn run(
    campaign: &Arc<Campaign>,
    job: &CampaignJob<'_>,
    work: impl Fn(&CampaignRun) -> Result<Metrics, RunError> + Send + Sync + 'static,
) -> Result<Vec<RequirementVerdict>, CliError> {
    let began = WallInstant::now();
    let _writing = stop::writing();
    let mut reported = match job.table {
        Some(path) if job.kind == TableFormat::Parquet && !job.is_file => {
            let path = job.prefix.map_or_else(|| path.to_owned(), |name| path.join(name));
            part_files::run(campaign, job, &path, work)?
        }
        _ => table(campaign, job, work)?,
    };
    let runs = reported.runs as u64;
    reported.nominal = nominal(campaign, job, &reported);
    if campaign.design().keys().is_empty() && are_alike(&reported.statistics) {
        say!(
            "warning: no metric differs between the {runs} runs: does the scenario have noise or [uncertain] keys?"
        );
    }
    let (scenario, took) = (campaign.scenario(), began.elapsed().as_secs_f64());
    if let Some(only) = &reported.only {
        let observed = job.observed.lock().unwrap_or_else(PoisonError::into_inner).take();
        let answer = job.answer.answer(scenario, only, observed.as_ref());
        if job.json {
            print_lines(&[with_scenario_name(&scenario.name, json!({ "answer": answer }))])?;
        } else {
            job.answer.print(&answer, took, None);
            if let Some(path) = &reported.table {
                say!("  table {}", path.display());
            }
        }
    } else {
        // A sweep over faults is judged.
        let is_sweep = !reported.values.varies_faults() && !campaign.design().blocks.is_empty();
        let is_printed = is_sweep && (job.json || reported.say_points(&scenario.name, Some(took)));
        if !is_printed {
            let answer = reported.answer(scenario, job.answer);
            if let Some((least, table)) = answer.least_robust.as_ref().zip(reported.table.as_deref()) {
                save_least_robust(campaign, least, table)?;
            }
            if job.json {
                print_lines(&[with_scenario_name(&scenario.name, json!({ "answer": answer }))])?;
            } else {
                reported.say(&answer, Some(took), job.answer);
            }
            let is_refused = job.answer.strict && !is_sweep && answer.verdict == RunVerdict::MetBut;
            if is_refused && reported.failed.is_none() {
                return Err(CliError::Requirements(format!("{}: {}", scenario.name, answer.verdict_text)));
            }
        }
    }
    match reported.failed {
        None => Ok(reported.requirements),
        Some((failed, number, why)) => Err(CliError::Runs { failed, runs, number, why }),
    }
}

/// Writes the scenario of the least robust run into the directory of a campaign.
fn save_least_robust(campaign: &Campaign, least: &LeastRobust, table: &Path) -> Result<(), CliError> {
    if !table.is_dir() {
        return Ok(());
    }
    let run = campaign.run(least.run)?;
    let repeat = format!("flexsc simulate {LEAST_ROBUST} --runs {0}:{1}", run.noise_run, run.noise_run + 1);
    // A name with a line break would end the comment.
    let head = least.text().replace(char::is_control, " ");
    let text = format!("# {head}\n# {repeat}\n{}", run.scenario.self_contained().to_toml());
    files::write_within(&[(table.join(LEAST_ROBUST), text.into_bytes())])
}

/// Returns the metrics of the scenario without drawn keys, where a campaign draws keys and has requirements.
fn nominal(campaign: &Campaign, job: &CampaignJob<'_>, reported: &CampaignReport) -> Option<Metrics> {
    let is_asked = !campaign.scenario().uncertain.is_empty() && !reported.requirements.is_empty();
    let is_shown = is_asked && !job.part && campaign.design().blocks.is_empty() && reported.only.is_none();
    let run = is_shown.then(|| CampaignRun::new(campaign.scenario().clone(), 0))?;
    // Without it, the other runs are answered all the same.
    Campaign::simulate_metrics(&run, &Selection::ALL, stop::stop_flag()).ok()
}

/// Runs a campaign with its rows in one table, or without a table.
fn table(
    campaign: &Arc<Campaign>,
    job: &CampaignJob<'_>,
    work: impl Fn(&CampaignRun) -> Result<Metrics, RunError> + Send + Sync + 'static,
) -> Result<CampaignReport, CliError> {
    let runs = job.range.end - job.range.start;
    let mut table = None;
    let mut rows = None;
    if let Some(path) = job.table.filter(|_| job.is_file) {
        files::refuse_existing(path, job.force)?;
        files::make_parent(path)?;
        rows = Some(RunRows::new(campaign.fields(&job.selection)));
    }
    if let Some(dir) = job.table.filter(|_| !job.is_file) {
        let design = campaign.design();
        if !campaign.scenario().uncertain.is_empty()
            && (design.replicas > 1 || design.draws != Sampling::Random || design.noise_run.is_some())
        {
            // The `scenario.toml` could not repeat a run.
            let why =
                "--sample, --replicas and --noise same need --table parquet where [uncertain] keys are drawn";
            return Err(CliError::Arguments(format!("{why}, or no -o")));
        }
        if Directory::is_campaign_directory(dir) && !job.force {
            let why = "holds a campaign as Parquet files";
            let hint = "hint: give another directory with -o, or leave out `--table csv` to continue it";
            return Err(CliError::Arguments(format!("{}: {why}\n\n{hint}", dir.display())));
        }
        let kept = CampaignRecord::new(dir, job, campaign);
        // Checked before the files of a killed campaign change, and again as their only writer.
        kept.check()?;
        table = Some(RunsTable::create(&dir.join(job.file("runs")))?);
        kept.keep()?;
    }
    let mut printer = CampaignPrinter {
        campaign,
        job,
        table: table.as_mut(),
        rows: rows.as_mut(),
        shown: points::runs(campaign, &job.range),
        points: RunRows::new(campaign.fields(&job.selection)),
        all: MetricColumns::default(),
        values: CampaignRuns::new(campaign),
        only: None,
        live: LiveStatistics::new(runs, 0),
        next: job.range.start,
        failed: None,
    };
    let (range, threads) = (job.range.clone(), job.threads());
    let report = |outcome| printer.report(outcome);
    let done = if job.plain && !job.is_single() {
        campaign.for_each_run_in_batches(range, threads, &job.selection, work, report)
    } else {
        campaign.for_each_run(range, threads, work, report)
    };
    let CampaignPrinter { all, only, failed, points, values, .. } = printer;
    if let Err(Some(failure)) = done {
        return Err(match (&failure, table) {
            (CliError::Interrupted(_) | CliError::Write { .. } | CliError::First { .. }, Some(table)) => {
                table.interrupt(campaign, failure)
            }
            _ => failure,
        });
    }
    let mut table = table.map(|table| table.finish(campaign)).transpose()?;
    let only = only.filter(|_| all.runs() == 1);
    let made = values.count();
    if made < runs {
        say!("decided after {made} of {runs} runs");
    }
    let (runs, statistics, requirements) = (made as usize, all.finish(), values.verdicts());
    if let Some(dir) = job.table.filter(|_| !job.is_file) {
        write_statistics(&dir.join(job.file("statistics")), &statistics)?;
        if !requirements.is_empty() {
            requirements::write_table(&dir.join(job.file("requirements")), &requirements)?;
        }
    }
    if let (Some(path), Some(rows)) = (job.table, &rows) {
        let manifest = Manifest::new(campaign, job.range.clone(), &job.selection);
        let manifest =
            manifest.map_err(|why| CliError::Arguments(format!("{}: {why}", campaign.scenario().name)))?;
        file::write(
            path,
            job.kind,
            &RowMaker::from_manifest(manifest, path).map_err(part_files::failure)?,
            rows,
        )?;
        table = Some(path.to_owned());
    }
    let column =
        |name: &str| -> Result<_, CliError> { Ok(points.column(name).map(std::borrow::Cow::into_owned)) };
    let points = Points::new((campaign, &job.range), (&statistics, &job.selection), column)?;
    Ok(CampaignReport { runs, statistics, requirements, values, points, failed, only, nominal: None, table })
}

fn interruption(run: u64) -> CliError {
    CliError::Interrupted(format!(" at run {run}"))
}

/// Returns the outcome of a run, or an error if its log stopped the run.
fn accepted(outcome: RunOutcome) -> Result<RunOutcome, CliError> {
    match outcome.metrics {
        Err(RunError::Simulation(SimulationError::Record(RecordError::Io(source)))) => {
            Err(CliError::write(Path::new(&format!("the log of run {}", outcome.number)))(source))
        }
        Err(RunError::Simulation(SimulationError::Record(RecordError::Interrupted))) => {
            Err(interruption(outcome.number))
        }
        _ => Ok(outcome),
    }
}

impl CampaignJob<'_> {
    /// Returns true for a campaign of one run, which is answered as a run.
    pub fn is_single(&self) -> bool {
        self.range.end - self.range.start == 1
    }

    fn threads(&self) -> usize {
        usize::from(self.jobs.unwrap_or(0))
    }

    fn file(&self, kind: &str) -> String {
        let prefix = self.prefix.map_or(String::new(), |name| format!("{name}-"));
        let part =
            if self.part { format!("-{}-{}", self.range.start, self.range.end) } else { String::new() };
        format!("{prefix}{kind}{part}.csv")
    }
}

/// Receiver of the runs' rows, in order.
struct CampaignPrinter<'a> {
    campaign: &'a Campaign,
    job: &'a CampaignJob<'a>,
    table: Option<&'a mut RunsTable>,
    /// Rows for a single file.
    rows: Option<&'a mut RunRows>,
    /// Runs whose points are printed, and their rows.
    shown: Vec<Range<u64>>,
    points: RunRows,
    all: MetricColumns,
    values: CampaignRuns,
    only: Option<Metrics>,
    live: LiveStatistics,
    /// Number of the next expected run.
    next: u64,
    /// Number of failed runs, number of the first one, and its error.
    failed: Option<(u64, u64, String)>,
}

impl CampaignPrinter<'_> {
    /// Takes the outcome of a run. Fails without an error where the others cannot change a verdict.
    fn report(&mut self, outcome: Option<RunOutcome>) -> Result<(), Option<CliError>> {
        let is_run = outcome.is_some();
        self.take(outcome)?;
        let total = self.job.range.end - self.job.range.start;
        if is_run && self.job.until_decided && self.values.are_decided(total) { Err(None) } else { Ok(()) }
    }

    fn take(&mut self, outcome: Option<RunOutcome>) -> Result<(), CliError> {
        if let Some(table) = &mut self.table {
            table.flush_if_due()?;
        }
        let Some(outcome) = outcome else {
            self.live.show();
            return if stop::stop_requested() { Err(interruption(self.next)) } else { Ok(()) };
        };
        self.next = outcome.number + 1;
        let outcome = accepted(outcome)?;
        self.live.add(&outcome);
        if let Some(table) = &mut self.table {
            table.row(self.campaign, &outcome)?;
        }
        if let Some(rows) = &mut self.rows {
            rows.push(self.campaign, &outcome);
        }
        if self.shown.iter().any(|runs| runs.contains(&outcome.number)) {
            self.points.push(self.campaign, &outcome);
        }
        if self.job.json {
            let RunOutcome { number, drawn, metrics, .. } = &outcome;
            print_lines(&[object(self.campaign, *number, drawn, metrics.as_ref())])?;
        }
        self.values.add(outcome.number, &outcome.drawn, outcome.metrics.as_ref().ok());
        match outcome.metrics {
            Ok(metrics) => {
                self.all.add(&metrics);
                self.only = Some(metrics);
            }
            Err(error) if self.job.fail_fast => {
                return Err(CliError::First { number: outcome.number, why: error.to_string() });
            }
            Err(error) => {
                let first = self.failed.take();
                let (failed, number, why) = first.unwrap_or_else(|| (0, outcome.number, error.to_string()));
                self.failed = Some((failed + 1, number, why));
            }
        }
        Ok(())
    }
}

/// Returns a run as a JSON object, with the value of each key that varies.
pub fn object(
    campaign: &Campaign,
    number: u64,
    drawn: &[impl Serialize],
    metrics: Result<&Metrics, &RunError>,
) -> Json {
    let drawn: Map<_, _> =
        campaign.keys().zip(drawn).map(|(key, value)| (key.to_owned(), json!(value))).collect();
    let mut object = json!({
        "scenario": campaign.scenario().name,
        "run": number,
        "seed": campaign.scenario().seed,
        "drawn": drawn,
    });
    match metrics {
        Ok(metrics) => {
            object["metrics"] = metrics.to_json();
            let verdicts = requirement_verdict::run_verdicts(campaign.scenario(), metrics);
            if !verdicts.is_empty() {
                object["requirements"] = requirements::json(&verdicts);
            }
            let own = Answer::new(campaign.scenario(), metrics, None, ReaderUnits::default());
            if !own.warnings.is_empty() {
                object["warnings"] = own.warnings.iter().map(|warning| json!(warning.text)).collect();
            }
        }
        Err(error) => object["error"] = json!(error.to_string()),
    }
    object
}
