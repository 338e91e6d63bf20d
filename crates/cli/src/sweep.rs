//! `flexsc sweep`: a scenario, run at each point of a design.

mod points;

use std::io::Write;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::ValueEnum;
use flexsc_core::Scenario;
use flexsc_core::campaign::{Campaign, Design, DesignBlock, KeyRange};
use flexsc_core::formats::count::counted;
use flexsc_core::formats::document::is_number;
use flexsc_core::record::Detail;
use flexsc_core::scenario::{ACTIVE_FAULT, NO_FAULT};

use crate::answer::AnswerArgs;
use crate::campaign::logs::{self, LogDetail};
use crate::campaign::{CampaignOptions, TableFormat};
use crate::confirm_cost::CostConfirmation;
use crate::error::CliError;
use crate::human::UnitsArgs;
use crate::simulate::{RunRange, runs};
use crate::{campaign, files, requirements, say, scenario};

/// Largest number of combinations of a sweep.
const MOST_VALUES: u32 = 10_000_000;

#[derive(clap::Args)]
pub struct SweepArgs {
    /// Scenario file
    pub scenario: PathBuf,
    /// A key and its values: LO:HI:COUNT for evenly spaced values, such as law.relay.k_t=0.28:0.40:2401; a list A,B,C; or a
    /// range LO:HI for --sample; active_fault alone for all faults. Repeat it for more keys: grids and lists are combined,
    /// ranges are sampled together
    #[arg(long, required_unless_present = "points", value_name = "KEY=VALUES", value_parser = varied)]
    vary: Vec<VariedKey>,
    /// CSV file of points: one column per key, one row per point; combined with --vary
    #[arg(long, value_name = "FILE")]
    points: Option<PathBuf>,
    /// Only runs LO to HI - 1 of the sweep
    #[arg(long, value_name = "LO:HI", value_parser = runs)]
    runs: Option<RunRange>,
    /// Directory for the tables, created if missing, or FILE.csv or FILE.parquet for the rows
    #[arg(short, long, value_name = "DIR|FILE")]
    out: Option<PathBuf>,
    /// Set a key of the scenario, such as duration=1e4
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Seed [default: the scenario's]
    #[arg(long, value_name = "S", value_parser = clap::value_parser!(u64).range(..=scenario::LARGEST_SEED))]
    pub seed: Option<u64>,
    /// Number of threads [default: one per core]
    #[arg(long, value_name = "J", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// Draw the [uncertain] keys too, anew for each point; without it they keep their values
    #[arg(long)]
    uncertain: bool,
    /// Noise of the points [default: same; new with --uncertain]
    #[arg(long, value_name = "NOISE")]
    noise: Option<PointNoise>,
    /// Replace logs of other settings, tables of other campaigns, and a FILE that exists
    #[arg(long)]
    force: bool,
    /// Print one JSON object per run to stdout
    #[arg(long)]
    json: bool,
    /// Write a log per run, NAME-RUN.mcap in DIR, with this detail [default: none]
    #[arg(long, value_name = "DETAIL")]
    log: Option<LogDetail>,
    #[command(flatten)]
    units: UnitsArgs,
    #[command(flatten)]
    options: CampaignOptions,
    #[command(flatten)]
    consent: CostConfirmation,
}

/// Key and its values.
#[derive(Clone)]
struct VariedKey {
    key: String,
    values: KeyValues,
}

/// Values as they are written, with their units.
#[derive(Clone)]
enum KeyValues {
    Even {
        first: String,
        last: String,
        count: u32,
    },
    List(Vec<String>),
    Range {
        from: String,
        to: String,
    },
    /// Names of faults; all of the scenario, and none, if none is given.
    Faults(Vec<String>),
}

/// Noise of the points of a sweep.
#[derive(Copy, Clone, PartialEq, ValueEnum)]
enum PointNoise {
    /// Noise of one run at all points, which then differ by their keys alone
    Same,
    /// New noise at each point
    New,
}

fn varied(text: &str) -> Result<VariedKey, String> {
    let form = || {
        format!("`{text}` is not KEY=LO:HI:COUNT, such as law.relay.k_t=0.28:0.40:25, KEY=A,B,C or KEY=LO:HI")
    };
    let faults = text.strip_prefix(ACTIVE_FAULT).and_then(|rest| match rest {
        "" => Some(Vec::new()),
        rest => Some(rest.strip_prefix('=')?.split(',').map(|name| name.trim().to_owned()).collect()),
    });
    if let Some(faults) = faults {
        return Ok(VariedKey { key: ACTIVE_FAULT.to_owned(), values: KeyValues::Faults(faults) });
    }
    let (key, values) = text.split_once('=').ok_or_else(form)?;
    let number = |text: &str| Some(text.to_owned()).filter(|text| is_number(text)).ok_or_else(form);
    let values = if values.contains(',') {
        KeyValues::List(values.split(',').map(number).collect::<Result<_, _>>()?)
    } else {
        match values.split(':').collect::<Vec<_>>()[..] {
            [start, end] => KeyValues::Range { from: number(start)?, to: number(end)? },
            [start, end, count] => {
                let count: u64 = count.trim().parse().ok().filter(|count| *count > 0).ok_or_else(form)?;
                if count > u64::from(MOST_VALUES) {
                    return Err(format!("a sweep has at most {MOST_VALUES} values, got {count}"));
                }
                KeyValues::Even { first: number(start)?, last: number(end)?, count: count as u32 }
            }
            _ => return Err(form()),
        }
    };
    Ok(VariedKey { key: key.to_owned(), values })
}

impl SweepArgs {
    /// Returns the level of detail of each run's log; `None` without logs.
    fn detail(&self) -> Option<Detail> {
        self.log.and_then(LogDetail::detail)
    }

