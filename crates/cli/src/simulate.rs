//! `flexsc simulate`: single runs with their logs, and campaigns.

use std::collections::BTreeSet;
use std::io::Write;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant as WallInstant;

use flexsc_core::SimulationError;
use flexsc_core::answer::{Answer, RunObserver};
use flexsc_core::campaign::{Campaign, CampaignRun, Design, Directory};
use flexsc_core::metrics::Selection;
use flexsc_core::record::{Detail, RecordError};
use flexsc_core::requirement_verdict::RequirementVerdict;
use flexsc_core::scenario::{Cost, MOST_RUNS};

use serde_json::json;

use crate::answer::AnswerArgs;
use crate::campaign::logs::{self, LogDetail, simulate_to_log};
use crate::campaign::{self, CampaignOptions, TableFormat, part_files};
use crate::confirm_cost::CostConfirmation;
use crate::error::CliError;
use crate::out::Out;
use crate::progress::{Progress, RunClock};
use crate::results::print_lines;
use crate::stop::{self, stop_flag};
use crate::{files, out, requirements, say, scenario};

#[derive(clap::Args)]
pub struct SimulateArgs {
    /// Scenario files
    #[arg(required_unless_present = "from", value_name = "SCENARIO")]
    pub scenarios: Vec<PathBuf>,
    /// Repeat a run of the campaign in this directory, with a full log
    #[arg(long, value_name = "DIR", requires = "row", conflicts_with_all = ["scenarios", "runs", "set", "seed"])]
    from: Option<PathBuf>,
    /// Number of the run to repeat
    #[arg(long, value_name = "N", requires = "from")]
    row: Option<u64>,
    /// Directory for logs and tables, created if missing, or FILE.mcap for the log of one run, or FILE.csv or FILE.parquet
    /// for the rows of a campaign [default: the current directory, for logs only]
    #[arg(short, long, value_name = "DIR|FILE")]
    out: Option<PathBuf>,
    /// Set a key of the scenario, such as law.relay.k_t=0.34
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Monte Carlo campaign over the [uncertain] keys and the noise: N runs, or runs LO to HI - 1
    #[arg(long, value_name = "N|LO:HI", value_parser = runs)]
    pub runs: Option<RunRange>,
    /// Seed [default: the scenario's]
    #[arg(long, value_name = "S", value_parser = clap::value_parser!(u64).range(..=scenario::LARGEST_SEED))]
    pub seed: Option<u64>,
    /// Number of threads [default: one per core]
    #[arg(long, value_name = "J", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// Detail of the logs [default: events; none in a campaign]
    #[arg(long, value_name = "DETAIL")]
    log: Option<LogDetail>,
    /// Replace logs of other settings, tables of other campaigns, and a FILE that exists
    #[arg(long)]
    force: bool,
    /// Print one JSON object per run to stdout
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    answer: AnswerArgs,
    /// Stop as soon as the other runs cannot change whether the requirements are met; without tables
    #[arg(long, requires = "runs", conflicts_with = "out", help_heading = "Campaigns")]
    until_decided: bool,
    #[command(flatten)]
    options: CampaignOptions,
    #[command(flatten)]
    consent: CostConfirmation,
    #[command(flatten)]
    live: crate::live::LiveArgs,
}

/// Range of the runs of a campaign, and true if it was given as a part.
#[derive(Clone)]
pub struct RunRange {
    pub range: Range<u64>,
    part: bool,
}

/// Targets of results.
struct Place {
    path: PathBuf,
    /// File format of a campaign's rows.
    kind: TableFormat,
    /// True if the target of the rows is one file.
    is_file: bool,
}

impl Place {
    /// Returns the path of a run's log.
    fn log(&self, name: &str) -> PathBuf {
        if self.is_file { self.path.clone() } else { self.path.join(format!("{name}.mcap")) }
    }
}

/// Parses `N` or `LO:HI`.
pub fn runs(text: &str) -> Result<RunRange, String> {
    let number = |text: &str| {
        text.parse::<u64>().map_err(|_| format!("`{text}` is not a number of runs; give N or LO:HI"))
    };
    let (range, part) = match text.split_once(':') {
        Some((low, high)) => (number(low)?..number(high)?, true),
        None => (0..number(text)?, false),
    };
    if range.is_empty() {
        return Err("contains no runs".to_owned());
    }
    let count = range.end - range.start;
    if count > MOST_RUNS {
        return Err(format!("a campaign has at most {MOST_RUNS} runs, got {count}"));
    }
    Ok(RunRange { range, part })
}

