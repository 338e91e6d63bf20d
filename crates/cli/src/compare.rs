//! `flexsc compare`: two scenarios, logs or campaigns, the keys in which they differ, and their answers side by side.

use std::ffi::OsStr;
use std::io::Write;
use std::path::{Path, PathBuf};

use flexsc_core::Scenario;
use flexsc_core::answer::{
    Answer, CampaignAnswer, CampaignComparison, KeyDifference, RunComparison, RunObserver, ScreenOptions,
};
use flexsc_core::campaign::{Campaign, Directory};
use flexsc_core::formats::document::key;
use flexsc_core::formats::reader_units::ReaderUnits;
use flexsc_core::record::{Detail, Log};
use serde_json::json;

use crate::answer::AnswerArgs;
use crate::campaign::part_files;
use crate::confirm_cost::CostConfirmation;
use crate::error::CliError;
use crate::figure_files::FigureOutput;
use crate::logged_answer::answer_of_log;
use crate::results::print_lines;
use crate::stop::stop_flag;
use crate::{memory_log, plot, say, scenario, simulate};

#[derive(clap::Args)]
pub struct CompareArgs {
    /// Two scenarios or logs, or the directories of two campaigns; a scenario is run, and the run of a log is repeated
    #[arg(required = true, num_args = 2, value_names = ["A", "B"])]
    sides: Vec<PathBuf>,
    /// Set a key of both scenarios, such as duration=200; not for logs
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Print every key and every line that differs
    #[arg(long)]
    all: bool,
    /// Print one JSON object to stdout
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    drawing: FigureOutput,
    #[command(flatten)]
    consent: CostConfirmation,
}

/// Side of a comparison.
struct ComparedRun {
    scenario: Scenario,
    answer: Answer,
    /// Log for the figures, if they are drawn.
    log: Option<Log>,
}

pub fn run(args: &CompareArgs) -> Result<(), CliError> {
    let [first, second] = &args.sides[..] else {
        return Err(CliError::Arguments("takes two scenarios or logs".to_owned()));
    };
    for side in [first, second] {
        args.drawing.check(side)?;
        if !args.set.is_empty() && (is_log(side) || side.is_dir()) {
            let why = format!("--set: {} is no scenario, and its keys cannot be set", side.display());
            return Err(CliError::Arguments(why));
        }
    }
    match [first, second].map(|side| side.is_dir()) {
        [true, true] => return campaigns([first, second], args),
        [false, false] => {}
        _ => {
            let why = "one is the directory of a campaign, and the other is not: compare two campaigns, or two runs";
            return Err(CliError::Arguments(why.to_owned()));
        }
    }
    // Both are read before one is run.
    let sources = [source(first, args)?, source(second, args)?];
    let [first_run, second_run] = sources;
    let runs = [first_run.compared(args)?, second_run.compared(args)?];
    if let ([Some(a), Some(b)], true) =
        (runs.each_ref().map(|run| run.log.as_ref()), args.drawing.figures.is_some())
    {
        let figures = plot::overlaid_logs([(first, a), (second, b)])?;
        let [a, b] = [first, second].map(|path| path.file_stem().unwrap_or_default().to_string_lossy());
        let named = figures.into_iter().map(|(kind, figure)| (format!("{a}-{b}-{kind}"), figure));
        args.drawing.save(|| named.collect())?;
    }
    let scenarios = runs.each_ref().map(|run| &run.scenario);
    let mut keys = KeyDifference::between(scenarios, args.drawing.choice.units().into());
    for (side, path) in [first, second].into_iter().enumerate() {
        write_as_in_file(&mut keys, side, path, &args.set)?;
    }
    let names = [first, second].map(|path| path.display().to_string());
    let comparison = RunComparison { names, keys, answers: runs.map(|run| run.answer) };
    if args.json {
        return print_lines(&[json!(comparison)]);
    }
    say!("{}", comparison.screen(args.screen()));
    Ok(())
}