    /// Returns the file format of the rows, and true if they go to one file.
    fn place(&self) -> Result<(TableFormat, bool), CliError> {
        let inputs: Vec<&Path> =
            [&self.scenario].into_iter().chain(&self.points).map(PathBuf::as_path).collect();
        self.options.place(self.out.as_deref(), &inputs, self.detail().is_some())
    }

    /// Returns the points over a scenario, and their number.
    fn design(&self, scenario: &Scenario) -> Result<(Design, u64), CliError> {
        let uncertain = !scenario.uncertain.is_empty();
        let mut blocks = Vec::new();
        if let Some(path) = &self.points {
            blocks.push(points::read(path)?);
        }
        let mut ranges = Vec::new();
        for VariedKey { key, values } in &self.vary {
            let number = |text: &String| scenario.number_of(key, text);
            let key = key.clone();
            match values {
                KeyValues::Even { first, last, count } => {
                    let (first, last) = (number(first)?, number(last)?);
                    blocks.push(DesignBlock::Even { key, first, last, count: *count });
                }
                KeyValues::List(values) => {
                    let values = values.iter().map(number).collect::<Result<_, _>>()?;
                    blocks.push(DesignBlock::List { key, values });
                }
                KeyValues::Faults(chosen) => {
                    blocks.push(DesignBlock::texts(&key, fault_names(scenario, chosen)?));
                }
                KeyValues::Range { from, to } => {
                    ranges.push(KeyRange { from: number(from)?, to: number(to)?, key });
                }
            }
        }
        if let Some(range) = ranges.first() {
            let Some(count) = self.options.points() else {
                let why = "is a range, from which --sample takes points, such as --sample sobol:1024";
                return Err(CliError::Arguments(format!("--vary {}: {why}", range.key)));
            };
            blocks.push(DesignBlock::Sample { sampling: self.options.sampling(), count, ranges });
        }
        let too_many = || {
            let why = format!("a sweep has at most {MOST_VALUES} combinations of values");
            CliError::Arguments(format!("--vary: {why}"))
        };
        let points = blocks.iter().try_fold(1_u64, |points, block| points.checked_mul(block.count()));
        let points = points.ok_or_else(too_many)?;
        let default = if uncertain { PointNoise::New } else { PointNoise::Same };
        let noise_run = (self.noise.unwrap_or(default) == PointNoise::Same).then_some(0);
        let design = Design { noise_run, ..Design::from_blocks(blocks) };
        let design = self.options.complete(design, uncertain, Some(points))?;
        let runs = points.checked_mul(self.options.replicas).filter(|runs| *runs <= u64::from(MOST_VALUES));
        let runs = runs.ok_or_else(too_many)?;
        if let Some(problem) = design.validate(usize::from(uncertain)) {
            return Err(CliError::Arguments(format!("--vary {problem}")));
        }
        Ok((design, runs))
    }