pub fn run(args: &SimulateArgs) -> Result<(), CliError> {
    if let (Some(from), Some(row)) = (&args.from, args.row) {
        return args.again(from, row);
    }
    let selection = args.options.selection()?;
    if args.runs.is_none() && !args.options.are_default() {
        let why = "--table, --metrics, --fail-fast, --sample, --replicas and --scheduler apply only to campaigns (--runs)";
        return Err(CliError::Arguments(why.to_owned()));
    }
    if args.live.live.is_some() && args.scenarios.len() > 1 {
        let count = args.scenarios.len();
        return Err(CliError::Arguments(format!("--live follows one scenario, got {count}")));
    }
    let place = args.place()?;
    // All scenarios are checked before any file is written.
    let scenarios = args
        .scenarios
        .iter()
        .map(|path| Ok((scenario::load(path, &args.set, args.seed)?, path.display().to_string())))
        .collect::<Result<Vec<_>, CliError>>()?;
    let mut names = BTreeSet::new();
    for (scenario, origin) in &scenarios {
        if !names.insert(&scenario.name) {
            let name = &scenario.name;
            return Err(CliError::Arguments(format!(
                "{origin}: another scenario is named `{name}` too, and their logs would have one name\n\n\
                 hint: give it a `name`, or run them one by one"
            )));
        }
    }
    let campaigns = scenarios
        .into_iter()
        .map(|(scenario, origin)| {
            let design = args.design(!scenario.uncertain.is_empty())?;
            let campaign = Campaign::from_design(scenario, &origin, design)?;
            for remark in campaign.scenario().remarks() {
                say!("note: {remark}");
            }
            args.consent.check(&args.cost(&campaign)?)?;
            Ok(Arc::new(campaign))
        })
        .collect::<Result<Vec<_>, CliError>>()?;
    // Options that exclude each other are refused before a directory is made.
    args.options.scheduler(args.detail(LogDetail::None).is_some(), args.json)?;
    args.make_room(&place)?;
    let prefixed = campaigns.len() > 1;
    let mut failures = Vec::new();
    let (mut answers, mut judged) = (Vec::new(), Vec::new());
    for campaign in campaigns {
        let name = campaign.scenario().name.clone();
        let done = match &args.runs {
            None => {
                let log = (place.log(&name), args.detail(LogDetail::Events));
                single(&campaign, &scenario_run(&campaign), args, log)
                    .map(|answer| answers.push((name, answer)))
            }
            Some(runs) => several(&campaign, (args, &place), runs, (prefixed, &selection))
                .map(|verdicts| judged.push((name, verdicts))),
        };
        match done {
            // The other scenarios are still run.
            Err(failure @ (CliError::Run { .. } | CliError::Runs { .. })) => failures.push(failure),
            done => done?,
        }
    }
    let last = failures.pop();
    for failure in failures {
        failure.print();
    }
    last.map_or(Ok(()), Err)?;
    args.answer.validate(&answers)?;
    requirements::validate(judged.iter().map(|(name, verdicts)| (name.as_str(), &verdicts[..])))
}

impl SimulateArgs {
    /// Returns the point design of the campaign.
    fn design(&self, uncertain: bool) -> Result<Design, CliError> {
        let Some(RunRange { range, part }) = &self.runs else { return Ok(Design::default()) };
        let whole = (!part).then(|| range.end.div_ceil(self.options.replicas));
        let design = self.options.complete(Design::default(), uncertain, self.options.points().or(whole))?;
        match design.runs() {
            Some(all) if range.end > all => {
                Err(CliError::Arguments(format!("--runs: --sample has points for only {all} runs")))
            }
            _ => Ok(design),
        }
    }

    /// Repeats a run of a campaign's directory.
    fn again(&self, from: &Path, row: u64) -> Result<(), CliError> {
        let directory = Directory::open(from).map_err(part_files::failure)?;
        let work = directory.work();
        let runs = work.manifest.runs();
        if !runs.contains(&row) {
            let why = format!("has runs {} to {}, not {row}", runs.start, runs.end - 1);
            return Err(CliError::Arguments(format!("{}: {why}", from.display())));
        }
        let run = work.campaign.run(row)?;
        let detail = self.log.unwrap_or(LogDetail::Full).detail();
        self.consent.check(&run.scenario.cost(detail, false))?;
        let place = self.place()?;
        self.make_room(&place)?;
        let log = place.log(&format!("{}-{row}", run.scenario.name));
        let answer = single(&work.campaign, &run, self, (log, detail))?;
        self.answer.validate(&[(run.scenario.name.clone(), answer)])
    }

    /// Returns the level of detail of the log, with a default.
    fn detail(&self, default: LogDetail) -> Option<Detail> {
        self.log.unwrap_or(default).detail()
    }

    /// Returns the target of a run's log, or of a campaign's rows.
    fn place(&self) -> Result<Place, CliError> {
        let inputs: Vec<&Path> = self.scenarios.iter().map(PathBuf::as_path).collect();
        let Some(path) = &self.out else {
            return Ok(Place { path: PathBuf::new(), kind: self.options.table(), is_file: false });
        };
        let (kind, is_file) = if self.runs.is_some() {
            self.options.place(Some(path), &inputs, self.detail(LogDetail::None).is_some())?
        } else {
            (self.options.table(), matches!(Out::new(path, &["mcap"], &inputs)?, Out::File(..)))
        };
        let several = is_file && self.scenarios.len() > 1;
        let without = is_file && self.runs.is_none() && self.log == Some(LogDetail::None);
        for (is, why) in
            [(several, "is one file, and there are several scenarios"), (without, "--log none writes no log")]
        {
            if is {
                return Err(CliError::Arguments(format!("-o {}: {why}", path.display())));
            }
        }
        Ok(Place { path: path.clone(), kind, is_file })
    }