/// Compares the campaigns in two directories.
fn campaigns(sides: [&Path; 2], args: &CompareArgs) -> Result<(), CliError> {
    if args.drawing.figures.is_some() {
        let why = "-o: figures of campaigns are drawn one by one: flexsc plot DIR";
        return Err(CliError::Arguments(why.to_owned()));
    }
    let opened = |path: &Path| Directory::open(path).map_err(part_files::failure);
    let directories = [opened(sides[0])?, opened(sides[1])?];
    let units: ReaderUnits = args.drawing.choice.units().into();
    let answered = |directory: &Directory| {
        let work = directory.work();
        let runs = work.campaign_runs(|names| directory.columns(names)).map_err(part_files::failure)?;
        let path = directory.path().display().to_string();
        Ok::<_, CliError>(CampaignAnswer::new(work.campaign.scenario(), &runs, None, Some(&path), units))
    };
    let answers = [answered(&directories[0])?, answered(&directories[1])?];
    let scenarios = directories.each_ref().map(|directory| directory.work().campaign.scenario());
    let keys = KeyDifference::between(scenarios, units);
    let comparison =
        CampaignComparison { names: sides.map(|path| path.display().to_string()), keys, answers };
    if args.json {
        return print_lines(&[json!(comparison)]);
    }
    say!("{}", comparison.screen(args.screen()));
    Ok(())
}

impl CompareArgs {
    fn screen(&self) -> ScreenOptions {
        AnswerArgs { all: self.all, ..AnswerArgs::from_units(self.drawing.choice.units()) }.screen()
    }
}

/// Shows the keys that a scenario file contains as they are written there.
fn write_as_in_file(
    keys: &mut [KeyDifference],
    side: usize,
    path: &Path,
    set: &[String],
) -> Result<(), CliError> {
    if is_log(path) || path == Path::new("-") {
        return Ok(());
    }
    let mut document = scenario::document(path)?;
    for (key, value) in set.iter().filter_map(|pair| pair.split_once('=')) {
        document.set_text(key.trim(), value.trim())?;
    }
    for own in keys {
        let unit = own.unit.unwrap_or_default();
        let Some(value) = key::get(document.table(), &own.key) else { continue };
        if let Some(text) = value.as_str() {
            text.clone_into(&mut own.texts[side]);
        } else if value.is_float() || value.is_integer() {
            format!("{value} {unit}").trim_end().clone_into(&mut own.texts[side]);
        }
    }
    Ok(())
}

/// Run that is to be compared, read and not yet made.
enum ComparedSource {
    Scenario(PathBuf, Box<Scenario>),
    Log(PathBuf, Box<Log>),
}

fn is_log(path: &Path) -> bool {
    path.extension() == Some(OsStr::new("mcap"))
}

fn source(path: &Path, args: &CompareArgs) -> Result<ComparedSource, CliError> {
    if is_log(path) {
        return Ok(ComparedSource::Log(path.to_owned(), Box::new(Log::open(path)?)));
    }
    let scenario = scenario::load(path, &args.set, None)?;
    args.consent.check(&scenario.cost(None, false))?;
    Ok(ComparedSource::Scenario(path.to_owned(), Box::new(scenario)))
}

impl ComparedSource {
    /// Runs a scenario, or repeats the run of a log.
    fn compared(self, args: &CompareArgs) -> Result<ComparedRun, CliError> {
        let units = args.drawing.choice.units().into();
        match self {
            Self::Scenario(path, scenario) => {
                let mut observer = RunObserver::new(&scenario);
                let (metrics, log) = if args.drawing.figures.is_some() {
                    let record = &mut observer;
                    let (log, metrics) =
                        memory_log::observed(*scenario.clone(), &path, Detail::Full, record)?;
                    (metrics, Some(log))
                } else {
                    let campaign = Campaign::new(*scenario.clone(), &path.to_string_lossy(), None)?;
                    let run = simulate::scenario_run(&campaign);
                    let metrics = Campaign::simulate(&run, (stop_flag(), &mut observer));
                    (metrics.map_err(|source| CliError::run(&scenario.name, source))?, None)
                };
                let answer = Answer::new(&scenario, &metrics, Some(&observer.finish()), units);
                Ok(ComparedRun { scenario: *scenario, answer, log })
            }
            Self::Log(path, log) => {
                let (scenario, answer) = answer_of_log(&log, &path, units)?;
                Ok(ComparedRun { scenario, answer, log: Some(*log) })
            }
        }
    }
}