    /// Returns the sweep over a scenario of this origin, and the range of its runs.
    pub fn campaign(&self, scenario: Scenario, origin: &str) -> Result<(Campaign, Range<u64>), CliError> {
        let scenario = if self.uncertain { scenario } else { Campaign::undrawn(scenario) };
        let (design, all) = self.design(&scenario)?;
        let range = self.runs.as_ref().map_or(0..all, |runs| runs.range.clone());
        if range.end > all {
            return Err(CliError::Arguments(format!("--runs: the sweep has {}", counted(all, "run"))));
        }
        let campaign = Campaign::from_design(scenario, origin, design)?;
        let runs = range.end - range.start;
        let cost = campaign
            .cost(runs, self.detail())
            .map_err(|why| CliError::Arguments(format!("--vary: {why}")))?;
        self.consent.check(&self.options.cost(cost, self.out.is_some() && !self.place()?.1))?;
        Ok((campaign, range))
    }
}

pub fn run(args: &SweepArgs) -> Result<(), CliError> {
    let (kind, is_file) = args.place()?;
    let scenario = scenario::load(&args.scenario, &args.set, args.seed)?;
    for remark in scenario.remarks() {
        say!("note: {remark}");
    }
    if args.uncertain && scenario.uncertain.is_empty() {
        let path = args.scenario.display();
        return Err(CliError::Arguments(format!("--uncertain: {path} has no [uncertain] keys")));
    }
    let undrawn = !args.uncertain && !scenario.uncertain.is_empty();
    let selection = args.options.selection()?;
    let (campaign, range) = args.campaign(scenario, &args.scenario.display().to_string())?;
    if undrawn && !args.json {
        say!("note: the [uncertain] keys keep their values; --uncertain draws them");
    }
    let detail = args.detail();
    // Options that exclude each other are refused before a directory is made.
    let scheduler = args.options.scheduler(detail.is_some(), args.json)?;
    if let Some(out) = args.out.as_ref().filter(|_| !is_file) {
        files::make_directory(out)?;
    }
    let job = campaign::CampaignJob {
        range,
        part: args.runs.is_some(),
        table: args.out.as_deref(),
        is_file,
        kind,
        selection,
        fail_fast: args.options.fail_fast,
        until_decided: false,
        prefix: None,
        force: args.force,
        jobs: args.jobs,
        json: args.json,
        answer: AnswerArgs::from_units(args.units.units),
        observed: Arc::default(),
        scheduler,
        plain: detail.is_none(),
    };
    let judges_faults = campaign.keys().any(|key| key == ACTIVE_FAULT);
    let name = campaign.scenario().name.clone();
    let verdicts = logs::run(&Arc::new(campaign), &job, detail)?;
    // A sweep explores: a point that misses a requirement is no failure of it, but for a fault.
    if judges_faults { requirements::validate([(name.as_str(), &verdicts[..])]) } else { Ok(()) }
}

/// Returns the chosen faults of a scenario, or `none` and all of them if none is chosen.
fn fault_names(scenario: &Scenario, chosen: &[String]) -> Result<Vec<String>, CliError> {
    let mut known = vec![NO_FAULT.to_owned()];
    known.extend(scenario.fault.iter().map(|fault| fault.name.clone()));
    let listed = || format!("`{}`", known.join("`, `"));
    match chosen.iter().find(|name| !known.contains(name)) {
        _ if known.len() == 1 => {
            Err(CliError::Arguments(format!("--vary {ACTIVE_FAULT}: {} has no [[fault]]", scenario.name)))
        }
        Some(name) => Err(CliError::Arguments(format!(
            "--vary {ACTIVE_FAULT}: must name faults of the scenario, {}, got `{name}`",
            listed()
        ))),
        None if chosen.is_empty() => Ok(known),
        None => Ok(chosen.to_vec()),
    }
}