    /// Creates the directory of the results, whose file must not be one that the scenarios name.
    fn make_room(&self, place: &Place) -> Result<(), CliError> {
        match (&self.out, place.is_file) {
            (Some(path), true) => out::refuse_read(path).and_then(|()| files::make_parent(path)),
            (Some(path), false) => files::make_directory(path),
            (None, _) => Ok(()),
        }
    }

    /// Returns the cost of a scenario's runs.
    fn cost(&self, campaign: &Campaign) -> Result<Cost, CliError> {
        let Some(RunRange { range, .. }) = &self.runs else {
            return Ok(campaign.scenario().cost(self.detail(LogDetail::Events), false));
        };
        let log = self.detail(LogDetail::None);
        let cost = campaign.cost(range.end - range.start, log);
        let cost = cost.map_err(|why| CliError::Arguments(format!("--runs {why}")))?;
        Ok(self.options.cost(cost, self.out.is_some() && !self.place()?.is_file))
    }
}

/// Runs the campaign of a scenario; its tables have the scenario's name if several scenarios share a directory.
fn several(
    campaign: &Arc<Campaign>,
    (args, place): (&SimulateArgs, &Place),
    runs: &RunRange,
    (prefixed, selection): (bool, &Selection),
) -> Result<Vec<RequirementVerdict>, CliError> {
    let detail = args.detail(LogDetail::None);
    let job = campaign::CampaignJob {
        range: runs.range.clone(),
        part: runs.part,
        table: args.out.as_deref(),
        is_file: place.is_file,
        kind: place.kind,
        selection: selection.clone(),
        fail_fast: args.options.fail_fast,
        until_decided: args.until_decided,
        prefix: prefixed.then_some(campaign.scenario().name.as_str()),
        force: args.force,
        jobs: args.jobs,
        json: args.json,
        answer: args.answer,
        observed: Arc::default(),
        scheduler: args.options.scheduler(detail.is_some(), args.json)?,
        plain: detail.is_none(),
    };
    logs::run(campaign, &job, detail)
}

/// Returns the run of the scenario itself, without drawn keys.
pub fn scenario_run(campaign: &Campaign) -> CampaignRun {
    CampaignRun::new(campaign.scenario().clone(), 0)
}

/// Simulates a single run, with its log, and returns its answer.
fn single(
    campaign: &Campaign,
    run: &CampaignRun,
    args: &SimulateArgs,
    (path, detail): (PathBuf, Option<Detail>),
) -> Result<Answer, CliError> {
    let _writing = detail.map(|_| stop::writing());
    let name = run.scenario.name.clone();
    let mut live = args.live.serve(run)?;
    let began = WallInstant::now();
    // A live run has no bar, since the user types commands on that line.
    let mut progress = live.is_none().then(|| Progress::new(run.scenario.duration));
    let clock = progress.as_mut().map(|progress| RunClock::new(move |now| progress.show(now)));
    let mut observer = RunObserver::new(&run.scenario);
    let record = (stop_flag(), (&mut observer, (clock, &mut live)));
    let result = match detail {
        None => Campaign::simulate(run, record).map(|metrics| (metrics, None)),
        Some(detail) => simulate_to_log(run, &path, (detail, args.force), record)
            .map(|(metrics, bytes)| (metrics, Some(bytes))),
    };
    if let Some(progress) = progress {
        progress.finish();
    }
    let took = began.elapsed().as_secs_f64();
    let (metrics, bytes) = result.map_err(|source| match source {
        SimulationError::Record(RecordError::Io(source)) => CliError::write(&path)(source),
        SimulationError::Record(RecordError::Interrupted) => {
            CliError::Interrupted(interrupted(detail, &path))
        }
        source => CliError::Run { name: name.clone(), source },
    })?;
    let answer = args.answer.answer(&run.scenario, &metrics, Some(&observer.finish()));
    if args.json {
        let mut object = campaign::object(campaign, run.number, &run.drawn, Ok(&metrics));
        object["answer"] = json!(answer);
        print_lines(&[object])?;
    } else {
        args.answer.print(&answer, took, bytes.map(|bytes| (&*path, bytes)));
    }
    if let Some(live) = live {
        live.finish(&metrics);
    }
    Ok(answer)
}

fn interrupted(log: Option<Detail>, path: &Path) -> String {
    if log.is_none() { String::new() } else { format!("; {} holds the run up to that time", path.display()) }
}
